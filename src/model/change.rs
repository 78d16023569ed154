//! One difference between two programs, as data.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Change {
    pub op: Op,
    pub kind: Element,
    pub path: Arc<str>,
    /// What a renamed element is called now: its new path.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub to: Option<Arc<str>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Op {
    Added,
    Removed,
    Changed,
    Renamed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Element {
    Bridge,
    Variable,
    Machine,
    State,
    Event,
    Transition,
    Spawn,
    Action,
    /// No change of what it stands in.
    Breakpoint,
}
