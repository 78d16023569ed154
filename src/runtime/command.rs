//! The only way into the engine: plain data, the same from a key, a test or a remote screen.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::record::Finding;
use crate::model::Program;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "command", rename_all = "kebab-case")]
pub enum Command {
    /// A program that can be read; what of it is wrong is reported and skipped.
    #[serde(skip)]
    Load(Arc<Program>),
    /// A text that can't be read as a program: it is reported, and what runs goes on.
    Reject {
        findings: Vec<Finding>,
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
    /// From scratch: variables initialised, spawns done anew.
    Restart,
    /// Stops the robot and pauses. The session has told the bridges before the engine sees it.
    Runstop,
    /// A file beside the program has another text: a world, or a Lua file that a block requires.
    FileChanged {
        file: String,
    },
    /// Puts a simulated robot back at its start.
    PutAtStart {
        bridge: String,
    },
}
