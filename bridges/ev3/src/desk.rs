//! Between the bridge's thread, which puts things here, and the brick's, which carries them out. A halt comes before all
//! else, and undoes what waits.

use std::sync::{Condvar, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use crate::orders::Deed;
use crate::settings::Settings;

/// More calls than a brick could carry out in some seconds.
const WAITING: usize = 256;

/// How long a halt may wait for the answer to the request before it.
const PATIENCE: Duration = Duration::from_millis(1500);

#[derive(Clone, Debug)]
pub struct Job {
    pub id: u64,
    pub deed: Deed,
}

pub struct Desk {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    settings: Settings,
    /// The brick's thread doesn't know these settings yet.
    unread: bool,
    jobs: Vec<Job>,
    cancelled: Vec<u64>,
    halt: bool,
    /// Whether there is a brick to carry things out.
    reachable: bool,
    closed: bool,
}

/// What the brick's thread is to do.
#[derive(Debug)]
pub enum Next {
    Halt,
    Settings(Settings),
    Cancel(Vec<u64>),
    /// All that wait, in order.
    Jobs(Vec<Job>),
    Poll,
    Close,
}

impl Desk {
    pub fn new(settings: Settings) -> Desk {
        let state = State {
            settings,
            unread: false,
            jobs: Vec::new(),
            cancelled: Vec::new(),
            halt: false,
            reachable: false,
            closed: false,
        };
        Desk { state: Mutex::new(state), changed: Condvar::new() }
    }

    /// Nothing waits for a brick that isn't there: by the time it came, it would be too late.
    pub fn put(&self, job: Job) -> Result<(), &'static str> {
        let mut state = self.state();
        if !state.reachable {
            return Err("no brick is connected");
        }
        if state.jobs.len() == WAITING {
            return Err("the brick can't keep up: too many calls wait");
        }
        state.jobs.push(job);
        self.changed.notify_all();
        Ok(())
    }

    /// Gives a job up. Whether it waited still; else the brick's thread knows what became of it.
    pub fn cancel(&self, id: u64) -> bool {
        let mut state = self.state();
        let waiting = state.jobs.len();
        state.jobs.retain(|job| job.id != id);
        if state.jobs.len() < waiting {
            return true;
        }
        if state.reachable {
            state.cancelled.push(id);
            self.changed.notify_all();
        }
        false
    }

    /// Waits until the halt is with the brick, or there is none. Gives what is undone.
    pub fn halt(&self) -> Vec<Job> {
        let mut state = self.state();
        let undone = std::mem::take(&mut state.jobs);
        state.halt = state.reachable;
        self.changed.notify_all();
        let end = Instant::now() + PATIENCE;
        while state.halt && Instant::now() < end {
            state = self.wait(state, end);
        }
        undone
    }

    pub fn settle(&self, settings: Settings) {
        let mut state = self.state();
        state.unread |= state.settings != settings;
        state.settings = settings;
        self.changed.notify_all();
    }

    pub fn close(&self) {
        self.state().closed = true;
        self.changed.notify_all();
    }

    /// The settings as they are now.
    pub fn settings(&self) -> Settings {
        let mut state = self.state();
        state.unread = false;
        state.settings.clone()
    }

    /// Waits for something to do, at most until the next reading is due.
    pub fn next(&self, due: Instant) -> Next {
        let mut state = self.state();
        loop {
            if state.halt {
                return Next::Halt;
            } else if state.closed {
                return Next::Close;
            } else if state.unread {
                state.unread = false;
                return Next::Settings(state.settings.clone());
            } else if !state.cancelled.is_empty() {
                return Next::Cancel(std::mem::take(&mut state.cancelled));
            } else if Instant::now() >= due {
                // Before the jobs, so that a program that never ceases to call still sees what it does.
                return Next::Poll;
            } else if !state.jobs.is_empty() {
                return Next::Jobs(std::mem::take(&mut state.jobs));
            }
            state = self.wait(state, due);
        }
    }

    /// A brick is there, and stands still.
    pub fn reached(&self) {
        self.state().reachable = true;
    }

    /// Whether somebody waits for a halt.
    pub fn wants_halt(&self) -> bool {
        self.state().halt
    }

    /// The halt is with the brick.
    pub fn halted(&self) {
        self.state().halt = false;
        self.changed.notify_all();
    }

    /// There is no brick any more. Gives what is undone.
    pub fn lost(&self) -> Vec<Job> {
        let mut state = self.state();
        state.reachable = false;
        state.halt = false;
        state.cancelled.clear();
        self.changed.notify_all();
        std::mem::take(&mut state.jobs)
    }

    /// Whether there is nothing new to do while no brick is connected.
    pub fn is_quiet(&self) -> bool {
        let state = self.state();
        !state.closed && !state.unread
    }

    /// Waits, but not if there are other settings or it is over. Whether it goes on.
    pub fn rest(&self, pause: Duration) -> bool {
        let end = Instant::now() + pause;
        let mut state = self.state();
        while !state.closed && !state.unread && Instant::now() < end {
            state = self.wait(state, end);
        }
        !state.closed
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn wait<'a>(&self, state: MutexGuard<'a, State>, end: Instant) -> MutexGuard<'a, State> {
        let left = end.saturating_duration_since(Instant::now());
        self.changed.wait_timeout(state, left).unwrap_or_else(|poisoned| poisoned.into_inner()).0
    }
}
