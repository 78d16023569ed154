//! What a kind of bridge says of itself: its settings, and the inputs, outputs, calls and devices it offers. Plain data.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A kind of bridge, before anything is configured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// What the program's form calls it: `ev3`.
    pub kind: String,
    pub version: String,
    /// One line: which robots it is for.
    pub summary: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub settings: Vec<Setting>,
    /// What it wants to be told beside outputs and calls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wants: Vec<Want>,
}

/// A key of the form's configuration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    pub name: String,
    /// One line: what it does, with unit, range and default.
    pub doc: String,
    /// A value as a program would write it, in Lua.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub example: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Want {
    /// The program's variables and their values, whenever they change.
    Variables,
    /// The active states, whenever they change.
    States,
    /// What the program logs.
    Log,
    /// Something that only a newer lrp knows.
    #[serde(other)]
    Unknown,
}

/// What a bridge offers under a configuration. May change while it is connected.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Description {
    pub inputs: Vec<Port>,
    pub outputs: Vec<Port>,
    pub calls: Vec<Function>,
    pub devices: Vec<Device>,
    /// Whether names that are not listed may be used all the same.
    pub scope: Scope,
}

/// An input or an output: a name and the shape of its messages.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Port {
    pub name: String,
    /// A message with every field at its default; other fields are refused. An empty table or list, or null, takes anything.
    #[serde(default)]
    pub message: Value,
    /// What the robot's own world calls it: `geometry_msgs/msg/Twist`.
    #[serde(default, rename = "type", skip_serializing_if = "String::is_empty")]
    pub type_name: String,
    /// One line: what it is, with unit and range.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub doc: String,
}

/// Something that is called and may take its time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Function {
    pub name: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub arguments: Vec<Argument>,
    /// Of a device: the input, or `input.field`, that it gives at once. No call is made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reads: Option<String>,
    /// One line, with units and ranges.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub doc: String,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Argument {
    pub name: String,
    /// What it is when it isn't given; none: it must be given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub default: Option<Value>,
    /// Of a message: every field at its default, as in `Port`. Null takes anything.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    pub message: Value,
}

/// A part of the robot with functions of its own: `robot.motorA:start(50)`. Its functions are called as `motorA.start`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Device {
    pub name: String,
    #[serde(default)]
    pub functions: Vec<Function>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
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

/// Something seen on the robot's network or ports that a program could use: for completion and for lists.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Found {
    pub name: String,
    /// `topic`, `service`, `action`, `node`, `brick`, `port` ..
    pub what: String,
    #[serde(default, rename = "type", skip_serializing_if = "String::is_empty")]
    pub type_name: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub doc: String,
    /// What the form would say to use it: `name`, or `subscribe.odom` for an entry of a table, where the value is its
    /// name; else the whole of it, `inputs.light = 0`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub setting: Option<String>,
}

/// A mistake in the form's configuration.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Problem {
    pub message: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
    /// The key it is about, with dots into tables: `subscribe.odom`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
}

impl Description {
    pub fn input(&self, name: &str) -> Option<&Port> {
        self.inputs.iter().find(|port| port.name == name)
    }

    pub fn output(&self, name: &str) -> Option<&Port> {
        self.outputs.iter().find(|port| port.name == name)
    }

    /// A call by its name, or a device's as `device.function`.
    pub fn function(&self, name: &str) -> Option<&Function> {
        let own = self.calls.iter().find(|call| call.name == name);
        own.or_else(|| {
            let (device, function) = name.split_once('.')?;
            let device = self.devices.iter().find(|known| known.name == device)?;
            device.functions.iter().find(|known| known.name == function)
        })
    }
}

impl Port {
    pub fn new(name: impl Into<String>, message: Value, doc: impl Into<String>) -> Port {
        Port { name: name.into(), message, type_name: String::new(), doc: doc.into() }
    }

    pub fn of_type(self, type_name: impl Into<String>) -> Port {
        Port { type_name: type_name.into(), ..self }
    }
}

impl Function {
    pub fn new(name: impl Into<String>, arguments: Vec<Argument>, doc: impl Into<String>) -> Function {
        Function { name: name.into(), arguments, reads: None, doc: doc.into() }
    }

    /// Of a device: gives an input, or a field of one, at once.
    pub fn reading(name: impl Into<String>, input: impl Into<String>, doc: impl Into<String>) -> Function {
        Function { name: name.into(), arguments: Vec::new(), reads: Some(input.into()), doc: doc.into() }
    }
}

impl Argument {
    pub fn new(name: impl Into<String>) -> Argument {
        Argument { name: name.into(), ..Argument::default() }
    }

    pub fn or(self, default: impl Into<Value>) -> Argument {
        Argument { default: Some(default.into()), ..self }
    }

    pub fn message(self, message: Value) -> Argument {
        Argument { message, ..self }
    }
}

impl Setting {
    pub fn new(name: impl Into<String>, doc: impl Into<String>) -> Setting {
        Setting { name: name.into(), doc: doc.into(), example: None }
    }

    pub fn example(self, example: impl Into<String>) -> Setting {
        Setting { example: Some(example.into()), ..self }
    }
}

impl Problem {
    pub fn new(message: impl Into<String>) -> Problem {
        Problem { message: message.into(), ..Problem::default() }
    }

    pub fn help(self, help: impl Into<String>) -> Problem {
        Problem { help: Some(help.into()), ..self }
    }

    pub fn at(self, key: impl Into<String>) -> Problem {
        Problem { key: Some(key.into()), ..self }
    }
}
