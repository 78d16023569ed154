//! What the bridge pane lists: each robot with its connection, what it says and is told, what it can do, what it sees.
//! Activity never changes the order.

use lrp_bridge::{Device, Found, Function};
use serde_json::Value;

use super::format;
use super::view::{Bridge, Call, Message, Path, View};

#[derive(Clone, Debug, PartialEq)]
pub struct Row<'a> {
    pub robot: &'a Path,
    pub what: What<'a>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum What<'a> {
    Robot(&'a Bridge),
    Heading(&'static str),
    Input {
        name: &'a str,
        message: Option<&'a Message>,
        type_name: &'a str,
    },
    Output {
        name: &'a str,
        message: Option<&'a Message>,
        type_name: &'a str,
        shape: &'a Value,
    },
    /// One that was made.
    Call(u64, &'a Call),
    /// One that can be made.
    Function(&'a Function),
    Device(&'a Device),
    Found(&'a Found),
}

/// What a row stays, whatever comes and goes around it.
pub type Key = String;

impl Row<'_> {
    /// None: it can't be selected.
    pub fn key(&self) -> Option<Key> {
        let robot = self.robot;
        match &self.what {
            What::Robot(_) => Some(format!("{robot}")),
            What::Heading(_) => None,
            What::Input { name, .. } => Some(format!("{robot} input {name}")),
            What::Output { name, .. } => Some(format!("{robot} output {name}")),
            What::Call(id, _) => Some(format!("{robot} call {id}")),
            What::Function(function) => Some(format!("{robot} function {}", function.name)),
            What::Device(device) => Some(format!("{robot} device {}", device.name)),
            What::Found(found) => Some(format!("{robot} found {} {}", found.what, found.name)),
        }
    }

    /// What a person would type to send it by hand, behind the robot's name.
    pub fn told(&self) -> Option<String> {
        match &self.what {
            What::Output { name, message, shape, .. } => {
                let last = message.map(|message| &message.value);
                let value = last.or(Some(shape)).and_then(format::source).unwrap_or_else(|| "{}".into());
                let value = if value.starts_with('{') { value } else { format!("({value})") };
                Some(format!("{name}{value}"))
            }
            What::Function(function) => Some(format!("{}({})", function.name, arguments(function))),
            What::Call(_, call) => {
                let arguments = call.arguments.as_array().into_iter().flatten().filter_map(format::source);
                let arguments = arguments.collect::<Vec<_>>().join(", ");
                Some(format!("{}({arguments})", call.name.replacen('.', ":", 1)))
            }
            What::Device(device) => {
                let first = device.functions.iter().find(|function| function.reads.is_none())?;
                Some(format!("{}:{}({})", device.name, first.name, arguments(first)))
            }
            What::Robot(_) | What::Heading(_) | What::Input { .. } | What::Found(_) => None,
        }
    }

    /// What a person would write into the robot's form to use it.
    pub fn setting(&self) -> Option<String> {
        let What::Found(found) = &self.what else { return None };
        let setting = found.setting.as_ref()?;
        if setting.contains('=') {
            return Some(setting.clone());
        }
        Some(format!("{setting} = {}", format::source(&Value::from(&*found.name))?))
    }
}

/// Those that must be given by name, the others as they are if they aren't.
fn arguments(function: &Function) -> String {
    let text = |argument: &lrp_bridge::Argument| match &argument.default {
        Some(default) => format::source(default).unwrap_or_default(),
        None => argument.name.clone(),
    };
    function.arguments.iter().map(text).collect::<Vec<_>>().join(", ")
}

/// All rows; of what is seen, what has the filter in its name.
pub fn rows<'a>(view: &'a View, filter: &str) -> Vec<Row<'a>> {
    let mut rows = Vec::new();
    for (robot, bridge) in &view.bridges {
        let mut add = |what: What<'a>| rows.push(Row { robot, what });
        add(What::Robot(bridge));
        section("inputs", inputs(bridge), &mut add);
        section("outputs", outputs(bridge), &mut add);
        let offer = bridge.offer.as_ref();
        let calls = bridge.calls.iter().rev().map(|(&id, call)| What::Call(id, call));
        section("calls made", calls.collect(), &mut add);
        section("calls", offer.iter().flat_map(|offer| &offer.calls).map(What::Function).collect(), &mut add);
        section("devices", offer.iter().flat_map(|offer| &offer.devices).map(What::Device).collect(), &mut add);
        let wanted =
            |found: &&Found| filter.is_empty() || found.name.contains(filter) || found.type_name.contains(filter);
        section("seen there", bridge.found.iter().filter(wanted).map(What::Found).collect(), &mut add);
    }
    rows
}

fn section<'a>(heading: &'static str, rows: Vec<What<'a>>, add: &mut impl FnMut(What<'a>)) {
    if !rows.is_empty() {
        add(What::Heading(heading));
        rows.into_iter().for_each(add);
    }
}

/// Those offered, then those that came all the same.
fn inputs(bridge: &Bridge) -> Vec<What<'_>> {
    let offered = bridge.offer.iter().flat_map(|offer| &offer.inputs).map(|port| What::Input {
        name: &port.name,
        message: bridge.inputs.get(port.name.as_str()),
        type_name: &port.type_name,
    });
    let is_offered = |name: &str| bridge.offer.as_ref().is_some_and(|offer| offer.input(name).is_some());
    let others = bridge.inputs.iter().filter(|(name, _)| !is_offered(name));
    let others = others.map(|(name, message)| What::Input { name, message: Some(message), type_name: "" });
    offered.chain(others).collect()
}

fn outputs(bridge: &Bridge) -> Vec<What<'_>> {
    let offered = bridge.offer.iter().flat_map(|offer| &offer.outputs).map(|port| What::Output {
        name: &port.name,
        message: bridge.outputs.get(port.name.as_str()),
        type_name: &port.type_name,
        shape: &port.message,
    });
    let is_offered = |name: &str| bridge.offer.as_ref().is_some_and(|offer| offer.output(name).is_some());
    let others = bridge.outputs.iter().filter(|(name, _)| !is_offered(name)).map(|(name, message)| What::Output {
        name,
        message: Some(message),
        type_name: "",
        shape: &message.value,
    });
    offered.chain(others).collect()
}
