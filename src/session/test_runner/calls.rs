//! Calls that a program under test made, and what a test says of them in a robot's place.

use std::sync::Arc;

use serde_json::Value;

use super::bench::Bench;
use super::failure::Complaint;
use super::message::hint;
use crate::runtime::{Record, Reply, What};

/// What becomes of a call.
pub enum Said {
    Done(Value),
    Failed(String),
    Feedback(Value),
}

/// A call that isn't over: its bridge, its name, its number.
struct Open<'r> {
    bridge: &'r Arc<str>,
    name: &'r Arc<str>,
    id: u64,
}

impl Bench {
    /// For the next step; of several calls of that name the one made first is meant. `call`: `robot.say`.
    pub fn reply(&mut self, call: &str, said: Said) -> Result<(), Complaint> {
        let open = open(self.records());
        let is_it =
            |open: &&Open| call.strip_prefix(&**open.bridge).and_then(|it| it.strip_prefix('.')) == Some(open.name);
        let Some(&Open { bridge, name, id }) = open.iter().find(is_it) else {
            let known: Vec<String> = open.iter().map(|open| format!("{}.{}", open.bridge, open.name)).collect();
            let hint = hint(call, known.iter().map(String::as_str));
            return Err(Complaint::new(format!("no call of `{call}` waits for a reply; {hint}")));
        };
        let (done, value, error) = match said {
            Said::Done(value) => (true, value, None),
            Said::Failed(error) => (true, Value::Null, Some(error)),
            Said::Feedback(value) => (false, value, None),
        };
        let reply = Reply { bridge: Arc::clone(bridge), name: Arc::clone(name), id, done, value, error };
        self.answer(reply);
        Ok(())
    }

    /// The arguments of the calls that were made in the last step, in order.
    pub fn calls(&self, call: &str) -> Result<Vec<Value>, Complaint> {
        let (robot, _, name) = self.robot(call)?;
        let made = self.last_step().filter_map(|record| match &record.what {
            What::Call { bridge, name: made, arguments, .. } if *bridge == robot && **made == *name => {
                Some(arguments.clone())
            }
            _ => None,
        });
        let mut made: Vec<Value> = made.collect();
        made.reverse();
        Ok(made)
    }
}

/// In the order they were made. One that was answered for the next step counts until then.
fn open(records: &[Record]) -> Vec<Open<'_>> {
    let mut open: Vec<Open> = Vec::new();
    for record in records {
        match &record.what {
            What::Call { bridge, name, id, .. } => open.push(Open { bridge, name, id: *id }),
            What::Reply { bridge, id, done: true, .. } | What::Cancel { bridge, id } => {
                open.retain(|open| open.bridge != bridge || open.id != *id);
            }
            _ => {}
        }
    }
    open
}
