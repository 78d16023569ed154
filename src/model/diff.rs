//! How two programs differ, as changes to elements named by their paths. Layout and comments are no difference.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use super::change::{Change, Element, Op};
use super::ids::*;
use super::program::*;
use crate::syntax::lua_tokens::same_code;

pub fn diff(old: &Program, new: &Program) -> Vec<Change> {
    let mut changes = Vec::new();
    changes.extend(compare(Element::Bridge, bridges(old), bridges(new), |a, b| a == b));
    changes.extend(compare(Element::Variable, vars(old), vars(new), |&a, &b| {
        same_block(old, old[a].init, new, new[b].init)
    }));
    changes.extend(compare(Element::Machine, machines(old), machines(new), |_, _| true));
    changes.extend(compare(Element::State, states(old), states(new), |&a, &b| same_actions(old, a, new, b)));
    changes.extend(compare(Element::Event, events(old), events(new), |&a, &b| {
        same_block(old, old[a].block, new, new[b].block)
    }));
    changes.extend(compare(Element::Transition, transitions(old), transitions(new), |_, _| true));
    changes.extend(reordered(old, new));
    changes.extend(compare(Element::Spawn, spawns(old), spawns(new), |a, b| a == b));
    changes.extend(compare(Element::Action, hooks(old), hooks(new), |&a, &b| same_block(old, a, new, b)));
    changes
}

/// Whether entering, being in and leaving a state does the same in both programs.
pub fn same_actions(old: &Program, a: StateId, new: &Program, b: StateId) -> bool {
    let (a, b) = (&old[a], &new[b]);
    same_blocks(old, &a.running, new, &b.running)
        && same_blocks(old, &a.onexit, new, &b.onexit)
        && a.onentry.len() == b.onentry.len()
        && a.onentry.iter().zip(&b.onentry).all(|pair| match pair {
            (Entry::Action(a), Entry::Action(b)) => same_block(old, *a, new, *b),
            (Entry::Spawn(a), Entry::Spawn(b)) => a.machine_name == b.machine_name && a.state_name == b.state_name,
            _ => false,
        })
}

fn same_blocks(old: &Program, a: &[BlockId], new: &Program, b: &[BlockId]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(&a, &b)| same_block(old, a, new, b))
}

pub fn same_block(old: &Program, a: BlockId, new: &Program, b: BlockId) -> bool {
    same_text(&old[a].code, &new[b].code) && same_modules(old, &old[a].requires, new, &new[b].requires)
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
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && same_text(a.1, b.1))
}

fn same_text(a: &str, b: &str) -> bool {
    a == b || same_code(a, b)
}

type Named<T> = Vec<(Arc<str>, T)>;

/// Removed ones in the old order, then added and changed ones in the new order.
fn compare<T, U>(kind: Element, old: Named<T>, new: Named<U>, same: impl Fn(&T, &U) -> bool) -> Vec<Change> {
    let before: HashMap<&str, &T> = old.iter().map(|(path, item)| (&**path, item)).collect();
    let after: HashSet<&str> = new.iter().map(|(path, _)| &**path).collect();
    let change = |op, path: &Arc<str>| Change { op, kind, path: path.clone(), to: None };
    let removed = old.iter().filter(|(path, _)| !after.contains(&**path)).map(|(path, _)| change(Op::Removed, path));
    let rest = new.iter().filter_map(|(path, item)| match before.get(&**path) {
        None => Some(change(Op::Added, path)),
        Some(was) if !same(was, item) => Some(change(Op::Changed, path)),
        Some(_) => None,
    });
    removed.chain(rest).collect()
}

fn bridges(program: &Program) -> Named<(Arc<str>, serde_json::Value)> {
    let one = |bridge: &Bridge| (bridge.name.clone(), (bridge.kind.clone(), bridge.config.clone()));
    program.bridges.iter().map(one).collect()
}

fn vars(program: &Program) -> Named<VarId> {
    program.vars.iter().enumerate().map(|(i, var)| (var.path.clone(), VarId(i as u32))).collect()
}

fn machines(program: &Program) -> Named<()> {
    program.machines.iter().map(|machine| (machine.path.clone(), ())).collect()
}

