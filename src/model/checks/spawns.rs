//! Machines that are spawned too often, or not at all.

use std::collections::HashMap;

use crate::model::ids::*;
use crate::model::program::*;
use crate::syntax::{Code, Diagnostic, FileId, Span};

/// Spawns of a machine that runs already when they come: it was spawned just before, it is the machine they are written
/// in, or it runs as long as the program.
pub fn already_running(program: &Program) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut tops: HashMap<MachineId, Span> = HashMap::new();
    for spawn in &program.spawns {
        found.extend(again(program, spawn, &mut tops));
    }
    for (index, state) in program.states.iter().enumerate() {
        let mut here: HashMap<MachineId, Span> = HashMap::new();
        for item in &state.onentry {
            if let Entry::Spawn(spawn) = item {
                let outside = || while_running(program, StateId(index as u32), spawn, &tops);
                found.extend(again(program, spawn, &mut here).or_else(outside));
            }
        }
    }
    found
}

fn again(program: &Program, spawn: &Spawn, spawned: &mut HashMap<MachineId, Span>) -> Option<Diagnostic> {
    let (machine, _) = spawn.target?;
    match spawned.get(&machine) {
        Some(&first) => Some(running(program, spawn, machine, "it is spawned just before").also(first, "spawned here")),
        None => {
            spawned.insert(machine, spawn.span);
            None
        }
    }
}

fn while_running(
    program: &Program,
    state: StateId,
    spawn: &Spawn,
    tops: &HashMap<MachineId, Span>,
) -> Option<Diagnostic> {
    let (machine, _) = spawn.target?;
    let mut around = std::iter::successors(Some(program[state].machine), |&machine| program.enclosing(machine));
    if around.any(|it| it == machine) {
        return Some(running(program, spawn, machine, "this state is part of it"));
    }
    let top = tops.get(&machine)?;
    Some(running(program, spawn, machine, "it is spawned with the program and runs on").also(*top, "spawned here"))
}

fn running(program: &Program, spawn: &Spawn, machine: MachineId, why: &str) -> Diagnostic {
    let message = format!("machine `{}` is running already when it is spawned here: {why}", program[machine].path);
    Diagnostic::warning(Code::AlreadyRunning, spawn.span, message)
        .help("a machine runs at most once: write a second machine, or remove one of the spawns")
}

/// Machines that no spawn names, but those that other programs may spawn and those written in such machines. Not told
/// of the top level where nothing is spawned at all, nor of imported files, whose own spawns don't count.
pub fn never_spawned(program: &Program) -> Vec<Diagnostic> {
    let mut used = vec![false; program.machines.len()];
    let entries = program.states.iter().flat_map(|state| &state.onentry).filter_map(|item| match item {
        Entry::Spawn(spawn) => Some(spawn),
        Entry::Action(_) => None,
    });
    for (machine, _) in entries.chain(&program.spawns).filter_map(|spawn| spawn.target) {
        used[machine.index()] = true;
    }
    for machine in &program.exported {
        used[machine.index()] = true;
    }
    let told_already = program.spawns.is_empty() && program.exported.is_empty();
    let all = (0..program.machines.len() as u32).map(MachineId);
    let lost = all.filter(|&machine| {
        let mut outwards = std::iter::successors(Some(machine), |&it| program.enclosing(it));
        let outermost = outwards.clone().all(|it| it == machine || used[it.index()]);
        let in_dead_program = told_already && outwards.any(|it| program[it].parent.is_none() && !used[it.index()]);
        !used[machine.index()] && outermost && !in_dead_program && program[machine].span.file == FileId(0)
    });
    lost.map(|machine| lonely(program, machine)).collect()
}

fn lonely(program: &Program, machine: MachineId) -> Diagnostic {
    let Machine { name, states, parent, name_span, .. } = &program[machine];
    let start = states.first().map_or("STATE", |&state| &*program[state].name);
    let help = match parent {
        Some(parent) => format!("add `(onentry (spawn {name} {start}))` to state `{}`", program[*parent].name),
        None => format!("add `(spawn {name} {start})` at the end of the file, or to the state that is to start it"),
    };
    Diagnostic::warning(Code::NeverSpawned, *name_span, format!("machine `{name}` is never spawned")).help(help)
}
