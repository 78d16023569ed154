//! Whether the program runs.

#[derive(Clone, Debug, PartialEq)]
pub enum Mode {
    Running,
    Paused {
        reason: String,
    },
    /// The robot was told to stop; nothing runs until a person resumes.
    Stopped,
}

/// A person who pressed the key knows why it is paused.
pub fn is_own_doing(reason: &str) -> bool {
    matches!(reason, "" | "asked for" | "runstop")
}
