//! What a kind of bridge says of itself: the inputs, outputs and calls it offers. Knows nothing of how they travel.

use serde::{Deserialize, Serialize};
use serde_json::Value;

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Description {
    pub kind: String,
    pub inputs: Vec<Port>,
    pub outputs: Vec<Port>,
    pub calls: Vec<Call>,
    /// Whether names that are not listed may be used all the same: a bridge whose robot isn't known beforehand.
    pub scope: Scope,
}

/// An input or an output: a name and the shape of its messages.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Port {
    pub name: String,
    /// A message with every field at its default; fields of others are refused.
    pub message: Value,
    /// One line: what it is, with unit and range.
    pub doc: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Call {
    pub name: String,
    pub doc: String,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scope {
    /// Only what is listed exists.
    #[default]
    Closed,
    /// Any other name is taken as an output until a message comes in under it.
    Open,
}

impl Description {
    pub fn input(&self, name: &str) -> Option<&Port> {
        self.inputs.iter().find(|port| port.name == name)
    }

    pub fn output(&self, name: &str) -> Option<&Port> {
        self.outputs.iter().find(|port| port.name == name)
    }
}
