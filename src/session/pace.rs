//! When the next step is due and what program time it has. Knows no clock: real time is told to it.

use std::time::Duration;

use crate::runtime::Time;

/// Steps a second; none: as fast as possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate(Option<f64>);

impl Rate {
    pub const MAX_HZ: f64 = 100_000.0;

    /// `hz`: 0 is as fast as possible; at most [`Rate::MAX_HZ`].
    pub fn new(hz: f64) -> Option<Rate> {
        match hz {
            0.0 => Some(Rate(None)),
            hz if hz.is_finite() && hz > 0.0 && hz <= Self::MAX_HZ => Some(Rate(Some(hz))),
            _ => None,
        }
    }

    pub fn hz(self) -> f64 {
        self.0.unwrap_or(0.0)
    }
}

/// Ten steps a second.
impl Default for Rate {
    fn default() -> Rate {
        Rate(Some(10.0))
    }
}

/// Program time as steps of one period each, counted from where the rate was last set so that nothing drifts.
#[derive(Debug)]
pub struct Pace {
    rate: Rate,
    now: Time,
    /// Where it is counted from, and the real time that this corresponds to; both later by each pause.
    base: Time,
    started: Duration,
    periods: u64,
}

#[derive(Debug, PartialEq, Eq)]
pub struct Due {
    pub now: Time,
    /// Steps that couldn't be made in time.
    pub skipped: u64,
    /// How long after its moment the step begins.
    pub late: Duration,
}

impl Pace {
    pub fn new(rate: Rate, real: Duration) -> Pace {
        Pace { rate, now: Time::ZERO, base: Time::ZERO, started: real, periods: 0 }
    }

    pub fn rate(&self) -> Rate {
        self.rate
    }

    /// Of the last step.
    pub fn now(&self) -> Time {
        self.now
    }

    /// Steps a second from now on.
    pub fn set_rate(&mut self, rate: Rate, real: Duration) {
        *self = Pace { rate, now: self.now, base: self.now, started: real, periods: 0 };
    }

    /// Program time stood still until now.
    pub fn resume(&mut self, real: Duration) {
        self.set_rate(self.rate, real);
    }

    /// How long until the next step.
    pub fn wait(&self, real: Duration) -> Duration {
        self.due_at(self.periods + 1).saturating_sub(real)
    }

    fn due_at(&self, periods: u64) -> Duration {
        match self.rate.0 {
            Some(hz) => self.started + Duration::from_secs_f64(periods as f64 / hz),
            None => Duration::ZERO,
        }
    }

    /// The next step, whatever the time: for virtual time and for steps by hand.
    pub fn make(&mut self) -> Time {
        match self.rate.0 {
            Some(hz) => self.count(hz, 1),
            None => {
                self.base = self.base + Time(1000);
                self.now = self.now + Time(1000);
            }
        }
        self.now
    }

    fn count(&mut self, hz: f64, periods: u64) {
        self.periods += periods;
        self.now = self.base + Time((self.periods as f64 * 1e6 / hz).round() as u64);
    }

    /// The step that is due at a real time.
    pub fn take(&mut self, real: Duration) -> Due {
        let Some(hz) = self.rate.0 else {
            self.now = self.base + Time(real.saturating_sub(self.started).as_micros() as u64);
            return Due { now: self.now, skipped: 0, late: Duration::ZERO };
        };
        let late = real.saturating_sub(self.due_at(self.periods + 1));
        let skipped = (late.as_secs_f64() * hz).floor() as u64;
        self.count(hz, 1 + skipped);
        Due { now: self.now, skipped, late }
    }
}
