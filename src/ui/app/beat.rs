//! Counters and ages move on twice a second of program time, all of them together, and the list of what happened once a
//! second where much does: they can be read, and a slow line carries them. After a key, and while nothing runs, they tell
//! the very moment.

use super::App;
use crate::runtime::time::Time;
use crate::ui::view::Mode;

/// In microseconds.
const PERIOD: u64 = 500_000;
/// What can wait is listed at once after so long a quiet.
const QUIET: Time = Time(1_000_000);
/// So many entries are not kept waiting: they would be forgotten unseen.
const MANY: u64 = 1000;

/// The moment that the counters show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Beat {
    pub t: Time,
    pub step: u64,
    /// When what can wait was listed last.
    listed: Time,
}

impl App {
    /// The moment that counters and ages show.
    pub fn shown_at(&self) -> Beat {
        self.beat
    }

    /// After each record.
    pub(super) fn beat(&mut self) {
        let view = &self.view;
        if view.mode != Mode::Running {
            return self.beat_now();
        }
        if view.t.0 / PERIOD != self.beat.t.0 / PERIOD {
            (self.beat.t, self.beat.step) = (view.t, view.step);
        }
        let until = self.reading.until;
        let Some(newest) = view.journal.newest().filter(|entry| entry.number >= until) else { return };
        let quiet = view.t == self.beat.listed || view.t.since(self.beat.listed) >= QUIET;
        if quiet || !newest.kind.can_wait() || view.journal.next() - until > MANY {
            self.list();
        }
    }

    pub(super) fn beat_now(&mut self) {
        (self.beat.t, self.beat.step) = (self.view.t, self.view.step);
        self.list();
    }

    fn list(&mut self) {
        self.beat.listed = self.view.t;
        self.reading.until = self.view.journal.next();
    }
}
