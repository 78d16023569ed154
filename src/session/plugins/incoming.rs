//! What a bridge has said since the engine last looked: of each input the latest message, of the rest a bounded list.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};

use lrp_bridge::{Description, Found, Level, Problem};
use serde_json::Value;

use crate::runtime::record::Health;

/// Inputs of different names.
const INPUTS: usize = 4096;
/// Of all inputs together, as they came.
const BYTES: usize = 32 << 20;
/// Things said that may wait to be heard.
const WAITING: usize = 1024;

/// Something a bridge said, beside messages.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    State {
        state: Health,
        message: Option<String>,
    },
    Offer(Description),
    /// What is wrong with the configuration it was given; it goes by the one before.
    Problems(Vec<Problem>),
    /// `name`: which call it was, where that is known.
    Reply {
        id: u64,
        name: Arc<str>,
        done: bool,
        value: Value,
        error: Option<String>,
    },
    Log {
        level: Level,
        message: String,
        from: Option<String>,
    },
    Found(Vec<Found>),
    /// Somebody on the robot's side changes a variable.
    Set {
        id: u64,
        variable: String,
        value: Value,
    },
}

impl Said {
    /// A call that is over, and of which the bridge says nothing.
    pub fn failed(id: u64, why: &str) -> Said {
        Said::Reply { id, name: Arc::default(), done: true, value: Value::Null, error: Some(why.to_string()) }
    }
}

#[derive(Default)]
pub struct Incoming {
    waiting: Mutex<Waiting>,
}

struct Latest {
    name: String,
    value: Value,
    /// As it came.
    bytes: usize,
}

#[derive(Default)]
struct Waiting {
    inputs: Vec<Latest>,
    /// Of all of them.
    bytes: usize,
    said: VecDeque<Said>,
    /// Lost for want of room.
    dropped: u64,
    /// The robot's clock, ms.
    time: Option<f64>,
}

impl Incoming {
    /// `bytes`: how long it was as it came.
    pub fn input(&self, name: String, value: Value, bytes: usize) {
        let waiting = &mut *self.waiting();
        if let Some(latest) = waiting.inputs.iter_mut().find(|latest| latest.name == name) {
            waiting.bytes = waiting.bytes - latest.bytes + bytes;
            (latest.value, latest.bytes) = (value, bytes);
        } else if waiting.inputs.len() < INPUTS && waiting.bytes + bytes <= BYTES {
            waiting.bytes += bytes;
            waiting.inputs.push(Latest { name, value, bytes });
        } else {
            waiting.dropped += 1;
        }
    }

    pub fn say(&self, said: Said) {
        let mut waiting = self.waiting();
        // How the connection is must be known; the rest is too much if nobody could hear it in time.
        if waiting.said.len() >= WAITING && !matches!(said, Said::State { .. }) {
            waiting.dropped += 1;
            return;
        }
        waiting.said.push_back(said);
    }

    pub fn time(&self, ms: f64) {
        self.waiting().time = Some(ms);
    }

    /// The robot's clock as last told.
    pub fn robots_time(&self) -> Option<f64> {
        self.waiting().time
    }

    /// The latest message of each input that had one.
    pub fn take_inputs(&self) -> Vec<(String, Value)> {
        let mut waiting = self.waiting();
        waiting.bytes = 0;
        let inputs = std::mem::take(&mut waiting.inputs);
        drop(waiting);
        inputs.into_iter().map(|latest| (latest.name, latest.value)).collect()
    }

    /// What else was said, in order, and how much of it was lost.
    pub fn take_said(&self) -> (VecDeque<Said>, u64) {
        let mut waiting = self.waiting();
        (std::mem::take(&mut waiting.said), std::mem::take(&mut waiting.dropped))
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
