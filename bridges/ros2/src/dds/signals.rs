//! Who has something for the thread that waits: RustDDS wakes, that thread sleeps.

use std::collections::BTreeSet;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::task::{Wake, Waker};
use std::time::Duration;

use super::ReaderId;

/// Which readers have something, and whether discovery has, for the thread that waits for it.
#[derive(Default)]
pub struct Signals {
    ready: Mutex<Ready>,
    woken: Condvar,
}

#[derive(Default)]
struct Ready {
    readers: BTreeSet<usize>,
    discovery: bool,
    closed: bool,
}

/// What may have something.
#[derive(Clone, Copy)]
pub enum Source {
    Reader(usize),
    Discovery,
}

pub fn waker(signals: &Arc<Signals>, source: Source) -> Waker {
    Waker::from(Arc::new(Signal { source, signals: Arc::clone(signals) }))
}

struct Signal {
    source: Source,
    signals: Arc<Signals>,
}

impl Wake for Signal {
    fn wake(self: Arc<Self>) {
        self.signals.wake(self.source);
    }
}

impl Signals {
    pub fn wake(&self, source: Source) {
        let mut ready = self.ready();
        match source {
            Source::Reader(id) => _ = ready.readers.insert(id),
            Source::Discovery => ready.discovery = true,
        }
        drop(ready);
        self.woken.notify_one();
    }

    /// Ends the waiting for good.
    pub fn close(&self) {
        self.ready().closed = true;
        self.woken.notify_one();
    }

    /// Waits, but no longer than this, and gives the readers that have something. None: it is over.
    pub fn wait(&self, longest: Duration) -> Option<Vec<ReaderId>> {
        let is_quiet = |ready: &mut Ready| ready.readers.is_empty() && !ready.discovery && !ready.closed;
        let woken = self.woken.wait_timeout_while(self.ready(), longest, is_quiet);
        let mut ready = woken.unwrap_or_else(|poisoned| poisoned.into_inner()).0;
        ready.discovery = false;
        (!ready.closed).then(|| std::mem::take(&mut ready.readers).into_iter().map(ReaderId).collect())
    }

    fn ready(&self) -> MutexGuard<'_, Ready> {
        self.ready.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
