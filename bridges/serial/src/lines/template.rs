//! A line with places for the fields of a message: `M {linear.x:.2} {angular.z}`. Written, and read back.
//!
//! `{x}` is a number as short as it goes, `{x:.2}` one with two decimals, `{x:b}` a boolean as 1 or 0, `{x:s}` a text,
//! `{x:json}` anything as JSON; `{}` is the message itself; `{{` and `}}` are braces.

use serde_json::{Map, Value, json};

#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    source: String,
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq)]
enum Part {
    Text(String),
    Place(Place),
}

#[derive(Clone, Debug, PartialEq)]
struct Place {
    /// Into the message; empty: all of it.
    path: Vec<String>,
    form: Form,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Number,
    Decimals(usize),
    Boolean,
    Text,
    Json,
}

/// More decimals say nothing.
const DECIMALS: usize = 17;

impl Template {
    pub fn parse(source: &str) -> Result<Template, String> {
        let (mut parts, mut text, mut rest) = (Vec::new(), String::new(), source);
        while let Some(c) = rest.chars().next() {
            if c.is_control() && c != '\t' {
                return Err("it is one line; several are a list".into());
            }
            if let Some(after) = rest.strip_prefix("{{").or_else(|| rest.strip_prefix("}}")) {
                text.push(c);
                rest = after;
            } else if let Some(after) = rest.strip_prefix('{') {
                let (inside, after) = after.split_once('}').ok_or("a `{` has no `}`; a brace itself is `{{`")?;
                if !text.is_empty() {
                    parts.push(Part::Text(std::mem::take(&mut text)));
                }
                parts.push(Part::Place(Place::parse(inside)?));
                rest = after;
            } else if c == '}' {
                return Err("a `}` has no `{`; a brace itself is `}}`".into());
            } else {
                text.push(c);
                rest = &rest[c.len_utf8()..];
            }
        }
        if !text.is_empty() {
            parts.push(Part::Text(text));
        }
        let template = Template { source: source.to_string(), parts };
        template.check_paths()?;
        Ok(template)
    }

    fn check_paths(&self) -> Result<(), String> {
        let places: Vec<&Place> = self.places().collect();
        for (at, place) in places.iter().enumerate() {
            for other in &places[..at] {
                let [short, long] = if place.path.len() < other.path.len() { [place, other] } else { [other, place] };
                if short.path.len() < long.path.len() && long.path.starts_with(&short.path) {
                    return Err(format!("`{}` can't also have `{}`", short.path.join("."), long.path.join(".")));
                }
            }
        }
        Ok(())
    }

    /// Whether a line can be read with it: two places that touch can't be told apart.
    pub fn is_readable(&self) -> bool {
        !self.parts.windows(2).any(|pair| matches!(pair, [Part::Place(_), Part::Place(_)]))
    }

    pub fn source(&self) -> &str {
        &self.source
    }

    fn places(&self) -> impl Iterator<Item = &Place> {
        self.parts.iter().filter_map(|part| match part {
            Part::Place(place) => Some(place),
            Part::Text(_) => None,
        })
    }

    /// The fields, each once, in the order they come in.
    pub fn paths<'t>(templates: impl IntoIterator<Item = &'t Template>) -> Vec<String> {
        let mut all = Vec::new();
        for place in templates.into_iter().flat_map(Template::places) {
            let path = place.path.join(".");
            if !all.contains(&path) {
                all.push(path);
            }
        }
        all
    }

    /// The message that some lines take, every field at its default.
    pub fn message(templates: &[Template]) -> Value {
        let mut message = Value::Object(Map::new());
        for place in templates.iter().flat_map(Template::places) {
            if !place.path.is_empty() {
                put(&mut message, &place.path, place.form.default());
            }
        }
        message
    }

    pub fn render(&self, message: &Value) -> Result<String, String> {
        let mut line = String::with_capacity(self.source.len() + 16);
        for part in &self.parts {
            match part {
                Part::Text(text) => line.push_str(text),
                Part::Place(place) => line.push_str(&place.render(message)?),
            }
        }
        Ok(line)
    }

    /// The message that a line holds; none: the line is another one. Without places it is `true`.
    pub fn read(&self, line: &str) -> Option<Value> {
        let mut message = if self.places().next().is_some() { Value::Null } else { Value::Bool(true) };
        let mut rest = line;
        for (at, part) in self.parts.iter().enumerate() {
            match part {
                Part::Text(text) => rest = rest.strip_prefix(text.as_str())?,
                Part::Place(place) => {
                    let end = match self.parts.get(at + 1) {
                        Some(Part::Text(text)) => rest.find(text.as_str())?,
                        _ => rest.len(),
                    };
                    put(&mut message, &place.path, place.form.read(&rest[..end])?);
                    rest = &rest[end..];
                }
            }
        }
        rest.is_empty().then_some(message)
    }
}

