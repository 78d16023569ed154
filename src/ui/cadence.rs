//! When a frame is drawn: at once after a key, otherwise some time after the last one. Knows no clock: the time is told to it.

use std::time::Duration;

/// Frames are at least this far apart while the engine talks.
const FRAME: Duration = Duration::from_millis(40);

/// Times are counted from any moment that stays the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cadence {
    drawn: Option<Duration>,
    asked: bool,
}

impl Cadence {
    /// A person waits for an answer.
    pub fn ask(&mut self) {
        self.asked = true;
    }

    pub fn drawn(&mut self, now: Duration) {
        *self = Cadence { drawn: Some(now), asked: false };
    }

    /// How long a frame that is wanted now has to wait.
    pub fn wait(&self, now: Duration) -> Duration {
        match self.drawn {
            Some(drawn) if !self.asked => (drawn + FRAME).saturating_sub(now),
            _ => Duration::ZERO,
        }
    }
}
