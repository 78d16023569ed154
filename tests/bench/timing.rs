//! How long something takes, and what is typical of many times. Knows nothing of what is timed.

use std::time::{Duration, Instant};

pub fn timed(run: impl FnOnce()) -> Duration {
    let start = Instant::now();
    run();
    start.elapsed()
}

pub fn best(rounds: &[Duration]) -> Duration {
    rounds.iter().copied().min().unwrap_or_default()
}

pub fn median(rounds: &[Duration]) -> Duration {
    let mut sorted = rounds.to_vec();
    sorted.sort();
    sorted[sorted.len() / 2]
}
