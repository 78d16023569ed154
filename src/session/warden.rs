//! Watches for a block that nothing can stop: then the engine can't stop the robots, so they are halted from here.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use crate::lua::Emergency;

/// How long after its limit a block counts as not to be stopped.
const GRACE: Duration = Duration::from_millis(500);
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// Ends when dropped.
pub struct Warden {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Warden {
    /// Calls `stuck` once for each block that outlives its limit and doesn't react to being stopped.
    pub fn watch(emergency: Emergency, stuck: impl Fn() + Send + 'static) -> Warden {
        let (end, ended) = channel();
        let body = move || {
            let mut told = false;
            while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(LOOK_EVERY) {
                let is_stuck = emergency.overdue() > GRACE;
                if is_stuck && !told {
                    stuck();
                }
                told = is_stuck;
            }
        };
        let thread = Builder::new().name("warden".to_string()).spawn(body).expect("a thread can be started");
        Warden { end: Some(end), thread: Some(thread) }
    }
}

impl Drop for Warden {
    fn drop(&mut self) {
        self.end.take();
        if let Some(thread) = self.thread.take() {
            // It only waits and looks: it can't have failed.
            let _ = thread.join();
        }
    }
}
