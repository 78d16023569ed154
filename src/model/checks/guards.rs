//! What is certain of a transition's guard before anything runs.

use crate::lua::Gives;
use crate::model::ids::*;
use crate::model::program::*;

/// What an event or a trigger is made of.
pub fn condition(program: &Program, trigger: &Trigger) -> Option<BlockId> {
    match *trigger {
        Trigger::Event(event) => Some(program[event].block),
        Trigger::Block(block) => Some(block),
        _ => None,
    }
}

pub fn always(program: &Program, trigger: &Trigger) -> bool {
    match trigger {
        Trigger::Always => true,
        _ if after(program, trigger).is_some_and(|ms| ms <= 0.0) => true,
        _ => condition(program, trigger).is_some_and(|block| program[block].facts.gives == Gives::True),
    }
}

/// The milliseconds of a timeout that never changes.
pub fn after(program: &Program, trigger: &Trigger) -> Option<f64> {
    match *trigger {
        Trigger::After(ms) => Some(ms),
        Trigger::AfterBlock(block) => match program[block].facts.gives {
            Gives::Number(ms) => Some(ms),
            _ => None,
        },
        _ => None,
    }
}

/// The guards of a state in the order they are tested: exits out of its machine, then its own.
pub fn tested(program: &Program, state: StateId) -> impl Iterator<Item = TransitionId> + '_ {
    let machine = program[state].machine;
    let exits = program[machine].parent.map_or(&[][..], |parent| &program[parent].exits);
    let leaves = move |&id: &TransitionId| program[id].machine == machine && program[id].leaves(state);
    exits.iter().copied().filter(leaves).chain(program[state].outgoing.iter().copied())
}
