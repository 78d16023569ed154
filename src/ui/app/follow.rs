//! The selection going along with what happens, when a person asks for it.

use super::App;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Follow {
    #[default]
    Off,
    /// The step of the change the selection is at, and how deep that was.
    On { step: u64, depth: usize },
}

impl Follow {
    pub fn is_on(self) -> bool {
        self != Follow::Off
    }
}

impl App {
    pub(super) fn toggle_follow(&mut self) {
        self.follow = match self.follow {
            Follow::Off => Follow::On { step: 0, depth: 0 },
            Follow::On { .. } => Follow::Off,
        };
        self.message = Some(match self.follow {
            Follow::On { .. } => "the selection follows the innermost change".into(),
            Follow::Off => "the selection holds still".into(),
        });
    }

    /// Of the states entered in one step the innermost is selected.
    pub(super) fn entered(&mut self, now: u64, state: &super::Path) {
        let Follow::On { step, depth } = self.follow else { return };
        let inner = state.matches('/').count();
        let known = self.program().is_some_and(|program| program.state(state).is_some());
        if known && (step != now || inner >= depth) {
            self.follow = Follow::On { step: now, depth: inner };
            self.select(state.clone());
            self.settle();
        }
    }
}
