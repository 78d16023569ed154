//! The ways out of a state, as a person counts them: also those that can never be taken as they are written, and those that
//! an outer machine looks at. Knows nothing of what is true.

use super::ids::*;
use super::program::*;

/// The state's own transitions in the order they are tried; then exits of machines written in it, which leave it; then
/// exits out of it, which leave the state around its machine.
pub fn ways_out(program: &Program, state: StateId) -> Vec<TransitionId> {
    let machine = program[state].machine;
    let is_exit = |&id: &TransitionId| program[id].kind == TransitionKind::Exit;
    let leaving = || program[machine].transitions.iter().copied().filter(|&id| program[id].leaves(state));
    let nested = program[state].machines.iter().flat_map(|&nested| program[nested].transitions.iter().copied());
    let own = leaving().filter(|id| !is_exit(id));
    own.chain(nested.filter(is_exit)).chain(leaving().filter(is_exit)).collect()
}

/// The block of a transition's trigger: a condition, or the length of a timeout.
pub fn guard_block(program: &Program, transition: TransitionId) -> Option<BlockId> {
    match program[transition].trigger {
        Trigger::Event(event) => Some(program[event].block),
        Trigger::Block(block) | Trigger::AfterBlock(block) => Some(block),
        _ => None,
    }
}
