//! Calls that wait for the line that answers them.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use super::Template;

#[derive(Clone, Debug, PartialEq)]
pub struct CallForm {
    pub send: Vec<Template>,
    pub arguments: Vec<String>,
    /// None: it is over once it is sent.
    pub reply: Option<Template>,
    /// The line that says it failed.
    pub error: Option<Template>,
    pub timeout: Duration,
}

impl CallForm {
    pub fn message(&self, arguments: &[Value]) -> Value {
        let named = self.arguments.iter().cloned().zip(arguments.iter().cloned());
        Value::Object(named.collect::<Map<String, Value>>())
    }

    pub fn doc(&self) -> String {
        let lines = self.send.iter().map(Template::source).collect::<Vec<_>>().join(", then ");
        match &self.reply {
            Some(reply) => format!("sends {lines}; over with {}", reply.source()),
            None => format!("sends {lines}"),
        }
    }
}

/// In the order they were begun: a line answers the first that it can.
#[derive(Default)]
pub struct Calls {
    waiting: VecDeque<Waiting>,
}

struct Waiting {
    id: u64,
    reply: Template,
    error: Option<Template>,
    timeout: Duration,
    until: Instant,
}

impl Calls {
    /// Whether it waits for something.
    pub fn begin(&mut self, id: u64, form: &CallForm, now: Instant) -> bool {
        let Some(reply) = form.reply.clone() else { return false };
        let (error, timeout) = (form.error.clone(), form.timeout);
        self.waiting.push_back(Waiting { id, reply, error, timeout, until: now + timeout });
        true
    }

    /// The call that a line ends, and how.
    pub fn answer(&mut self, line: &str) -> Option<(u64, Result<Value, String>)> {
        let answered = self.waiting.iter().enumerate().find_map(|(at, call)| {
            let failed = || call.error.as_ref()?.read(line).map(|_| Err(line.to_string()));
            call.reply.read(line).map(Ok).or_else(failed).map(|result| (at, call.id, result))
        });
        let (at, id, result) = answered?;
        self.waiting.remove(at);
        Some((id, result))
    }

    /// Those that waited for too long, and what to say.
    pub fn late(&mut self, now: Instant) -> Vec<(u64, String)> {
        let late = self.waiting.iter().filter(|call| call.until <= now);
        let late = late.map(|call| (call.id, format!("no answer within {} ms", call.timeout.as_millis()))).collect();
        self.waiting.retain(|call| call.until > now);
        late
    }

    pub fn cancel(&mut self, id: u64) {
        self.waiting.retain(|call| call.id != id);
    }

    pub fn forget(&mut self) -> Vec<u64> {
        self.waiting.drain(..).map(|call| call.id).collect()
    }
}
