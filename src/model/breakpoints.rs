//! Where a program can pause: the states and transitions with a `(break)`, what such places are called, and where they
//! are after an edit. Knows nothing of pausing.

use std::sync::Arc;

use super::change::{Change, Element, Op};
use super::diff::{same_block, transition_key};
use super::ids::*;
use super::matching::Matching;
use super::program::*;

/// A state that is entered, or a transition that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    State(StateId),
    Transition(TransitionId),
}

impl Spot {
    /// A state's path, or a transition as lists of changes name it.
    pub fn name(self, program: &Program) -> Arc<str> {
        match self {
            Spot::State(state) => program[state].path.clone(),
            Spot::Transition(transition) => transition_name(program, transition),
        }
    }

    /// Where it is in another program.
    pub fn followed(self, old: &Program, new: &Program, matching: &Matching) -> Option<Spot> {
        match self {
            Spot::State(state) => matching.state(state).map(Spot::State),
            Spot::Transition(transition) => followed(old, transition, new, matching).map(Spot::Transition),
        }
    }

    /// Whether a `(break)` stands there.
    pub fn is_in_source(self, program: &Program) -> bool {
        match self {
            Spot::State(state) => program[state].breakpoint.is_some(),
            Spot::Transition(transition) => program[transition].breakpoint.is_some(),
        }
    }
}

/// All with a `(break)`: states, then transitions.
pub fn in_source(program: &Program) -> impl Iterator<Item = Spot> + '_ {
    let states = (0..program.states.len() as u32).map(|index| Spot::State(StateId(index)));
    let transitions = (0..program.transitions.len() as u32).map(|index| Spot::Transition(TransitionId(index)));
    states.chain(transitions).filter(|spot| spot.is_in_source(program))
}

/// `follower: on bumping * -> bumpback`; equal ones of a machine are told apart by order: the second ends with `#2`.
pub fn transition_name(program: &Program, id: TransitionId) -> Arc<str> {
    let key = transition_key(program, &program[id]);
    let before = program[program[id].machine].transitions.iter().take_while(|&&other| other != id);
    match before.filter(|&&other| transition_key(program, &program[other]) == key).count() {
        0 => key.into(),
        earlier => format!("{key} #{}", earlier + 1).into(),
    }
}

pub fn transition_named(program: &Program, name: &str) -> Option<TransitionId> {
    let (machine, _) = name.split_once(": ")?;
    let machine = program.machine(machine)?;
    program[machine].transitions.iter().copied().find(|&id| &*transition_name(program, id) == name)
}

/// How the `(break)`s of two programs differ; nothing else about their elements changes with them.
pub fn changes(old: &Program, new: &Program, matching: &Matching) -> Vec<Change> {
    let change = |op, path| Change { op, kind: Element::Breakpoint, path, to: None };
    let (mut gone, mut kept) = (Vec::new(), Vec::new());
    for spot in in_source(old) {
        match spot.followed(old, new, matching).filter(|now| now.is_in_source(new)) {
            Some(now) => kept.push(now),
            None => gone.push(change(Op::Removed, spot.name(old))),
        }
    }
    let added = in_source(new).filter(|spot| !kept.contains(spot)).map(|spot| change(Op::Added, spot.name(new)));
    gone.into_iter().chain(added).collect()
}

/// The transition of the new program that is the same but for renamed elements; the nth of several equal ones.
fn followed(old: &Program, id: TransitionId, new: &Program, matching: &Matching) -> Option<TransitionId> {
    let machine = old[id].machine;
    let now = matching.machine(machine)?;
    let twins = old[machine].transitions.iter().take_while(|&&other| other != id);
    let key = transition_key(old, &old[id]);
    let earlier = twins.filter(|&&other| transition_key(old, &old[other]) == key).count();
    let same = |&other: &TransitionId| is_same(old, &old[id], new, &new[other], matching);
    new[now].transitions.iter().copied().filter(same).nth(earlier)
}

fn is_same(old: &Program, a: &Transition, new: &Program, b: &Transition, matching: &Matching) -> bool {
    let same_target = match (a.target, b.target) {
        (Some(a), Some(b)) => matching.state(a) == Some(b),
        (None, None) => a.target_name == b.target_name,
        _ => false,
    };
    let same_sources = match (&a.sources, &b.sources) {
        (Sources::Any, Sources::Any) => true,
        (Sources::These { states: a, names: all_a }, Sources::These { states: b, names: all_b }) => {
            all_a.len() == all_b.len() && a.iter().map(|&state| matching.state(state)).eq(b.iter().copied().map(Some))
        }
        _ => false,
    };
    a.kind == b.kind
        && a.name == b.name
        && same_target
        && same_sources
        && same_trigger(old, &a.trigger, new, &b.trigger, matching)
}

fn same_trigger(old: &Program, a: &Trigger, new: &Program, b: &Trigger, matching: &Matching) -> bool {
    match (a, b) {
        (Trigger::Event(a), Trigger::Event(b)) => matching.event(*a) == Some(*b),
        (Trigger::AfterVar(a), Trigger::AfterVar(b)) => matching.var(*a) == Some(*b),
        (Trigger::Block(a), Trigger::Block(b)) | (Trigger::AfterBlock(a), Trigger::AfterBlock(b)) => {
            same_block(old, *a, new, *b)
        }
        (a, b) => a == b,
    }
}
