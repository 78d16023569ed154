//! Inputs by example, `{ light = 0, pose = { x = 0, y = 0 } }`: which field of a line goes where in which message.

use std::collections::BTreeMap;

use lrp_bridge::Port;
use serde_json::{Value, json};

use super::template::{boolean, number, put};
use super::{Field, fields::Named};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Each with its message, every field at its default.
    all: Vec<(String, Value)>,
    /// `pose.x` -> where it goes.
    slots: BTreeMap<String, Slot>,
}

/// A place in an input's message.
#[derive(Clone, Debug, PartialEq)]
pub struct Slot {
    pub input: usize,
    path: Vec<String>,
    example: Value,
}

impl Inputs {
    /// A single value is the field `data` of its message.
    pub fn add(&mut self, name: &str, example: &Value) {
        let (input, mut message) = (self.all.len(), example.clone());
        match example {
            Value::Object(table) if !table.is_empty() => self.slots_of(input, name.to_string(), Vec::new(), example),
            _ => {
                let is_known = example.is_number() || example.is_boolean() || example.is_string();
                let example = if is_known { example.clone() } else { Value::Null };
                message = json!({ "data": example });
                let slot = Slot { input, path: vec!["data".into()], example };
                self.slots.insert(format!("{name}.data"), slot.clone());
                self.slots.insert(name.to_string(), slot);
            }
        }
        self.all.push((name.to_string(), message));
    }

    fn slots_of(&mut self, input: usize, at: String, path: Vec<String>, example: &Value) {
        match example {
            Value::Object(table) if !table.is_empty() => {
                for (field, example) in table {
                    let inner = path.iter().cloned().chain([field.clone()]).collect();
                    self.slots_of(input, format!("{at}.{field}"), inner, example);
                }
            }
            // Anything goes where an empty table is the example.
            Value::Object(_) | Value::Array(_) => {
                self.slots.insert(at, Slot { input, path, example: Value::Null });
            }
            _ => {
                self.slots.insert(at, Slot { input, path, example: example.clone() });
            }
        }
    }

    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub fn slot(&self, field: &str) -> Option<Slot> {
        self.slots.get(field).cloned()
    }

    pub fn fields(&self) -> Vec<&str> {
        self.slots.keys().map(String::as_str).collect()
    }

    pub fn name(&self, input: usize) -> &str {
        &self.all[input].0
    }

    pub fn messages(&self) -> Vec<Value> {
        self.all.iter().map(|(_, message)| message.clone()).collect()
    }

    pub fn ports(&self) -> Vec<Port> {
        let fields = |input| {
            let mut names: Vec<&str> =
                self.slots.iter().filter(|(_, slot)| slot.input == input).map(|(field, _)| field.as_str()).collect();
            // `light` and `light.data` are the same.
            names.retain(|name| !name.ends_with(".data"));
            names.join(", ")
        };
        let port = |(at, (name, message)): (usize, &(String, Value))| {
            Port::new(name, message.clone(), format!("from {} in the robot's lines", fields(at)))
        };
        self.all.iter().enumerate().map(port).collect()
    }
}

impl Slot {
    /// The field as the example wants it; an error says what that is.
    pub fn fit(&self, field: Field) -> Result<Value, &'static str> {
        match (&self.example, field) {
            (Value::Number(_), Field::Text(text)) => number(&text).ok_or("a number"),
            (Value::Bool(_), Field::Text(text)) => boolean(&text).map(Value::Bool).ok_or("true or false"),
            (Value::String(_), Field::Text(text)) => Ok(text.into()),
            (_, Field::Text(text)) => Ok(number(&text).unwrap_or_else(|| text.into())),
            (Value::Number(_), Field::Json(value)) if !value.is_number() => Err("a number"),
            (Value::Bool(_), Field::Json(Value::Number(number))) => Ok((number.as_f64() != Some(0.0)).into()),
            (Value::Bool(_), Field::Json(value)) if !value.is_boolean() => Err("true or false"),
            (Value::String(_), Field::Json(value)) if !value.is_string() => Err("a text"),
            (_, Field::Json(value)) => Ok(value),
        }
    }

    pub fn set(&self, message: &mut Value, value: Value) {
        put(message, &self.path, value);
    }
}

/// What the columns of a line are called; an empty name is left out.
#[derive(Clone, Debug, PartialEq)]
pub enum Columns {
    /// All lines are alike.
    Same(Vec<String>),
    /// By the first column.
    Tagged(BTreeMap<String, Vec<String>>),
}

impl Default for Columns {
    fn default() -> Columns {
        Columns::Same(Vec::new())
    }
}

impl Columns {
    pub fn name(&self, values: Vec<String>) -> Result<Named, String> {
        let wrong = |names: &[String]| Err(format!("it has {} columns, not {}", values.len(), names.len()));
        let (names, values) = match self {
            // Nobody has named them yet.
            Columns::Same(names) if names.is_empty() => {
                let numbered = values.into_iter().enumerate();
                return Ok(numbered.map(|(at, value)| (format!("column {}", at + 1), Field::Text(value))).collect());
            }
            Columns::Same(names) if names.len() != values.len() => return wrong(names),
            Columns::Same(names) => (names, values.as_slice()),
            Columns::Tagged(lists) => {
                let (tag, rest) = values.split_first().ok_or("it is empty")?;
                match lists.get(tag) {
                    Some(names) if rest.len() < names.len() => return wrong(names),
                    Some(names) => (names, rest),
                    // Others may send more than is asked for.
                    None => return Ok(Vec::new()),
                }
            }
        };
        let named = names.iter().zip(values).filter(|(name, value)| !name.is_empty() && !value.is_empty());
        Ok(named.map(|(name, value)| (name.clone(), Field::Text(value.clone()))).collect())
    }
}