impl Place {
    fn parse(inside: &str) -> Result<Place, String> {
        let (path, form) = inside.split_once(':').unwrap_or((inside, ""));
        let form = match form {
            "" => Form::Number,
            "b" => Form::Boolean,
            "s" => Form::Text,
            "json" => Form::Json,
            _ => {
                let decimals = form.strip_prefix('.').and_then(|digits| digits.parse().ok());
                let fits = decimals.filter(|&decimals| decimals <= DECIMALS);
                Form::Decimals(fits.ok_or_else(|| format!("`{form}` is no form; there are .2, b, s, json"))?)
            }
        };
        let path: Vec<String> =
            path.trim().split('.').map(str::to_string).filter(|_| !path.trim().is_empty()).collect();
        let fits = |name: &String| !name.is_empty() && name.chars().all(|c| c == '_' || c.is_alphanumeric());
        match path.iter().all(fits) {
            true => Ok(Place { path, form }),
            false => Err(format!("`{{{inside}}}` names no field; a brace itself is `{{{{`")),
        }
    }

    fn render(&self, message: &Value) -> Result<String, String> {
        let value = self.path.iter().try_fold(message, |value, name| value.get(name));
        let value = value.unwrap_or(&Value::Null);
        self.form.render(value).map_err(|wanted| match self.path.is_empty() {
            true => format!("it should be {wanted}"),
            false => format!("`{}` should be {wanted}", self.path.join(".")),
        })
    }
}

impl Form {
    fn default(self) -> Value {
        match self {
            Form::Number | Form::Decimals(_) => json!(0),
            Form::Boolean => json!(false),
            Form::Text => json!(""),
            Form::Json => Value::Null,
        }
    }

    /// An error says what it should be.
    fn render(self, value: &Value) -> Result<String, &'static str> {
        match (self, value) {
            (Form::Json, _) => Ok(value.to_string()),
            (Form::Text, Value::String(text)) => Ok(text.replace(char::is_control, " ")),
            (Form::Text, Value::Number(number)) => Ok(number.to_string()),
            (Form::Text, _) => Err("a text"),
            (Form::Boolean, Value::Number(number)) => Ok(flag(number.as_f64() != Some(0.0))),
            (Form::Boolean, Value::Bool(flagged)) => Ok(flag(*flagged)),
            (Form::Boolean, _) => Err("true or false"),
            (Form::Number | Form::Decimals(_), Value::Bool(flagged)) => Ok(flag(*flagged)),
            (Form::Number, Value::Number(number)) => Ok(shortest(number)),
            (Form::Decimals(decimals), Value::Number(number)) => {
                Ok(format!("{:.decimals$}", number.as_f64().unwrap_or_default()))
            }
            // Also what is no number, or endless: nothing that a robot should get.
            (Form::Number | Form::Decimals(_), _) => Err("a number"),
        }
    }

    fn read(self, text: &str) -> Option<Value> {
        match self {
            Form::Number | Form::Decimals(_) => number(text),
            Form::Boolean => boolean(text).map(Value::Bool),
            Form::Text => Some(text.into()),
            Form::Json => serde_json::from_str(text).ok(),
        }
    }
}

fn flag(flagged: bool) -> String {
    if flagged { "1".into() } else { "0".into() }
}

fn shortest(number: &serde_json::Number) -> String {
    number.as_f64().filter(|_| number.is_f64()).map_or_else(|| number.to_string(), |number| number.to_string())
}

/// A number as robots print it; whole ones stay whole.
pub fn number(text: &str) -> Option<Value> {
    let text = text.trim();
    let plain = text.strip_prefix('+').unwrap_or(text);
    if let Ok(whole) = plain.parse::<i64>() {
        return Some(whole.into());
    }
    plain.parse::<f64>().ok().map(lrp_bridge::value::number)
}

pub fn boolean(text: &str) -> Option<bool> {
    match text.trim().to_ascii_lowercase().as_str() {
        "1" | "true" | "on" | "high" | "yes" => Some(true),
        "0" | "false" | "off" | "low" | "no" => Some(false),
        _ => None,
    }
}

/// Sets a field, with tables for the way to it.
pub fn put(message: &mut Value, path: &[String], value: Value) {
    let Some((name, rest)) = path.split_first() else {
        *message = value;
        return;
    };
    if !message.is_object() {
        *message = Value::Object(Map::new());
    }
    if let Value::Object(table) = message {
        put(table.entry(name).or_insert(Value::Null), rest, value);
    }
}
