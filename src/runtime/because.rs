//! Why an edit has machines start again or end, as data: what of the text they can't go on with.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::record::{Change, Element, Op};

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Because {
    /// The running machine that can't go on.
    pub machine: Arc<str>,
    /// `State` or `Machine`: of its active state, or of itself.
    pub kind: Element,
    /// As in the change that is to blame: where it is gone, the path it had.
    pub path: Arc<str>,
    /// `Changed` or `Removed`.
    pub op: Op,
}

impl Because {
    /// Whether this is the change that is to blame.
    pub fn is_of(&self, change: &Change) -> bool {
        (self.kind, self.op) == (change.kind, change.op) && self.path == change.path
    }

    /// `active state looking changed`
    pub fn sentence(&self, called: &str) -> String {
        let kind = if self.kind == Element::Machine { "machine" } else { "state" };
        let op = if self.op == Op::Removed { "removed" } else { "changed" };
        format!("active {kind} {called} {op}")
    }
}

impl fmt::Display for Because {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(&self.sentence(&self.path))
    }
}
