//! The transitions that each machine took last, through edits of the program they belong to.

use super::machine::Machine;
use super::{Path, View};
use crate::model::transition_names::transition_names;
use crate::model::{MachineId, Program};

/// How many transitions of each machine are remembered.
const TRAIL: usize = 3;

/// A transition that was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    pub which: Which,
    /// The name of the state it led out of.
    pub from: Path,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Of the machine's own transitions, from 0 in the order written.
    Own(u32),
    /// An exit of a machine nested in it.
    Exit,
}

impl Machine {
    pub(super) fn took(&mut self, which: Which, from: Path) {
        self.trail.retain(|trace| trace.which != which || trace.from != from);
        self.trail.insert(0, Trace { which, from });
        self.trail.truncate(TRAIL);
    }
}

impl View {
    /// Before another program is taken over: where the transitions taken last stand in it. One that is there no longer
    /// under its name stays only where none came or went.
    pub(super) fn follow_trails(&mut self, now: &Program) {
        let Some(before) = &self.program else { return };
        let trodden = self.machines.iter_mut().filter(|(_, machine)| !machine.trail.is_empty());
        for (path, machine) in trodden {
            let Some((old, new)) = before.machine(path).zip(now.machine(path)) else { continue };
            let (old, new) = (names(before, old), names(now, new));
            machine.trail.retain_mut(|trace| {
                let Which::Own(index) = &mut trace.which else { return true };
                let known = old.get(*index as usize).and_then(|name| new.iter().position(|other| other == name));
                *index = known.map_or(*index, |known| known as u32);
                known.is_some() || old.len() == new.len()
            });
        }
    }
}

fn names(program: &Program, machine: MachineId) -> Vec<Path> {
    transition_names(program, machine).map(|(_, name)| name).collect()
}
