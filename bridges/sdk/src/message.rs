//! The two sides of the conversation: what lrp tells a bridge, and what a bridge says. One JSON object a line each.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::offer::{About, Description, Found, Problem};

/// What lrp tells a bridge. Read in read.rs.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "order", rename_all = "kebab-case")]
pub enum Order {
    /// What would be offered under this configuration? Nothing is connected for it.
    Describe { config: Value },
    /// The form as it is now. The first one connects; a later one changes only what differs.
    Configure(Form),
    /// What one step sends, in order.
    Send { items: Vec<Item> },
    /// A call is no longer wanted.
    Cancel { id: u64 },
    /// Bring the robot to a halt, now.
    Stop,
    /// To be answered by a pong with the same number.
    Ping { id: u64 },
    /// What became of a bridge's `set`; no error: done.
    Answer {
        id: u64,
        #[serde(skip_serializing_if = "Option::is_none")]
        error: Option<String>,
    },
    /// All variables, or those that changed, for a bridge that wants them.
    Variables { variables: Vec<Variable> },
    /// The machines that run and the state each is in, whenever one changes, for a bridge that wants them.
    States {
        /// Program time, ms.
        t: f64,
        machines: Vec<Active>,
    },
    /// What the program logs, for a bridge that wants it.
    Log {
        level: Level,
        message: String,
        /// Path of the state whose block says it; none: the program itself.
        #[serde(skip_serializing_if = "Option::is_none")]
        state: Option<String>,
    },
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Form {
    /// What the program calls the robot.
    pub name: String,
    pub config: Value,
    /// The program's folder: relative paths start there.
    pub folder: PathBuf,
}

/// One thing that a step sends.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Item {
    Call(Call),
    Output(Output),
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Output {
    pub output: String,
    pub value: Value,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Call {
    /// `say`, or a device's as `motorA.start`.
    pub call: String,
    /// For its replies.
    pub id: u64,
    /// In the order of the description, defaults filled in.
    pub arguments: Vec<Value>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Variable {
    /// `follower/speed`; a global by its name alone.
    pub path: String,
    pub value: Value,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Active {
    pub machine: String,
    pub state: String,
    /// Program time at which it was entered, ms.
    pub since: f64,
}

/// What a bridge says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event {
    /// The first line.
    Hello {
        /// The protocol's version that it speaks.
        protocol: u32,
        #[serde(flatten)]
        about: About,
    },
    /// What it offers; in answer to `describe` and `configure`, and whenever that changes. `problems`: what is wrong with
    /// the configuration; with any, nothing has changed.
    Offer {
        #[serde(flatten)]
        description: Description,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        problems: Vec<Problem>,
    },
    /// How its connection is.
    State {
        state: Health,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        message: Option<String>,
    },
    /// A message from the robot.
    Input {
        name: String,
        value: Value,
        /// Messages of this input that lrp was too slow for, since the last one.
        #[serde(default, skip_serializing_if = "is_zero")]
        skipped: u64,
    },
    /// A call is over; with an error it failed.
    Reply {
        id: u64,
        #[serde(default, skip_serializing_if = "Value::is_null")]
        value: Value,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        error: Option<String>,
    },
    /// How far a call has come.
    Feedback {
        id: u64,
        value: Value,
    },
    /// For the log; `from`: who says it, if not the bridge itself.
    Log {
        level: Level,
        message: String,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from: Option<String>,
    },
    /// All that is seen of the robot's world, whenever that changes.
    Found {
        found: Vec<Found>,
    },
    /// Somebody on the robot's side changes a variable of the program: to be answered.
    Set {
        id: u64,
        variable: String,
        value: Value,
    },
    /// The robot's clock, ms: program time follows it where the form asks for that.
    Time {
        ms: f64,
    },
    /// Things that were lost because they came too fast.
    Dropped {
        what: String,
        count: u64,
    },
    /// To a stop: the halt has been handed over to the robot.
    Stopped,
    Pong {
        id: u64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Health {
    Connecting,
    Up,
    Lost,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    Debug,
    Info,
    Warn,
    Error,
}

impl Level {
    /// By its name, as `warn`.
    pub fn named(name: &str) -> Option<Level> {
        Some(match name {
            "debug" => Level::Debug,
            "info" => Level::Info,
            "warn" => Level::Warn,
            "error" => Level::Error,
            _ => return None,
        })
    }
}

fn is_zero(number: &u64) -> bool {
    *number == 0
}
