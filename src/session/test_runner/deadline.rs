//! When a test has taken too long in real time. Shared by the interpreter of the tests and the steps they ask for.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use super::failure::Complaint;

#[derive(Clone)]
pub struct Deadline {
    limit: Duration,
    started: Rc<Cell<Instant>>,
}

impl Deadline {
    pub fn new(limit: Duration) -> Deadline {
        Deadline { limit, started: Rc::new(Cell::new(Instant::now())) }
    }

    /// A test begins now.
    pub fn restart(&self) {
        self.started.set(Instant::now());
    }

    pub fn check(&self) -> Result<(), Complaint> {
        match self.started.get().elapsed() > self.limit {
            true => Err(Complaint::new(format!(
                "stopped, as the test ran for more than {} s of real time",
                self.limit.as_secs_f64()
            ))),
            false => Ok(()),
        }
    }
}
