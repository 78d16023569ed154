//! What the form says of one topic, service or action: in words, or as a table.

use std::time::Duration;

use lrp_bridge::Problem;
use serde_json::Value;

use super::{Callable, Topic};
use crate::dds::qos::{Qos, Wish};
use crate::names::{Names, full_type, wrong};

/// `"/scan"`, `"/scan sensor_msgs/msg/LaserScan sensor_data"`, or a table with `topic`, `type` and `qos`.
pub fn topic(value: &Value, names: &Names, key: &str, publishes: bool) -> Result<Topic, Problem> {
    let said = said(value, "topic", key, &["topic", "type", "qos"])?;
    let qos = match &said.qos {
        Some(qos) => Wish::read(qos, key)?,
        None if publishes => Wish::Exactly(Qos::DEFAULT),
        None => Wish::Match { depth: Qos::DEFAULT.depth },
    };
    Ok(Topic { name: names.resolve(&said.name), type_name: said.type_name("msg", key)?, qos })
}

pub fn callable(
    value: &Value,
    family: &str,
    patience: Option<Duration>,
    names: &Names,
    key: &str,
) -> Result<Callable, Problem> {
    let word = if family == "srv" { "service" } else { "action" };
    let said = said(value, word, key, &[word, "type", "timeout"])?;
    let timeout = match value.get("timeout") {
        None | Some(Value::Null) => patience,
        Some(timeout) => match timeout.as_f64().filter(|timeout| *timeout > 0.0 && *timeout < 1e12) {
            Some(timeout) => Some(Duration::from_millis(timeout as u64)),
            None => {
                let problem = Problem::new(format!("{timeout} is no time-out")).at(key);
                return Err(problem.help("milliseconds, as `timeout = 2000`"));
            }
        },
    };
    Ok(Callable { name: names.resolve(&said.name), type_name: said.type_name(family, key)?, timeout })
}

/// The parts of an entry.
struct Said {
    name: String,
    type_name: Option<String>,
    qos: Option<Value>,
}

impl Said {
    fn type_name(&self, family: &str, key: &str) -> Result<Option<String>, Problem> {
        let full = self.type_name.as_ref().map(|name| full_type(name, family)).transpose();
        full.map_err(|wrong| Problem::new(wrong).at(key))
    }
}

fn said(value: &Value, word: &str, key: &str, keys: &[&str]) -> Result<Said, Problem> {
    let said = match value {
        Value::String(text) => said_in_words(text, key)?,
        Value::Object(table) => {
            if let Some(unknown) = table.keys().find(|name| !keys.contains(&name.as_str())) {
                let problem = Problem::new(format!("no {word} has a `{unknown}`")).at(key);
                return Err(problem.help(format!("one of: {}", keys.join(", "))));
            }
            let text = |name| table.get(name).and_then(Value::as_str).map(str::to_string);
            Said { name: text(word).unwrap_or_default(), type_name: text("type"), qos: table.get("qos").cloned() }
        }
        _ => Said { name: String::new(), type_name: None, qos: None },
    };
    if said.name.is_empty() {
        let problem = Problem::new(format!("which {word}?")).at(key);
        return Err(problem.help(format!(r#""/name" or {{ {word} = "/name" }}"#)));
    }
    match wrong(&said.name) {
        Some(wrong) => Err(Problem::new(wrong).at(key)),
        None => Ok(said),
    }
}

fn said_in_words(text: &str, key: &str) -> Result<Said, Problem> {
    let mut words = text.split_whitespace();
    let mut said = Said { name: words.next().unwrap_or_default().to_string(), type_name: None, qos: None };
    for word in words {
        if word.contains('/') && said.type_name.is_none() {
            said.type_name = Some(word.to_string());
        } else if Qos::named(word).is_some() && said.qos.is_none() {
            said.qos = Some(Value::String(word.to_string()));
        } else {
            let problem = Problem::new(format!("`{word}` is neither a type nor a QoS profile")).at(key);
            return Err(problem.help("\"/topic package/msg/Type profile\""));
        }
    }
    Ok(said)
}
