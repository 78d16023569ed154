//! What an edit has changed, as its record is to list it. Nothing is searched for: an element is the same one where its
//! identity says so.

use std::collections::{BTreeMap, BTreeSet};

use lrp::runtime::record::{Change, Element, Op};

use super::outline::{MachineAt, Outline};
use super::tree::*;

/// Two trees, with all uses of renamed elements in their new names.
pub struct Comparison {
    before: Said,
    after: Said,
    renamed: BTreeSet<Id>,
    /// States whose spawns, though they read the same, mean other machines now.
    spawn_others: BTreeSet<Id>,
    changes: Vec<Change>,
}

/// What is written in a tree: the path of each element, and what there is to change about it.
struct Said {
    /// Variables, machines, states, events and top-level spawns.
    elements: BTreeMap<Id, (Element, String, String)>,
    /// Bridges, onpause and onresume are known by name.
    forms: BTreeMap<String, (Element, String)>,
    /// What each state spawns.
    spawns: BTreeMap<Id, String>,
    machines: BTreeMap<Id, MachineSaid>,
}

struct MachineSaid {
    path: String,
    states: Vec<String>,
    transitions: Vec<TransitionSaid>,
}

struct TransitionSaid {
    from: String,
    exits: bool,
    text: String,
    /// Before any name was brought up to date.
    written: String,
}

impl Comparison {
    pub fn of(before: &Tree, after: &Tree) -> Comparison {
        let (mut old, mut new) = (before.clone(), after.clone());
        for tree in [&mut old, &mut new] {
            if let Some((from, to)) = tree.halfway.take() {
                tree.rename_uses(&from, &to);
            }
        }
        let mut renamed = BTreeSet::new();
        for (id, from, to) in renames(before, after) {
            old.rename_uses(&from, &to);
            renamed.insert(id);
        }
        let spawn_others = spawn_others(&Outline::of(before), &Outline::of(after));
        let (before, after) = (Said::in_tree(&old, before), Said::in_tree(&new, after));
        Comparison { before, after, renamed, spawn_others, changes: Vec::new() }
    }

    pub fn changes(mut self) -> Vec<Change> {
        let (old, new) = (std::mem::take(&mut self.before.elements), std::mem::take(&mut self.after.elements));
        for (id, (kind, path, text)) in &old {
            match new.get(id) {
                None => self.say(Op::Removed, *kind, path, None),
                Some((_, to, _)) if self.renamed.contains(id) => self.say(Op::Renamed, *kind, path, Some(to)),
                Some((_, _, now)) if now != text || self.spawn_others.contains(id) => {
                    self.say(Op::Changed, *kind, path, None);
                }
                Some(_) => {}
            }
        }
        for (_, (kind, path, _)) in new.iter().filter(|(id, _)| !old.contains_key(id)) {
            self.say(Op::Added, *kind, path, None);
        }
        let (old, new) = (std::mem::take(&mut self.before.forms), std::mem::take(&mut self.after.forms));
        for (name, form) in &old {
            match new.get(name) {
                None => self.say(Op::Removed, form.0, name, None),
                Some(now) if now != form => self.say(Op::Changed, form.0, name, None),
                Some(_) => {}
            }
        }
        for (name, form) in new.iter().filter(|(name, _)| !old.contains_key(*name)) {
            self.say(Op::Added, form.0, name, None);
        }
        self.transitions();
        self.changes.sort();
        self.changes
    }

    fn say(&mut self, op: Op, kind: Element, path: &str, to: Option<&str>) {
        self.changes.push(Change { op, kind, path: path.into(), to: to.map(Into::into) });
    }

    /// A transition is what is written of it.
    fn transitions(&mut self) {
        let (old, new) = (std::mem::take(&mut self.before.machines), std::mem::take(&mut self.after.machines));
        let missing = |of: Option<&MachineSaid>, text: &str| {
            of.is_none_or(|machine| machine.transitions.iter().all(|it| it.text != text))
        };
        for (id, machine) in &old {
            for it in machine.transitions.iter().filter(|it| missing(new.get(id), &it.text)) {
                self.say(Op::Removed, Element::Transition, &format!("{}: {}", machine.path, it.written), None);
            }
        }
        for (id, machine) in &new {
            for it in machine.transitions.iter().filter(|it| missing(old.get(id), &it.text)) {
                self.say(Op::Added, Element::Transition, &format!("{}: {}", machine.path, it.written), None);
            }
            if let Some(old) = old.get(id) {
                for state in
                    machine.states.iter().filter(|state| old.order(state, machine) != machine.order(state, old))
                {
                    let path = format!("{}: order out of {state}", machine.path);
                    self.say(Op::Changed, Element::Transition, &path, None);
                }
            }
        }
    }

    /// Whether a state does and spawns the same, a variable is initialised the same.
    pub fn same(&self, element: Id) -> bool {
        let text = |said: &Said| said.elements.get(&element).map(|(.., text)| text.clone());
        text(&self.before) == text(&self.after) && !self.spawn_others.contains(&element)
    }

