//! How a number moved: one value for each half second of program time, as far as it changed. Time alone adds nothing, so
//! a curve drawn from it moves twice a second at most.

use std::collections::VecDeque;

use crate::runtime::time::Time;

/// How many changes are kept.
const KEPT: usize = 128;
/// Of program time.
pub const PERIOD_MS: f64 = 500.0;
/// In microseconds.
const PERIOD: u64 = 500_000;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// The last value of each period in which there was a change, and which period that was; oldest first.
    changes: VecDeque<(u64, f64)>,
}

impl History {
    pub fn remember(&mut self, number: f64, at: Time) {
        let period = at.0 / PERIOD;
        match self.changes.back_mut() {
            Some((last, value)) if *last == period => *value = number,
            _ => self.changes.push_back((period, number)),
        }
        if self.changes.len() > KEPT {
            self.changes.pop_front();
        }
    }

    /// The values at the ends of the latest periods, at most so many, the present one last; none from before it had any.
    pub fn sampled(&self, now: Time, periods: usize) -> Vec<f64> {
        let end = now.0 / PERIOD + 1;
        let Some(&(first, _)) = self.changes.front() else { return Vec::new() };
        let mut changes = self.changes.iter().peekable();
        let mut value = f64::NAN;
        let from = end.saturating_sub(periods as u64).max(first);
        let at = |period| {
            while let Some(&(_, later)) = changes.next_if(|&&(changed, _)| changed <= period) {
                value = later;
            }
            value
        };
        (from..end).map(at).collect()
    }
}
