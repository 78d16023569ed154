//! Whether the program runs, and what edits and errors do to it.

use super::Path;
use crate::runtime::command::{OnEdit, OnError, Saves};

#[derive(Clone, Debug, PartialEq)]
pub enum Mode {
    /// Before the program begins: a robot isn't there yet, and perhaps why.
    Waiting {
        robot: Path,
        why: String,
    },
    Running,
    Paused {
        reason: String,
    },
    /// The robot was told to stop; nothing runs until a person resumes.
    Stopped,
}

/// What a person chose for edits and errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choices {
    pub on_edit: OnEdit,
    pub saves: Saves,
    pub on_error: OnError,
}

/// A person who pressed the key knows why it is paused.
pub fn is_own_doing(reason: &str) -> bool {
    matches!(reason, "" | "asked for" | "runstop")
}
