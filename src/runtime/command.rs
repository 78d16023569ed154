//! The only way into the engine: plain data, the same from a key, a test or a remote screen.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::record::{File, Finding};
use crate::model::Edit;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "command", rename_all = "kebab-case")]
pub enum Command {
    /// A program that can be read; what of it is wrong is reported and skipped.
    #[serde(skip)]
    Load(Edit),
    /// A text that can't be read as a program: it is reported, and what runs goes on.
    Reject {
        findings: Vec<Finding>,
        #[serde(skip_serializing_if = "Vec::is_empty", default)]
        files: Vec<File>,
    },
    Pause,
    Resume,
    /// Exactly one step, while paused.
    Step,
    /// Steps a second; 0: as fast as possible.
    Rate {
        hz: f64,
    },
    /// Goes to a state as a transition would: onexit and onentry run.
    TransitionTo {
        state: String,
    },
    /// Goes to a state without running any action.
    JumpTo {
        state: String,
    },
    /// Gives a variable the value of a Lua expression in the variable's scope.
    Set {
        var: String,
        value: String,
    },
    /// Gives a variable its initial value again, worked out anew.
    Reset {
        var: String,
    },
    /// From scratch: variables initialised, spawns done anew.
    Restart,
    /// What an edit does from now on where it changes what is active.
    OnEdit {
        mode: OnEdit,
    },
    /// Whether saves are taken over at once from now on.
    Saves {
        mode: Saves,
    },
    /// Takes the held edit over.
    ApplyHeld,
    /// Forgets the held edit: the program that runs goes on.
    DropHeld,
    /// Sets or clears a breakpoint.
    Break {
        #[serde(flatten)]
        at: BreakAt,
        mode: Breaking,
    },
    /// Whether the program pauses when something goes wrong in it.
    OnError {
        mode: OnError,
    },
    /// Whether it is told what the guards of active states come to.
    Explain {
        mode: Explain,
    },
    /// Stops the robot and pauses. The session has told the bridges before the engine sees it.
    Runstop,
    /// A file beside the program has another text: a world, or a Lua file that a block requires.
    FileChanged {
        file: String,
    },
    /// Sends to a robot what a block would by `BRIDGE.what`: `move{ linear = { x = 0.1 } }`, `motorA:stop()`.
    Tell {
        bridge: String,
        what: String,
    },
    /// Puts a simulated robot back at its start.
    PutAtStart {
        bridge: String,
    },
}

/// What an edit does to an active state that it changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OnEdit {
    /// The program starts again from scratch.
    #[default]
    Restart,
    /// Actions are swapped in place; only a machine for which that can't be starts again.
    Keep,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Saves {
    #[default]
    Apply,
    /// Checked and listed, until they are asked for.
    Hold,
}

/// What a breakpoint waits for.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "at", rename_all = "lowercase")]
pub enum BreakAt {
    /// A state is entered.
    State { state: Arc<str> },
    /// A transition is taken: `follower: on bumping * -> bumpback`, as lists of changes name it.
    Transition { transition: Arc<str> },
    /// A Lua expression becomes true, as seen at the end of a step in the scope of a machine; empty: at top level.
    Condition { condition: Arc<str>, machine: Arc<str> },
}

impl std::fmt::Display for BreakAt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            BreakAt::State { state } => write!(f, "state {state}"),
            BreakAt::Transition { transition } => write!(f, "transition {transition}"),
            BreakAt::Condition { condition, machine } if machine.is_empty() => write!(f, "condition {condition}"),
            BreakAt::Condition { condition, machine } => write!(f, "condition {condition} in {machine}"),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Breaking {
    Set,
    Clear,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OnError {
    #[default]
    Continue,
    Pause,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Explain {
    #[default]
    Off,
    /// Whenever that has changed, at most ten times a second of program time, and at each step while paused.
    On,
}