fn states(program: &Program) -> Named<StateId> {
    program.states.iter().enumerate().map(|(i, state)| (state.path.clone(), StateId(i as u32))).collect()
}

fn events(program: &Program) -> Named<EventId> {
    program.events.iter().enumerate().map(|(i, event)| (event.path.clone(), EventId(i as u32))).collect()
}

/// Only the state differs when a spawn is said to have changed.
fn spawns(program: &Program) -> Named<Arc<str>> {
    program.spawns.iter().map(|spawn| (spawn.machine_name.clone(), spawn.state_name.clone())).collect()
}

fn hooks(program: &Program) -> Named<BlockId> {
    let pause = program.on_pause.map(|block| ("onpause".into(), block));
    let resume = program.on_resume.map(|block| ("onresume".into(), block));
    pause.into_iter().chain(resume).collect()
}

/// A transition is what its machine, kind, sources, target, name and trigger are; equal ones are told apart by order.
fn transitions(program: &Program) -> Named<()> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut named = Vec::with_capacity(program.transitions.len());
    for transition in &program.transitions {
        let key = transition_key(program, transition);
        let order = seen.entry(key.clone()).or_insert(0);
        *order += 1;
        let key = if *order == 1 { key } else { format!("{key} #{order}") };
        named.push((key.into(), ()));
    }
    named
}

/// States out of which the same transitions are tried in another order.
fn reordered(old: &Program, new: &Program) -> Vec<Change> {
    let order = |program: &Program, state: StateId| -> Vec<String> {
        program[state].outgoing.iter().map(|&id| transition_key(program, &program[id])).collect()
    };
    let before: HashMap<&str, StateId> =
        old.states.iter().enumerate().map(|(i, state)| (&*state.path, StateId(i as u32))).collect();
    let mut changes = Vec::new();
    for (index, state) in new.states.iter().enumerate() {
        let Some(&was) = before.get(&*state.path) else { continue };
        let (mut was, mut now) = (order(old, was), order(new, StateId(index as u32)));
        was.retain(|key| now.contains(key));
        now.retain(|key| was.contains(key));
        // Equal ones have no order among themselves.
        was.dedup();
        now.dedup();
        if was != now {
            let path = format!("{}: order out of {}", new[state.machine].path, state.name).into();
            changes.push(Change { op: Op::Changed, kind: Element::Transition, path, to: None });
        }
    }
    changes
}

/// `follower: on bumping * -> bumpback`
pub fn transition_key(program: &Program, transition: &Transition) -> String {
    let sources = match &transition.sources {
        Sources::Any => "*".to_string(),
        Sources::These { names, .. } if names.len() == 1 => names[0].to_string(),
        Sources::These { names, .. } => format!("({})", names.join(" ")),
    };
    let kind = match transition.kind {
        TransitionKind::On => "on ",
        TransitionKind::Eps => "eps ",
        TransitionKind::Ontime => "ontime ",
        TransitionKind::Exit => "exit ",
    };
    let trigger = trigger_text(program, &transition.trigger);
    let space = if trigger.is_empty() { "" } else { " " };
    let name = transition.name.as_ref().map(|name| format!(" {name}")).unwrap_or_default();
    let machine = &program[transition.machine].path;
    format!("{machine}: {kind}{trigger}{space}{sources} -> {}{name}", transition.target_name)
}

/// As written: an event's name, a number or variable of milliseconds, a block in its brackets; nothing for eps.
pub fn trigger_text(program: &Program, trigger: &Trigger) -> String {
    match trigger {
        Trigger::Always => String::new(),
        Trigger::Event(event) => program[*event].name.to_string(),
        Trigger::UnknownEvent(name) | Trigger::AfterUnknown(name) => name.to_string(),
        Trigger::After(ms) => ms.to_string(),
        Trigger::AfterVar(var) => program[*var].name.to_string(),
        Trigger::Block(block) | Trigger::AfterBlock(block) => {
            let words: Vec<&str> = program[*block].code.split_whitespace().collect();
            format!("[{}]", words.join(" "))
        }
    }
}
