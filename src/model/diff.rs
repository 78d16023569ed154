//! How two programs differ, as changes to elements named by their paths. Layout and comments are no difference, and what
//! was renamed is no difference to what names it.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::hash::Hash;
use std::sync::Arc;

use super::change::{Change, Element, Op};
use super::element::{ElementId, Kind};
use super::ids::*;
use super::matching::{Key, Matching, Reading, Side};
use super::program::*;
use super::transition_names::TransitionNames;
use crate::syntax::lua_tokens::same_code;

pub fn diff(old: &Program, new: &Program, matching: &Matching) -> Vec<Change> {
    let both = Both { old, new, matching };
    let mut changes = compare(Element::Bridge, bridges(old), bridges(new));
    changes.extend(both.elements(Element::Variable, |index| VarId(index).into(), old.vars.len(), new.vars.len()));
    let machines =
        both.elements(Element::Machine, |index| MachineId(index).into(), old.machines.len(), new.machines.len());
    changes.extend(machines);
    changes.extend(both.elements(Element::State, |index| StateId(index).into(), old.states.len(), new.states.len()));
    changes.extend(both.elements(Element::Event, |index| EventId(index).into(), old.events.len(), new.events.len()));
    changes.extend(both.transitions());
    changes.extend(both.reordered());
    changes.extend(compare(Element::Spawn, both.spawns(Side::Old(old, new)), both.spawns(Side::New(new))));
    changes.extend(compare(Element::Action, both.hooks(Side::Old(old, new)), both.hooks(Side::New(new))));
    changes
}

/// Whether entering, being in and leaving a state does the same in both programs.
pub fn same_actions(old: &Program, a: StateId, new: &Program, b: StateId, matching: &Matching) -> bool {
    let (was, now) = (&old[a], &new[b]);
    let same_blocks = |was: &[BlockId], now: &[BlockId]| {
        was.len() == now.len() && was.iter().zip(now).all(|(&was, &now)| same_block(old, was, new, now, matching))
    };
    let same_entry = |pair: (&Entry, &Entry)| match pair {
        (Entry::Action(was), Entry::Action(now)) => same_block(old, *was, new, *now, matching),
        (Entry::Spawn(was), Entry::Spawn(now)) => same_spawn(old, was, new, now, matching),
        _ => false,
    };
    same_blocks(&was.running, &now.running)
        && same_blocks(&was.onexit, &now.onexit)
        && was.onentry.len() == now.onentry.len()
        && was.onentry.iter().zip(&now.onentry).all(same_entry)
}

/// Whether entering a state spawns the same machines in the same states, in the same order.
pub fn same_spawns(old: &Program, a: StateId, new: &Program, b: StateId, matching: &Matching) -> bool {
    let (was, now): (Vec<_>, Vec<_>) = (old[a].spawns().collect(), new[b].spawns().collect());
    was.len() == now.len() && was.iter().zip(&now).all(|((_, was), (_, now))| same_spawn(old, was, new, now, matching))
}

/// Whether a block does the same in both programs.
pub fn same_block(old: &Program, a: BlockId, new: &Program, b: BlockId, matching: &Matching) -> bool {
    let same_text =
        || old[a].code == new[b].code || keys(Side::Old(old, new), matching, a) == keys(Side::New(new), matching, b);
    same_modules(old, &old[a].requires, new, &new[b].requires) && same_text()
}

/// The text of required Lua files counts as part of a block.
pub fn same_modules(old: &Program, a: &[ModuleId], new: &Program, b: &[ModuleId]) -> bool {
    if a.is_empty() && b.is_empty() {
        return true;
    }
    let named = |program: &Program, modules: &[ModuleId]| -> BTreeMap<Arc<str>, Arc<str>> {
        modules.iter().map(|&it| (program[it].name.clone(), program.module_text(it).clone())).collect()
    };
    let (a, b) = (named(old, a), named(new, b));
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && (a.1 == b.1 || same_code(a.1, b.1)))
}

/// Whether two spawns are of the same machine in the same state; one that names something unknown says the same.
pub fn same_spawn(old: &Program, was: &Spawn, new: &Program, now: &Spawn, matching: &Matching) -> bool {
    match (was.target, now.target) {
        (Some((machine, state)), Some((now_machine, now_state))) => {
            matching.machine(machine) == Some(now_machine) && matching.state(state) == Some(now_state)
        }
        _ => spawn_keys(Side::Old(old, new), matching, was) == spawn_keys(Side::New(new), matching, now),
    }
}

fn spawn_keys<'p>(side: Side<'p>, matching: &Matching, spawn: &'p Spawn) -> Vec<Key<'p>> {
    side.keys(matching, Reading::Current, |words| words.spawn(spawn))
}

fn keys<'p>(side: Side<'p>, matching: &Matching, block: BlockId) -> Vec<Key<'p>> {
    side.keys(matching, Reading::Current, |words| words.block(block))
}

struct Both<'p> {
    old: &'p Program,
    new: &'p Program,
    matching: &'p Matching,
}

