//! A machine and its states as the records tell of them, and the timeout that comes next.

use super::trail::Trace;
use super::{Path, View};
use crate::model::{Program, StateId, Trigger};
use crate::runtime::time::Time;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machine {
    pub running: bool,
    /// The path of the state it is in.
    pub active: Option<Path>,
    /// When that state was entered.
    pub entered: Time,
    /// The state that spawned it; none at top level.
    pub spawned_by: Option<Path>,
    /// The transitions taken last, the newest first.
    pub trail: Vec<Trace>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// How many times it was entered since the program began.
    pub visits: u64,
    pub last_left: Option<Time>,
}

/// A timeout that runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeout {
    /// ms since the state was entered.
    pub elapsed: f64,
    /// ms after which it is due.
    pub due: f64,
}

impl Timeout {
    /// ms until it is due.
    pub fn left(self) -> f64 {
        (self.due - self.elapsed).max(0.0)
    }

    /// How much of it is over, 0 to 1.
    pub fn part(self) -> f64 {
        if self.due > 0.0 { (self.elapsed / self.due).clamp(0.0, 1.0) } else { 1.0 }
    }
}

impl View {
    /// How long the active state of a machine has been active at a moment; none where it isn't
    /// running or was entered since.
    pub fn elapsed(&self, machine: &str, now: Time) -> Option<Time> {
        let machine = self.machines.get(machine).filter(|machine| machine.running)?;
        machine.active.as_ref()?;
        (machine.entered <= now).then(|| now.since(machine.entered))
    }

    /// The timeout out of an active state that is due first, as far as its length is known without running Lua.
    pub fn timeout(&self, program: &Program, state: StateId, now: Time) -> Option<Timeout> {
        let state = &program[state];
        if !self.is_active(&state.path) {
            return None;
        }
        let elapsed = self.elapsed(&program[state.machine].path, now)?.ms();
        let lengths = state.outgoing.iter().filter_map(|&id| self.length(program, &program[id].trigger));
        let due = lengths.min_by(f64::total_cmp)?;
        Some(Timeout { elapsed, due })
    }

    fn length(&self, program: &Program, trigger: &Trigger) -> Option<f64> {
        let ms = match trigger {
            Trigger::After(ms) => *ms,
            Trigger::AfterVar(var) => self.variables.get(&program[*var].path)?.number()?,
            Trigger::AfterBlock(block) => program[*block].code.trim().parse().ok()?,
            _ => return None,
        };
        ms.is_finite().then_some(ms)
    }
}
