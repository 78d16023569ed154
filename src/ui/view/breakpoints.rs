//! Where the program will pause, and who wants it.

use super::View;
use crate::model::diff::transition_name;
use crate::model::{Program, TransitionId};
use crate::runtime::command::BreakAt;
use crate::runtime::record::Setter;

impl View {
    /// Who set a breakpoint; where both did, the person, who can clear it.
    pub fn breakpoint(&self, at: &BreakAt) -> Option<Setter> {
        self.setter(|other| other == at)
    }

    pub fn breaks_at_state(&self, path: &str) -> Option<Setter> {
        self.setter(|at| matches!(at, BreakAt::State { state } if **state == *path))
    }

    pub fn breaks_at_transition(&self, text: &str) -> Option<Setter> {
        self.setter(|at| matches!(at, BreakAt::Transition { transition } if **transition == *text))
    }

    fn setter(&self, is: impl Fn(&BreakAt) -> bool) -> Option<Setter> {
        let mut there = self.breakpoints.iter().filter(|breakpoint| is(&breakpoint.at));
        let first = there.next()?.by;
        if there.any(|breakpoint| breakpoint.by == Setter::Command) { Some(Setter::Command) } else { Some(first) }
    }
}

/// A transition as breakpoints and lists of changes name it: equal ones are told apart by their order.
pub fn transition_text(program: &Program, id: TransitionId) -> String {
    transition_name(program, id).to_string()
}