impl<'p> Both<'p> {
    /// Removed ones in the old order, then added, renamed and changed ones in the new order.
    fn elements(&self, kind: Element, id: fn(u32) -> ElementId, before: usize, after: usize) -> Vec<Change> {
        let Both { old, new, matching } = *self;
        let change = |op, path: &Arc<str>| Change { op, kind, path: path.clone(), to: None };
        let gone = (0..before as u32).map(id).filter(|&was| matching.now(was).is_none());
        let mut changes: Vec<Change> = gone.map(|was| change(Op::Removed, old.path(was))).collect();
        for now in (0..after as u32).map(id) {
            let Some(was) = matching.was(now) else {
                changes.push(change(Op::Added, new.path(now)));
                continue;
            };
            // A machine of an imported file has another path when it is exported.
            let is_top = new.scope(now).is_none();
            if old.name(was) != new.name(now) || is_top && old.path(was) != new.path(now) {
                changes.push(Change { to: Some(new.path(now).clone()), ..change(Op::Renamed, old.path(was)) });
            }
            if !self.does_the_same(was, now) {
                changes.push(change(Op::Changed, new.path(now)));
            }
        }
        changes
    }

    /// Apart from what is written inside, which is listed for itself.
    fn does_the_same(&self, was: ElementId, now: ElementId) -> bool {
        let Both { old, new, matching } = *self;
        let blocks = match was.kind {
            Kind::Machine => return true,
            Kind::State => {
                return same_actions(old, StateId(was.index), new, StateId(now.index), matching);
            }
            Kind::Event => (old[EventId(was.index)].block, new[EventId(now.index)].block),
            Kind::Var => (old[VarId(was.index)].init, new[VarId(now.index)].init),
        };
        same_block(old, blocks.0, new, blocks.1, matching)
    }

    fn transitions(&self) -> Vec<Change> {
        let Both { old, new, matching } = *self;
        let ids = |program: &Program| (0..program.transitions.len() as u32).map(TransitionId);
        let removed = ids(old).filter(|&was| matching.transition(was).is_none());
        let added = ids(new).filter(|&now| matching.transition_was(now).is_none());
        let (was_called, called) = (TransitionNames::of(old), TransitionNames::of(new));
        let change = |op| move |path| Change { op, kind: Element::Transition, path, to: None };
        let mut changes: Vec<Change> = removed.map(|was| was_called.name(was)).map(change(Op::Removed)).collect();
        changes.extend(added.map(|now| called.name(now)).map(change(Op::Added)));
        changes
    }

    /// States out of which the same transitions are tried in another order.
    fn reordered(&self) -> Vec<Change> {
        let Both { old, new, matching } = *self;
        let mut changes = Vec::new();
        for (index, state) in new.states.iter().enumerate() {
            let Some(was) = matching.was(StateId(index as u32)) else { continue };
            let before = old[StateId(was.index)].outgoing.iter().filter_map(|&was| matching.transition(was));
            if before.clone().eq(state.outgoing.iter().copied()) {
                continue;
            }
            let common: HashSet<TransitionId> = before.clone().collect();
            let common: HashSet<TransitionId> =
                state.outgoing.iter().copied().filter(|now| common.contains(now)).collect();
            let before = before.filter(|now| common.contains(now));
            if !before.eq(state.outgoing.iter().copied().filter(|now| common.contains(now))) {
                let path = format!("{}: order out of {}", new[state.machine].path, state.name).into();
                changes.push(Change { op: Op::Changed, kind: Element::Transition, path, to: None });
            }
        }
        changes
    }

    /// Only the state differs when a spawn is said to have changed.
    fn spawns(&self, side: Side<'p>) -> Vec<Listed<'p, Key<'p>, Key<'p>>> {
        let spawns = side.program().spawns.iter();
        let listed = spawns.filter_map(|spawn| {
            let [machine, state] = <[Key; 2]>::try_from(spawn_keys(side, self.matching, spawn)).ok()?;
            Some(Listed { path: &spawn.machine_name, key: machine, text: state })
        });
        listed.collect()
    }

    fn hooks(&self, side: Side<'p>) -> Vec<Listed<'p, &'static str, Vec<Key<'p>>>> {
        let program = side.program();
        let hooks = [("onpause", program.on_pause), ("onresume", program.on_resume)];
        let listed = hooks.into_iter().filter_map(|(form, block)| {
            Some(Listed { path: form, key: form, text: keys(side, self.matching, block?) })
        });
        listed.collect()
    }
}

/// Something without an id.
struct Listed<'p, K, T> {
    path: &'p str,
    /// What tells it from others.
    key: K,
    /// What may change in it.
    text: T,
}

fn bridges(program: &Program) -> Vec<Listed<'_, &str, (&str, &serde_json::Value)>> {
    let bridges = program.bridges.iter();
    bridges.map(|it| Listed { path: &it.name, key: &*it.name, text: (&*it.kind, &it.config) }).collect()
}

/// Removed ones in the old order, then added and changed ones in the new order.
fn compare<K: Hash + Eq, T: PartialEq>(kind: Element, old: Vec<Listed<K, T>>, new: Vec<Listed<K, T>>) -> Vec<Change> {
    let before: HashMap<&K, &T> = old.iter().map(|it| (&it.key, &it.text)).collect();
    let after: HashSet<&K> = new.iter().map(|it| &it.key).collect();
    let change = |op, path: &str| Change { op, kind, path: path.into(), to: None };
    let removed = old.iter().filter(|it| !after.contains(&it.key)).map(|it| change(Op::Removed, it.path));
    let rest = new.iter().filter_map(|it| match before.get(&it.key) {
        None => Some(change(Op::Added, it.path)),
        Some(&was) if *was != it.text => Some(change(Op::Changed, it.path)),
        Some(_) => None,
    });
    removed.chain(rest).collect()
}
