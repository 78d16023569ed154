//! Where the program will pause, and who wants it.

use std::collections::HashMap;

use super::View;
use crate::model::transition_names::transition_names;
use crate::model::{MachineId, TransitionId};
use crate::runtime::command::BreakAt;
use crate::runtime::record::{Breakpoint, Setter};

impl View {
    /// Who set a breakpoint; where both did, the person, who can clear it.
    pub fn breakpoint(&self, at: &BreakAt) -> Option<Setter> {
        self.setter(|other| other == at)
    }

    pub fn breaks_at_state(&self, path: &str) -> Option<Setter> {
        self.setter(|at| matches!(at, BreakAt::State { state } if **state == *path))
    }

    pub fn breaks_at_transition(&self, transition: TransitionId) -> Option<Setter> {
        self.transition_breaks.get(&transition).copied()
    }

    /// Finds the transitions among the breakpoints: after another program or other breakpoints have come.
    pub(super) fn find_transitions(&mut self) {
        self.transition_breaks.clear();
        let mut wanted: HashMap<&str, Setter> = HashMap::new();
        for Breakpoint { at, by } in &self.breakpoints {
            if let BreakAt::Transition { transition } = at {
                let known = wanted.entry(transition).or_insert(*by);
                *known = if *by == Setter::Command { *by } else { *known };
            }
        }
        let Some(program) = self.program.as_ref().filter(|_| !wanted.is_empty()) else { return };
        let machines = (0..program.machines.len() as u32).map(MachineId);
        let names = machines.flat_map(|machine| transition_names(program, machine));
        self.transition_breaks.extend(names.filter_map(|(id, name)| Some((id, *wanted.get(&*name)?))));
    }

    fn setter(&self, is: impl Fn(&BreakAt) -> bool) -> Option<Setter> {
        let mut there = self.breakpoints.iter().filter(|breakpoint| is(&breakpoint.at));
        let first = there.next()?.by;
        if there.any(|breakpoint| breakpoint.by == Setter::Command) { Some(Setter::Command) } else { Some(first) }
    }
}
