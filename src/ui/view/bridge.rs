//! A bridge's health and the latest messages that came and went.

use std::collections::BTreeMap;

use lrp_bridge::{Description, Found};
use serde_json::Value;

use super::Path;
use crate::runtime::record::Health;
use crate::runtime::time::Time;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bridge {
    pub kind: Path,
    /// None until it is heard of.
    pub health: Option<Health>,
    pub message: Option<String>,
    /// Since when it is in this health.
    pub since: Time,
    pub inputs: BTreeMap<Path, Message>,
    pub outputs: BTreeMap<Path, Message>,
    /// What it offers, once it has said so.
    pub offer: Option<Description>,
    /// What it sees of its robot's world.
    pub found: Vec<Found>,
    /// Calls that aren't over, by their number, and the last ones that are.
    pub calls: BTreeMap<u64, Call>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    pub name: Path,
    pub arguments: Value,
    pub begun: Time,
    pub feedback: Option<Value>,
    /// When it was over, and what came of it.
    pub ended: Option<(Time, Result<Value, String>)>,
}

/// Calls that are over and still shown.
const ENDED: usize = 8;

impl Bridge {
    pub(super) fn call(&mut self, t: Time, id: u64, name: &Path, arguments: &Value) {
        let call = Call { name: name.clone(), arguments: arguments.clone(), begun: t, feedback: None, ended: None };
        self.calls.insert(id, call);
    }

    pub(super) fn feedback(&mut self, id: u64, value: &Value) {
        if let Some(call) = self.calls.get_mut(&id) {
            call.feedback = Some(value.clone());
        }
    }

    pub(super) fn end_call(&mut self, t: Time, id: u64, result: Result<Value, String>) {
        if let Some(call) = self.calls.get_mut(&id) {
            call.ended = Some((t, result));
        }
        let ended: Vec<u64> = self.calls.iter().filter(|(_, call)| call.ended.is_some()).map(|(&id, _)| id).collect();
        for id in ended.iter().take(ended.len().saturating_sub(ENDED)) {
            self.calls.remove(id);
        }
    }

    /// Calls that aren't over.
    pub fn in_flight(&self) -> usize {
        self.calls.values().filter(|call| call.ended.is_none()).count()
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub value: Value,
    pub at: Time,
    /// How many came so far.
    pub count: u64,
    /// Of the second before: since when, and how many.
    window: (Time, u64),
    /// Messages a second.
    pub rate: f64,
}

impl Message {
    pub(super) fn new(value: Value, at: Time, before: Option<&Message>) -> Message {
        let Some(before) = before else { return Message { value, at, count: 1, window: (at, 0), rate: 0.0 } };
        let (since, count) = (before.window.0, before.window.1 + 1);
        let passed = at.since(since).ms();
        let (window, rate) = match passed >= 1000.0 {
            true => ((at, 0), count as f64 * 1000.0 / passed),
            false => ((since, count), before.rate),
        };
        Message { value, at, count: before.count + 1, window, rate }
    }
}
