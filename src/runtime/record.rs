//! The only way out of the engine: what happened, as plain data that names things by path. One JSON object a line makes a trace.

use std::sync::Arc;

use lrp_bridge::{Description, Found};
pub use lrp_bridge::{Health, Level};
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use super::because::Because;
use super::command::{BreakAt, Command};
use super::time::Time;
use crate::model::Program;
pub use crate::model::change::{Change, Element, Op};

type Path = Arc<str>;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub step: u64,
    pub t: Time,
    #[serde(flatten)]
    pub what: What,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum What {
    /// A program was taken over: the first, or an edit.
    Load(Load),
    /// An edit can't be read; the program that runs goes on.
    Reject {
        findings: Vec<Finding>,
        /// The texts that errors were found in.
        #[serde(skip_serializing_if = "Vec::is_empty", default)]
        files: Vec<File>,
    },
    /// An edit waits to be taken over. The next one takes its place.
    Held(Held),
    /// All breakpoints, whenever they have changed.
    Breakpoints {
        all: Vec<Breakpoint>,
    },
    Command {
        #[serde(flatten)]
        command: Command,
    },
    /// `by`: the state whose onentry did it; none at top level.
    Spawn {
        machine: Path,
        by: Option<Path>,
    },
    Enter {
        state: Path,
    },
    Exit {
        state: Path,
    },
    Transition(Taken),
    /// What the guards of an active state came to, while that is asked for.
    Guards {
        state: Path,
        ways: Vec<Way>,
    },
    /// A machine is no longer running.
    Discard {
        machine: Path,
    },
    /// `by`: the path of the state, event or machine whose block did it; `init`; `command`; or a robot that answered a call.
    Set {
        var: Path,
        value: Value,
        by: Path,
    },
    Input {
        bridge: Path,
        name: Path,
        value: Value,
    },
    Output {
        bridge: Path,
        name: Path,
        value: Value,
    },
    Call {
        bridge: Path,
        name: Path,
        id: u64,
        arguments: Value,
    },
    /// A call is no longer wanted.
    Cancel {
        bridge: Path,
        id: u64,
    },
    /// How far a call has come, or with `done` how it ended; with an error it failed.
    Reply {
        bridge: Path,
        name: Path,
        id: u64,
        done: bool,
        #[serde(skip_serializing_if = "Value::is_null", default)]
        value: Value,
        #[serde(skip_serializing_if = "Option::is_none", default)]
        error: Option<String>,
    },
    Log(Log),
    Error(Fault),
    /// A fault that no longer stands, though nothing was edited: a spawn that was refused has succeeded.
    Mended(Mended),
    /// `at`: the state to look at, where there is one: a breakpoint was met there, or something went wrong.
    Pause {
        reason: String,
        #[serde(skip_serializing_if = "Option::is_none", default)]
        at: Option<Path>,
    },
    Resume,
    /// A user moved a machine to a state.
    Force {
        state: Path,
        how: Forced,
    },
    Restart {
        reason: String,
    },
    /// The bridges were told to bring the robot to a halt.
    Stop {
        reason: String,
    },
    /// Steps that couldn't be made in time and are not made up.
    Skip {
        steps: u64,
    },
    /// Twice a second of real time: steps a second as they are, and how late the last one was, ms.
    Status {
        rate: f64,
        late: f64,
    },
    Bridge(BridgeState),
    /// What a bridge offers, whenever that has changed.
    Offer {
        bridge: Path,
        description: Box<Description>,
    },
    /// What a bridge sees of its robot's world, whenever that has changed.
    Found {
        bridge: Path,
        found: Vec<Found>,
    },
}

