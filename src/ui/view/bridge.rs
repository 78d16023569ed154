//! A bridge's health and the latest messages that came and went.

use std::collections::BTreeMap;

use serde_json::Value;

use super::Path;
use crate::runtime::record::Health;
use crate::runtime::time::Time;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bridge {
    pub kind: Path,
    /// None until it is heard of.
    pub health: Option<Health>,
    pub message: Option<String>,
    /// Since when it is in this health.
    pub since: Time,
    pub inputs: BTreeMap<Path, Message>,
    pub outputs: BTreeMap<Path, Message>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub value: Value,
    pub at: Time,
}
