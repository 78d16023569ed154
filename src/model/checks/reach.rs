//! States that nothing leads to.

use crate::model::ids::*;
use crate::model::program::*;
use crate::syntax::{Code, Diagnostic};

/// States that neither a spawn nor a transition out of a state that may be active leads to. Of those that lead to one
/// another only the first is told. A machine that is never spawned has its own finding.
pub fn unreachable_state(program: &Program) -> Vec<Diagnostic> {
    let reached = reached(program);
    let runs = |machine: MachineId| program[machine].states.iter().any(|&state| reached[state.index()]);
    let lost: Vec<StateId> = (0..program.states.len() as u32)
        .map(StateId)
        .filter(|&state| !reached[state.index()] && runs(program[state].machine))
        .collect();
    let mut led_to = vec![false; program.states.len()];
    for &state in &lost {
        for target in targets(program, state).filter(|&target| target != state) {
            led_to[target.index()] = true;
        }
    }
    let roots = lost.iter().filter(|state| !led_to[state.index()]);
    // The others are led to by those, or in a circle.
    let mut told = reached;
    let mut found = Vec::new();
    for &state in roots.chain(&lost) {
        if !told[state.index()] {
            let behind = follow(program, state, &mut told);
            let by = if led_to[state.index()] { "nothing but what comes after it" } else { "nothing" };
            found.push(unreachable(program, state, by, &behind[1..]));
        }
    }
    found
}

fn unreachable(program: &Program, state: StateId, by: &str, behind: &[StateId]) -> Diagnostic {
    let name = &program[state].name;
    let nor = match behind {
        [] => String::new(),
        [other] => format!("; nor is `{}` after it", program[*other].name),
        others => format!("; nor are the {} states after it", others.len()),
    };
    let message = format!("state `{name}` is never entered, as {by} leads there{nor}");
    Diagnostic::warning(Code::UnreachableState, program[state].name_span, message)
        .help(format!("add a transition to it, `(on .. STATE -> {name})`, or remove it"))
}

/// What a state's own transitions lead to.
fn targets(program: &Program, state: StateId) -> impl Iterator<Item = StateId> + '_ {
    program[state].outgoing.iter().filter_map(|&id| program[id].target)
}

/// The states that can be come to from one, itself among them, that were not marked yet; they are then.
fn follow(program: &Program, from: StateId, marked: &mut [bool]) -> Vec<StateId> {
    let mut met = vec![from];
    marked[from.index()] = true;
    let mut next = 0;
    while let Some(&state) = met.get(next) {
        next += 1;
        for target in targets(program, state) {
            if !std::mem::replace(&mut marked[target.index()], true) {
                met.push(target);
            }
        }
    }
    met
}

/// Which states may become active: from all that is spawned on, and in machines that other programs may spawn, all.
fn reached(program: &Program) -> Vec<bool> {
    let mut reached = vec![false; program.states.len()];
    let exported = program.exported.iter().flat_map(|&machine| program[machine].states.iter().copied());
    let spawned = program.spawns.iter().filter_map(|spawn| spawn.target);
    let mut open: Vec<StateId> = spawned.map(|(_, state)| state).chain(exported).collect();
    while let Some(state) = open.pop() {
        if !std::mem::replace(&mut reached[state.index()], true) {
            open.extend(targets(program, state));
            open.extend(spawned_in(program, state).map(|(_, start)| start));
            open.extend(exits(program, state));
        }
    }
    reached
}

fn spawned_in(program: &Program, state: StateId) -> impl Iterator<Item = (MachineId, StateId)> + '_ {
    program[state].onentry.iter().filter_map(|item| match item {
        Entry::Spawn(spawn) => spawn.target,
        Entry::Action(_) => None,
    })
}

/// Where the exits out of a nested state lead.
fn exits(program: &Program, state: StateId) -> impl Iterator<Item = StateId> + '_ {
    let machine = program[state].machine;
    let around = program[machine].parent.map_or(&[][..], |parent| &program[parent].exits);
    let own = move |id: &&TransitionId| program[**id].machine == machine && program[**id].leaves(state);
    around.iter().filter(own).filter_map(|&id| program[id].target)
}
