//! Reads a configuration as Lua's tables give it, and collects what is wrong with it.

use std::ops::RangeInclusive;

use lrp_bridge::Problem;
use serde_json::Value;

pub struct Read<'a> {
    config: &'a Value,
    pub problems: Vec<Problem>,
}

impl<'a> Read<'a> {
    pub fn new(config: &'a Value) -> Read<'a> {
        Read { config, problems: Vec::new() }
    }

    pub fn given(&self, key: &str) -> Option<&'a Value> {
        self.config.get(key).filter(|value| !value.is_null())
    }

    pub fn wrong(&mut self, key: &str, message: impl Into<String>, help: &str) {
        self.problems.push(Problem::new(message).at(key).help(help));
    }

    pub fn text(&mut self, key: &str) -> Option<&'a str> {
        let value = self.given(key)?;
        let text = value.as_str();
        if text.is_none() {
            self.wrong(key, format!("`{key}` is a text"), "put it between quotes");
        }
        text
    }

    pub fn number(&mut self, key: &str, range: RangeInclusive<f64>, unit: &str) -> Option<f64> {
        let value = self.given(key)?;
        let number = value.as_f64().filter(|number| range.contains(number));
        if number.is_none() {
            let message = format!("`{key}` is a number from {} to {} {unit}", range.start(), range.end());
            self.wrong(key, message.trim_end(), "leave it out for the usual");
        }
        number
    }

    /// A table's entries, each with its key and the place that a problem with it is at. An empty list is an empty table,
    /// as in Lua.
    pub fn entries(&mut self, key: &str, help: &str) -> Vec<(&'a str, String, &'a Value)> {
        match self.given(key) {
            None => Vec::new(),
            Some(Value::Object(table)) => {
                table.iter().map(|(name, value)| (name.as_str(), format!("{key}.{name}"), value)).collect()
            }
            Some(Value::Array(list)) if list.is_empty() => Vec::new(),
            Some(_) => {
                self.wrong(key, format!("`{key}` is a table by name"), help);
                Vec::new()
            }
        }
    }

    /// A name as blocks write it.
    pub fn is_name(&mut self, name: &str, place: &str) -> bool {
        let fits = |(at, c): (usize, char)| c == '_' || c.is_ascii_alphabetic() || (at > 0 && c.is_ascii_digit());
        let is = !name.is_empty() && name.char_indices().all(fits);
        if !is {
            self.wrong(place, format!("`{name}` is no name that a block can use"), "letters, digits and `_`");
        }
        is
    }

    pub fn unknown_keys(&mut self, known: &[&str], of: &str) {
        for key in self.config.as_object().into_iter().flatten().map(|(key, _)| key) {
            if !known.contains(&key.as_str()) {
                self.wrong(key, format!("{of} has no setting `{key}`"), &format!("it has {}", known.join(", ")));
            }
        }
    }
}

/// One text or a list of them.
pub fn texts(value: &Value) -> Option<Vec<&str>> {
    match value {
        Value::String(text) => Some(vec![text]),
        Value::Array(list) => list.iter().map(Value::as_str).collect(),
        _ => None,
    }
}
