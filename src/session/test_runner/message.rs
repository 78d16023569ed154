//! Messages that a test sends in a robot's place, held against what the robot offers.

use lrp_bridge::{Port, Scope};
use serde_json::{Map, Value};

use crate::model::Description;
use crate::syntax::nearest::nearest;

/// Which of a robot's ports a name is looked up among.
#[derive(Clone, Copy)]
pub enum Direction {
    Input,
    Output,
}

/// The port of that name; none for a robot that may have any.
pub fn port<'d>(
    offer: &'d Description,
    direction: Direction,
    robot: &str,
    name: &str,
) -> Result<Option<&'d Port>, String> {
    let (ports, what) = match direction {
        Direction::Input => (&offer.inputs, "input"),
        Direction::Output => (&offer.outputs, "output"),
    };
    let found = ports.iter().find(|port| port.name == name);
    if found.is_some() || offer.scope == Scope::Open {
        return Ok(found);
    }
    let known = ports.iter().map(|port| port.name.as_str());
    Err(format!("`{robot}` has no {what} `{name}`; {}", hint(name, known)))
}

/// A message with the defaults of the fields it leaves out; a field that the robot never sends is refused.
pub fn filled(defaults: &Value, given: Value) -> Result<Value, String> {
    match (defaults, given) {
        (Value::Object(defaults), Value::Object(given)) if !defaults.is_empty() => {
            fields(defaults, given).map(Value::Object)
        }
        (Value::Object(defaults), given) if !defaults.is_empty() => {
            Err(format!("the message is a table with {}, not {given}", names(defaults.keys().map(String::as_str))))
        }
        (_, given) => Ok(given),
    }
}

fn fields(defaults: &Map<String, Value>, mut given: Map<String, Value>) -> Result<Map<String, Value>, String> {
    if let Some(unknown) = given.keys().find(|field| !defaults.contains_key(*field)) {
        return Err(format!(
            "the message has no field `{unknown}`; {}",
            hint(unknown, defaults.keys().map(String::as_str))
        ));
    }
    let mut message = Map::new();
    for (field, default) in defaults {
        let value = match given.remove(field) {
            Some(value) => filled(default, value)?,
            None => default.clone(),
        };
        message.insert(field.clone(), value);
    }
    Ok(message)
}

/// The nearest of the known names, or all of them.
pub fn hint<'n>(wanted: &str, known: impl Iterator<Item = &'n str> + Clone) -> String {
    match nearest(wanted, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there is {}", names(known)),
    }
}

fn names<'n>(known: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<String> = known.map(|name| format!("`{name}`")).collect();
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}
