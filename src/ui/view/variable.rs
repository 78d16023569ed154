//! A variable's value, what it was before and how it moved.

use serde_json::Value;

use super::Path;
use super::history::History;
use crate::runtime::time::Time;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variable {
    /// None while its machine isn't running.
    pub value: Option<Value>,
    pub previous: Option<Value>,
    pub changed: Time,
    /// What set it last: the path of the state, event or machine; `init`; or `command`.
    pub by: Path,
    /// While its values are numbers.
    pub history: History,
}

impl Variable {
    pub fn set(&mut self, value: &Value, by: &Path, at: Time) {
        match value.as_f64() {
            Some(number) => self.history.remember(number, at),
            None => self.history = History::default(),
        }
        self.previous = self.value.replace(value.clone());
        self.changed = at;
        self.by = by.clone();
    }

    /// Its machine is gone.
    pub fn forget(&mut self) {
        self.value = None;
        self.previous = None;
    }

    /// Whether a person gave it the value it has.
    pub fn is_tuned(&self) -> bool {
        self.value.is_some() && *self.by == *"command"
    }

    pub fn number(&self) -> Option<f64> {
        self.value.as_ref()?.as_f64()
    }

    /// Whether a change is recent enough to be shown as one: a second of program time.
    pub fn is_fresh(&self, now: Time) -> bool {
        self.previous.is_some() && self.previous != self.value && now.since(self.changed) < Time(1_000_000)
    }
}