    pub fn same_spawns(&self, state: Id) -> bool {
        self.before.spawns.get(&state) == self.after.spawns.get(&state) && !self.spawn_others.contains(&state)
    }
}

impl MachineSaid {
    /// Among the transitions out of a state that both machines have; exits count after all others.
    fn order(&self, state: &str, other: &MachineSaid) -> [Vec<&str>; 2] {
        [false, true].map(|exits| {
            let out = self.transitions.iter().filter(|it| it.from == state && it.exits == exits);
            let known = |text: &str| other.transitions.iter().any(|it| it.text == text);
            out.map(|it| &*it.text).filter(|text| known(text)).collect()
        })
    }
}

impl Said {
    /// The second tree is the same one as it is written.
    fn in_tree(tree: &Tree, written: &Tree) -> Said {
        let (outline, written) = (Outline::of(tree), Outline::of(written));
        let vars = outline.vars.iter().map(|at| (at.var.id, (Element::Variable, &at.path, at.var.init.to_string())));
        let machines = outline.machines.iter().map(|(&id, at)| (id, (Element::Machine, &at.path, String::new())));
        let states = outline.states.iter().map(|(&id, at)| (id, (Element::State, &at.path, at.state.does())));
        let events =
            outline.events.iter().map(|at| (at.event.id, (Element::Event, &at.path, at.event.when.to_string())));
        let spawns =
            tree.spawns.iter().map(|top| (top.id, (Element::Spawn, &top.spawn.machine, top.spawn.to_string())));
        let elements = vars.chain(machines).chain(states).chain(events).chain(spawns);
        let bridges = tree.bridges.iter().map(|it| (it.name.clone(), (Element::Bridge, it.config.clone())));
        let pauses = [("onpause", &tree.onpause), ("onresume", &tree.onresume)];
        let pauses = pauses.into_iter().filter_map(|(name, it)| Some((name, it.as_ref()?)));
        let pauses = pauses.map(|(name, it)| (name.into(), (Element::Action, it.to_string())));
        Said {
            elements: elements.map(|(id, (kind, path, text))| (id, (kind, path.clone(), text))).collect(),
            forms: bridges.chain(pauses).collect(),
            spawns: outline.states.iter().map(|(&id, at)| (id, format!("{:?}", at.state.spawns))).collect(),
            machines: outline.machines.iter().map(|(&id, at)| (id, at.said(&written.machines[&id]))).collect(),
        }
    }
}

impl MachineAt<'_> {
    fn said(&self, written: &MachineAt) -> MachineSaid {
        let both = self.machine.transitions.iter().zip(&written.machine.transitions);
        let transitions = both.map(|(it, written)| TransitionSaid {
            from: it.from.clone(),
            exits: it.is_exit(),
            text: it.to_string(),
            written: written.to_string(),
        });
        MachineSaid {
            path: self.path.clone(),
            states: self.machine.states.iter().map(|state| state.name.clone()).collect(),
            transitions: transitions.collect(),
        }
    }
}

impl State {
    /// Its actions and spawns.
    fn does(&self) -> String {
        let State { onentry, spawns, running, onexit, .. } = self;
        format!("{onentry:?} {spawns:?} {running:?} {onexit:?}")
    }
}

fn spawn_others(before: &Outline, after: &Outline) -> BTreeSet<Id> {
    let means_another = |id: &Id, old: &Spawn, new: &Spawn| {
        let (old, new) = (before.spawned(old, Some(*id)), after.spawned(new, Some(*id)));
        old.zip(new).is_some_and(|((old, _), (new, _))| old != new)
    };
    let both = before.states.iter().filter_map(|(id, old)| Some((*id, old.state, after.states.get(id)?.state)));
    let others = both.filter(|(id, old, new)| {
        old.spawns.len() == new.spawns.len()
            && old.spawns.iter().zip(&new.spawns).any(|(old, new)| means_another(id, old, new))
    });
    others.map(|(id, ..)| id).collect()
}

/// The elements that both trees have, under different names.
fn renames(before: &Tree, after: &Tree) -> Vec<(Id, String, String)> {
    let after = names(after);
    let both = names(before).into_iter().filter_map(|(id, name)| Some((id, name, after.get(&id)?.clone())));
    both.filter(|(_, before, after)| before != after).collect()
}

fn names(tree: &Tree) -> BTreeMap<Id, String> {
    let outline = Outline::of(tree);
    let machines = outline.machines.iter().map(|(&id, at)| (id, at.machine.name.clone()));
    let states = outline.states.iter().map(|(&id, at)| (id, at.state.name.clone()));
    let vars = outline.vars.iter().map(|at| (at.var.id, at.var.name.clone()));
    let events = outline.events.iter().map(|at| (at.event.id, at.event.name.clone()));
    machines.chain(states).chain(vars).chain(events).collect()
}
