//! Things that may go wrong many times a second, told now and then with how often they did.

use std::time::{Duration, Instant};

/// At most so often.
const EVERY: Duration = Duration::from_secs(5);

#[derive(Default)]
pub struct Complaints {
    count: u64,
    last: String,
    told: Option<Instant>,
}

impl Complaints {
    pub fn note(&mut self, complaint: String) {
        self.count += 1;
        self.last = complaint;
    }

    /// What there is to tell now.
    pub fn take(&mut self, now: Instant) -> Option<String> {
        let due = self.told.is_none_or(|told| now.duration_since(told) >= EVERY);
        if self.count == 0 || !due {
            return None;
        }
        self.told = Some(now);
        let last = std::mem::take(&mut self.last);
        Some(match std::mem::take(&mut self.count) {
            1 => last,
            count => format!("{last} ({count} times so far, or of its like)"),
        })
    }
}
