//! What leads a person on: the tour, which has a strip of the screen, and the hints in the last line. Both see what
//! happens and what a person does.

use ratatui::layout::{Rect, Size};

use super::moment::Moment;
use super::{App, Effect};
use crate::ui::action::Action;
use crate::ui::hints::Hint;
use crate::ui::panes::strip;
use crate::ui::tour::{Shown, Tour};

const NO_TOUR: &str = "no tour is going on; `lrp tour` begins one";

impl App {
    /// The same with the tour's strip.
    pub fn guided(self, tour: Tour) -> App {
        App { tour: Some(tour), ..self }
    }

    pub fn tour(&self) -> Option<&Tour> {
        self.tour.as_ref()
    }

    /// What is left of the terminal beside the strip.
    pub(super) fn area(&self) -> Rect {
        let Size { width, height } = self.options.size;
        strip::divide(self, Rect::new(0, 0, width, height)).1
    }

    pub(super) fn next_task(&mut self) -> Vec<Effect> {
        match &mut self.tour {
            Some(tour) => tour.next(&self.view),
            None => return self.say(NO_TOUR),
        }
        Vec::new()
    }

    pub(super) fn toggle_strip(&mut self) -> Vec<Effect> {
        match &mut self.tour {
            Some(tour) => match tour.shown {
                Shown::Strip => {
                    tour.shown = Shown::Nothing;
                    return self.say(format!("{} shows the tour again", self.keys().name(Action::TourStrip)));
                }
                Shown::Nothing => tour.shown = Shown::Strip,
            },
            None => return self.say(NO_TOUR),
        }
        Vec::new()
    }

    /// The hint to be shown; while the tour speaks, none.
    pub fn hint(&self) -> Option<Hint> {
        self.hints.shown().filter(|_| self.tour.is_none())
    }

    pub(super) fn noticed(&mut self, action: Action) {
        self.hints.did(action);
        if let Some(tour) = &mut self.tour {
            tour.did(action, &self.view);
        }
    }

    /// Of real time; the robot's status tells it.
    pub(super) fn half_a_second(&mut self) {
        self.moment = self.moment.and_then(Moment::later);
        let fits = self.fitting_hints();
        self.hints.beat(&fits);
    }

    pub(super) fn reconsider_hint(&mut self) {
        let fits = self.fitting_hints();
        self.hints.key(&fits);
    }

    /// None beside the keys for an edit that waits, or for values that one took.
    fn fitting_hints(&self) -> Vec<Hint> {
        if self.offers(Action::ApplyHeld) || self.offers(Action::GiveBack) {
            return Vec::new();
        }
        Hint::ALL.into_iter().filter(|hint| hint.fits(self)).collect()
    }
}
