//! What a bridge says with: a handle for any of its threads. Saying never waits for lrp: of an input only the latest
//! message is kept until it can be written, of the rest a bounded queue.

use std::collections::VecDeque;
use std::io::Write;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};

use serde_json::Value;

use crate::message::{Event, Health, Level};
use crate::offer::{Description, Found, Problem};

/// Events other than inputs that may wait to be written. Logs beyond it are dropped and counted.
const WAITING: usize = 4096;

/// Says things to lrp. Clones say them to the same.
#[derive(Clone, Default)]
pub struct Robot {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    outbox: Mutex<Outbox>,
    filled: Condvar,
}

#[derive(Default)]
struct Outbox {
    events: VecDeque<Event>,
    /// The latest message of each input, in the order they came.
    inputs: Vec<Latest>,
    dropped: u64,
    closed: bool,
}

struct Latest {
    name: String,
    value: Value,
    skipped: u64,
}

impl Robot {
    /// A message from the robot. Where lrp can't keep up, a later one takes its place.
    pub fn input(&self, name: &str, value: impl Into<Value>) {
        let mut outbox = self.outbox();
        let value = value.into();
        match outbox.inputs.iter_mut().find(|latest| latest.name == name) {
            Some(latest) => {
                latest.value = value;
                latest.skipped += 1;
            }
            None => outbox.inputs.push(Latest { name: name.to_string(), value, skipped: 0 }),
        }
        drop(outbox);
        self.shared.filled.notify_one();
    }

    /// Whether a message of this input still waits: one that is costly to make can be left out then.
    pub fn is_waiting(&self, name: &str) -> bool {
        self.outbox().inputs.iter().any(|latest| latest.name == name)
    }

    pub fn connecting(&self, message: impl Into<String>) {
        self.say(Event::State { state: Health::Connecting, message: Some(message.into()) });
    }

    pub fn up(&self) {
        self.say(Event::State { state: Health::Up, message: None });
    }

    /// The robot can't be reached; the bridge goes on trying.
    pub fn lost(&self, why: impl Into<String>) {
        self.say(Event::State { state: Health::Lost, message: Some(why.into()) });
    }

    /// What is offered from now on.
    pub fn offer(&self, description: Description) {
        self.say(Event::Offer { description, problems: Vec::new() });
    }

    pub(crate) fn refuse(&self, problems: Vec<Problem>) {
        self.say(Event::Offer { description: Description::default(), problems });
    }

    /// A call is over.
    pub fn reply(&self, id: u64, result: Result<Value, String>) {
        let (value, error) = match result {
            Ok(value) => (value, None),
            Err(error) => (Value::Null, Some(error)),
        };
        self.say(Event::Reply { id, value, error });
    }

    /// How far a call has come.
    pub fn feedback(&self, id: u64, value: Value) {
        self.say(Event::Feedback { id, value });
    }

    pub fn log(&self, level: Level, message: impl Into<String>) {
        self.say(Event::Log { level, message: message.into(), from: None });
    }

    /// Something that another part of the robot says.
    pub fn log_from(&self, from: impl Into<String>, level: Level, message: impl Into<String>) {
        self.say(Event::Log { level, message: message.into(), from: Some(from.into()) });
    }

    /// All that is seen of the robot's world.
    pub fn found(&self, found: Vec<Found>) {
        self.say(Event::Found { found });
    }

    /// Somebody changes a variable of the program; the answer comes as `News::Answer` with this id.
    pub fn set(&self, id: u64, variable: impl Into<String>, value: Value) {
        self.say(Event::Set { id, variable: variable.into(), value });
    }

    /// The robot's clock, ms.
    pub fn time(&self, ms: f64) {
        self.say(Event::Time { ms });
    }

    /// Things that were lost on the robot's side because they came too fast.
    pub fn dropped(&self, what: impl Into<String>, count: u64) {
        self.say(Event::Dropped { what: what.into(), count });
    }

    pub(crate) fn say(&self, event: Event) {
        let mut outbox = self.outbox();
        if outbox.events.len() >= WAITING && matches!(event, Event::Log { .. } | Event::Feedback { .. }) {
            outbox.dropped += 1;
            return;
        }
        outbox.events.push_back(event);
        drop(outbox);
        self.shared.filled.notify_one();
    }

    pub(crate) fn close(&self) {
        self.outbox().closed = true;
        self.shared.filled.notify_one();
    }

    /// Writes what is said until it is closed or nobody reads.
    pub(crate) fn write(&self, output: &mut dyn Write) {
        let mut lines = Vec::new();
        while let Some((events, inputs)) = self.take() {
            lines.clear();
            let inputs =
                inputs.into_iter().map(|Latest { name, value, skipped }| Event::Input { name, value, skipped });
            for event in events.into_iter().chain(inputs) {
                // Plain data with names as keys: nothing in it can fail to be written as JSON.
                if serde_json::to_writer(&mut lines, &event).is_ok() {
                    lines.push(b'\n');
                }
            }
            if output.write_all(&lines).and_then(|()| output.flush()).is_err() {
                return;
            }
        }
    }

    /// Waits for something to write; none: closed, and all is written.
    fn take(&self) -> Option<(VecDeque<Event>, Vec<Latest>)> {
        let mut outbox = self.outbox();
        while outbox.events.is_empty() && outbox.inputs.is_empty() {
            if outbox.closed {
                return None;
            }
            outbox = self.shared.filled.wait(outbox).unwrap_or_else(|poisoned| poisoned.into_inner());
        }
        let mut events = std::mem::take(&mut outbox.events);
        match std::mem::take(&mut outbox.dropped) {
            0 => {}
            count => events.push_back(Event::Dropped { what: "log lines".to_string(), count }),
        }
        Some((events, std::mem::take(&mut outbox.inputs)))
    }

    fn outbox(&self) -> MutexGuard<'_, Outbox> {
        self.shared.outbox.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