impl What {
    /// What `kind` says in a record, in the order of the variants.
    pub const KINDS: &[&str] = &[
        "load",
        "reject",
        "held",
        "breakpoints",
        "command",
        "spawn",
        "enter",
        "exit",
        "transition",
        "guards",
        "discard",
        "set",
        "input",
        "output",
        "call",
        "cancel",
        "reply",
        "log",
        "error",
        "mended",
        "pause",
        "resume",
        "force",
        "restart",
        "stop",
        "skip",
        "status",
        "bridge",
        "offer",
        "found",
    ];
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    pub changes: Vec<Change>,
    /// Whether the program began again, and because of what: `active state looking changed`.
    pub restarted: bool,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub reason: Option<String>,
    /// Machines that started again on their own.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub again: Vec<Path>,
    /// Machines that run no longer, as there is nothing to start them in.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub discarded: Vec<Path>,
    /// What has machines start again or end, the one of `reason` first.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub because: Vec<Because>,
    /// Warnings and hints of the static checks; errors follow as records of their own.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub findings: Vec<Finding>,
    pub files: Vec<File>,
    /// The program itself, for those in the same process; read from `files` elsewhere.
    #[serde(skip)]
    pub program: Option<Arc<Program>>,
}

/// What taking a held edit over would do now. Told again when that has changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Held {
    pub changes: Vec<Change>,
    /// Why the program would start again.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub restarts: Option<String>,
    /// Machines that would start again on their own.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub again: Vec<Path>,
    /// Machines that would run no longer.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub discarded: Vec<Path>,
    /// What would have machines start again or end, the one of `restarts` first.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub because: Vec<Because>,
    /// All that the static checks found.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub findings: Vec<Finding>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Breakpoint {
    #[serde(flatten)]
    pub at: BreakAt,
    pub by: Setter,
}

/// Who set a breakpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Setter {
    /// `(break)` in the program's text.
    Source,
    Command,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct File {
    pub name: Path,
    pub text: Path,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Taken {
    /// The machine whose state changes.
    pub machine: Path,
    pub from: Path,
    pub to: Path,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub name: Option<Path>,
    /// The event's name, `block`, `eps` or `ontime`.
    pub trigger: Path,
    /// For an exit transition: the nested state it was written at.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub via: Option<Path>,
    /// Where it is written, for drawings: which of the machine's transitions, from 0 in the order written.
    pub index: u32,
}

/// A transition that may lead out of a state, and what its guard came to when it was last looked at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Way {
    /// As lists of changes name it.
    pub transition: Path,
    pub guard: Answer,
    /// Of a timeout: ms since its machine's state was entered, after which it is due.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub after: Option<f64>,
    /// What is wrong with it, or why it wasn't looked at.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub message: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Answer {
    /// It is taken in the next step.
    True,
    False,
    NotBoolean,
    Error,
    /// It needs a message that a robot hasn't sent.
    NoMessage,
    /// It wasn't looked at.
    Unseen,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Log {
    pub level: Level,
    pub message: String,
    /// The state whose action wrote it; empty outside states.
    pub state: Path,
    pub file: Path,
    pub line: usize,
}

impl From<crate::lua::Level> for Level {
    fn from(level: crate::lua::Level) -> Level {
        match level {
            crate::lua::Level::Debug => Level::Debug,
            crate::lua::Level::Info => Level::Info,
            crate::lua::Level::Warn => Level::Warn,
            crate::lua::Level::Error => Level::Error,
        }
    }
}

/// Something that went wrong and was skipped. Comes at its first occurrence, then at most once a second of program
/// time while it goes on; the same `code`, `file`, `line` and `column` are the same fault. A load and
/// a restart clear all faults; those that still stand follow.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault {
    pub code: String,
    pub message: String,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub help: Option<String>,
    pub file: Path,
    pub line: usize,
    pub column: usize,
    /// The state or machine it belongs to; empty at top level.
    pub state: Path,
    pub count: u64,
}

/// Which fault it was.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mended {
    pub code: String,
    pub file: Path,
    pub line: usize,
    pub column: usize,
}

/// A diagnostic by place in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    pub severity: String,
    pub code: String,
    pub message: String,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub help: Option<String>,
    pub file: Path,
    pub line: usize,
    pub column: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Forced {
    Transition,
    Jump,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BridgeState {
    pub bridge: Path,
    /// `kind` is what the record is.
    #[serde(rename = "type")]
    pub kind: Path,
    pub state: Health,
    /// What is wrong, when something is.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub message: Option<String>,
    /// A simulator's world, so that a screen can draw it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub world: Option<WorldText>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorldText {
    pub name: Path,
    pub text: Path,
    /// The input that carries the robot's pose {x, y, theta}, as the program calls it.
    pub pose: Path,
}
