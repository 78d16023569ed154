//! Why a call failed, in words for users. Knows nothing of how it was stopped.

use super::Block;

/// What ended a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// An error of Lua's or the user's.
    Runtime,
    /// It ran for longer than its limit.
    OverTime,
    /// It used more memory than its limit.
    OverMemory,
}

/// A call that failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    pub kind: FailureKind,
    /// Without its own position; others in it are `file:line:`.
    pub message: String,
    /// The block the error is in, which is not always the one called; nothing if that block is gone.
    pub block: Option<Block>,
    /// 1-based in the block's text.
    pub line: u32,
    /// The name to look for in that line.
    pub token: Option<String>,
}
