//! The machines and states of a program as rows, outermost first, in the order written. Activity never changes it.

use std::collections::BTreeSet;

use super::view::{Path, owner, within};
use crate::model::{MachineId, Program, StateId};

#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub path: Path,
    pub element: Element,
    pub depth: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    Machine(MachineId),
    State(StateId),
}

/// The rows to be seen when the insides of `folded` are hidden.
pub fn rows(program: &Program, folded: &BTreeSet<Path>) -> Vec<Row> {
    let mut rows = Vec::new();
    for &machine in &program.tops {
        add(program, folded, machine, 0, &mut rows);
    }
    rows
}

fn add(program: &Program, folded: &BTreeSet<Path>, machine: MachineId, depth: u16, rows: &mut Vec<Row>) {
    let path = program[machine].path.clone();
    let open = !folded.contains(&path);
    rows.push(Row { path, element: Element::Machine(machine), depth });
    if !open {
        return;
    }
    for &state in &program[machine].states {
        let path = program[state].path.clone();
        let open = !folded.contains(&path);
        rows.push(Row { path, element: Element::State(state), depth: depth + 1 });
        let inner = program[state].machines.iter().filter(|_| open);
        for &machine in inner {
            add(program, folded, machine, depth + 2, rows);
        }
    }
}

/// The element of a path.
pub fn element(program: &Program, path: &str) -> Option<Element> {
    let state = || program.state(path).map(Element::State);
    program.machine(path).map(Element::Machine).or_else(state)
}

/// The machine a path lies in or is.
pub fn machine_of(program: &Program, path: &str) -> Option<MachineId> {
    match element(program, path)? {
        Element::Machine(machine) => Some(machine),
        Element::State(state) => Some(program[state].machine),
    }
}

/// Where a selection goes when the program changes: to itself, to what took its place, else to the nearest that is left.
pub fn survivor(old: &Program, new: &Program, selected: &Path) -> Option<Path> {
    if element(new, selected).is_some() {
        return Some(selected.clone());
    }
    if let Some(renamed) = in_place_of(old, new, selected) {
        return Some(renamed);
    }
    let rows = rows(old, &BTreeSet::new());
    let at = rows.iter().position(|row| row.path == *selected)?;
    let left = |row: &&Row| element(new, &row.path).is_some() && !within(&row.path, selected);
    let siblings = |row: &&Row| owner(&row.path) == owner(selected);
    let after = || rows[at..].iter();
    let before = || rows[..at].iter().rev();
    let sibling = after().filter(siblings).find(left).or_else(|| before().filter(siblings).find(left));
    let nearest = sibling.or_else(|| before().find(left)).or_else(|| after().find(left));
    nearest.map(|row| row.path.clone())
}

/// A state that stands where the old one stood, and is new: it was renamed.
fn in_place_of(old: &Program, new: &Program, selected: &str) -> Option<Path> {
    let Element::State(state) = element(old, selected)? else { return None };
    let machine = &old[old[state].machine];
    let states = &new[new.machine(&machine.path)?].states;
    let at = machine.states.iter().position(|&other| other == state)?;
    let there = &new[*states.get(at)?];
    let same_length = states.len() == machine.states.len();
    (same_length && old.state(&there.path).is_none()).then(|| there.path.clone())
}
