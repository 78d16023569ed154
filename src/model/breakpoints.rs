//! Where a program can pause: the states and transitions with a `(break)`, what such places are called, and where they
//! are after an edit. Knows nothing of pausing.

use std::collections::HashSet;
use std::sync::Arc;

use super::change::{Change, Element, Op};
use super::ids::*;
use super::matching::Matching;
use super::program::*;
use super::transition_names::TransitionNames;

/// A state that is entered, or a transition that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Spot {
    State(StateId),
    Transition(TransitionId),
}

impl Spot {
    /// Whether a `(break)` stands there.
    pub fn is_in_source(self, program: &Program) -> bool {
        match self {
            Spot::State(state) => program[state].breakpoint.is_some(),
            Spot::Transition(transition) => program[transition].breakpoint.is_some(),
        }
    }

    /// Where it is in the next program: the state under whatever name, the transition that says the same.
    pub fn follow(self, matching: &Matching) -> Option<Spot> {
        match self {
            Spot::State(state) => matching.state(state).map(Spot::State),
            Spot::Transition(transition) => matching.transition(transition).map(Spot::Transition),
        }
    }
}

/// All with a `(break)`: states, then transitions.
pub fn in_source(program: &Program) -> impl Iterator<Item = Spot> + '_ {
    let states = (0..program.states.len() as u32).map(|index| Spot::State(StateId(index)));
    let transitions = (0..program.transitions.len() as u32).map(|index| Spot::Transition(TransitionId(index)));
    states.chain(transitions).filter(|spot| spot.is_in_source(program))
}

/// What spots are called: a state by its path, a transition as lists of changes name it.
pub struct SpotNames<'p> {
    program: &'p Program,
    pub transitions: TransitionNames<'p>,
}

impl<'p> SpotNames<'p> {
    pub fn of(program: &'p Program) -> Self {
        SpotNames { program, transitions: TransitionNames::of(program) }
    }

    pub fn name(&self, spot: Spot) -> Arc<str> {
        match spot {
            Spot::State(state) => self.program[state].path.clone(),
            Spot::Transition(transition) => self.transitions.name(transition),
        }
    }
}

/// How the `(break)`s of two programs differ; nothing else about their elements changes with them.
pub fn changes(old: &Program, new: &Program, matching: &Matching) -> Vec<Change> {
    let (was, now) = (SpotNames::of(old), SpotNames::of(new));
    let change = |op, path| Change { op, kind: Element::Breakpoint, path, to: None };
    let mut kept = HashSet::new();
    let mut changes = Vec::new();
    for spot in in_source(old) {
        match spot.follow(matching).filter(|now| now.is_in_source(new)) {
            Some(now) => drop(kept.insert(now)),
            None => changes.push(change(Op::Removed, was.name(spot))),
        }
    }
    let added = in_source(new).filter(|spot| !kept.contains(spot));
    changes.extend(added.map(|spot| change(Op::Added, now.name(spot))));
    changes
}
