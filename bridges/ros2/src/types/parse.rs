//! Reads `.msg`, `.srv` and `.action` texts.

use std::fmt;

use lrp_bridge::value;
use serde_json::{Value, json};

use super::{Count, Definition, Field, Kind, Scalar};

/// What is wrong with a definition, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    pub line: usize,
    pub message: String,
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "line {}: {}", self.line, self.message)
    }
}

/// The parts of a text, which lines of dashes separate: one of a message, two of a service, three of an action.
pub fn parts(text: &str, package: &str) -> Result<Vec<Definition>, Mistake> {
    let mut parts = vec![Definition::default()];
    for (number, line) in text.lines().enumerate() {
        let line = without_comment(line).trim();
        if line.starts_with("---") {
            parts.push(Definition::default());
        } else if !line.is_empty()
            && let Some(part) = parts.last_mut()
        {
            declaration(line, package, part).map_err(|message| Mistake { line: number + 1, message })?;
        }
    }
    Ok(parts)
}

/// A `#` inside quotes is text.
fn without_comment(line: &str) -> &str {
    let (mut quote, mut escaped) = (None, false);
    for (at, char) in line.char_indices() {
        match quote {
            None if char == '#' => return &line[..at],
            None if char == '"' || char == '\'' => quote = Some(char),
            Some(_) if escaped => escaped = false,
            Some(_) if char == '\\' => escaped = true,
            Some(open) if char == open => quote = None,
            _ => {}
        }
    }
    // The quote of an apostrophe in a comment opens nothing.
    match (quote, line.find('#')) {
        (Some(_), Some(at)) => &line[..at],
        _ => line,
    }
}

fn declaration(line: &str, package: &str, into: &mut Definition) -> Result<(), String> {
    let (kind, rest) = line.split_once(char::is_whitespace).ok_or(format!("`{line}` has no name"))?;
    let (kind, count) = counted(kind, package)?;
    let rest = rest.trim_start();
    let end = rest.find(|char: char| !char.is_ascii_alphanumeric() && char != '_').unwrap_or(rest.len());
    let (name, rest) = (&rest[..end], rest[end..].trim());
    if !name.starts_with(|char: char| char.is_ascii_alphabetic()) {
        return Err(format!("`{line}` has no name"));
    }
    let known = into.fields.iter().map(|field| &field.name).chain(into.constants.iter().map(|(name, _)| name));
    if known.into_iter().any(|known| known == name) {
        return Err(format!("`{name}` is declared twice"));
    }
    if let Some(constant) = rest.strip_prefix('=') {
        let value = scalar_or_text(constant.trim(), &kind).ok_or(format!("`{name}` can't be `{}`", constant.trim()))?;
        into.constants.push((name.to_string(), value));
        return Ok(());
    }
    let mut field = Field { name: name.to_string(), kind, count, default: None };
    if !rest.is_empty() {
        field.default = Some(default(rest, &field).ok_or(format!("the default of `{name}` can't be `{rest}`"))?);
    }
    into.fields.push(field);
    Ok(())
}

/// `string<=10[<=5]`: a kind and how many of it.
fn counted(text: &str, package: &str) -> Result<(Kind<String>, Count), String> {
    let Some((one, count)) = text.strip_suffix(']').and_then(|text| text.rsplit_once('[')) else {
        return Ok((kind(text, package)?, Count::One));
    };
    let number = |digits: &str| digits.parse().map_err(|_| format!("`{digits}` is no count"));
    let count = match count.strip_prefix("<=") {
        Some(bound) => Count::AtMost(number(bound)?),
        None if count.is_empty() => Count::Any,
        None => Count::Exactly(number(count)?),
    };
    Ok((kind(one, package)?, count))
}

fn kind(text: &str, package: &str) -> Result<Kind<String>, String> {
    let (name, bound) = match text.split_once("<=") {
        Some((name, bound)) => (name, Some(bound.parse().map_err(|_| format!("`{bound}` is no length"))?)),
        None => (text, None),
    };
    match (name, bound) {
        ("string" | "wstring", bound) => Ok(Kind::Text { wide: name == "wstring", bound }),
        (_, Some(_)) => Err(format!("only strings have a longest length, `{name}` hasn't")),
        (name, None) => match Scalar::named(name) {
            Some(scalar) => Ok(Kind::Scalar(scalar)),
            None => Ok(Kind::Nested(full_name(name, package)?)),
        },
    }
}

/// `Vector3`, `geometry_msgs/Vector3` and `geometry_msgs/msg/Vector3` are the same to a type of that package.
fn full_name(name: &str, package: &str) -> Result<String, String> {
    let parts: Vec<&str> = name.split('/').collect();
    let is_name = |part: &&str| {
        part.starts_with(|char: char| char.is_ascii_alphabetic())
            && part.chars().all(|char| char.is_ascii_alphanumeric() || char == '_')
    };
    if !parts.iter().all(is_name) {
        return Err(format!("`{name}` is no type"));
    }
    match parts[..] {
        // Definitions of ROS 1 say it like this.
        ["time"] => Ok("builtin_interfaces/msg/Time".to_string()),
        ["duration"] => Ok("builtin_interfaces/msg/Duration".to_string()),
        ["Header"] if package != "std_msgs" => Ok("std_msgs/msg/Header".to_string()),
        [name] => Ok(format!("{package}/msg/{name}")),
        [package, name] => Ok(format!("{package}/msg/{name}")),
        [_, _, _] => Ok(name.to_string()),
        _ => Err(format!("`{name}` is no type")),
    }
}

/// The default of a field, as a definition or a type description writes it.
pub fn default<N>(text: &str, field: &Field<N>) -> Option<Value> {
    if field.count == Count::One {
        return scalar_or_text(text, &field.kind);
    }
    let inside = match text.chars().next()? {
        '[' => text.strip_prefix('[')?.strip_suffix(']')?,
        '(' => text.strip_prefix('(')?.strip_suffix(')')?,
        _ => return None,
    };
    let items: Option<Vec<Value>> = items(inside)?.into_iter().map(|item| scalar_or_text(item, &field.kind)).collect();
    let items = items?;
    let fits = match field.count {
        Count::Exactly(count) => items.len() == count as usize,
        Count::AtMost(bound) => items.len() <= bound as usize,
        Count::One | Count::Any => true,
    };
    if !fits {
        return None;
    }
    if field.is_bytes() {
        let bytes: Option<Vec<u8>> = items.iter().map(|item| u8::try_from(item.as_u64()?).ok()).collect();
        return Some(value::bytes(&bytes?));
    }
    Some(Value::Array(items))
}

/// What stands between the commas that are not in quotes.
fn items(text: &str) -> Option<Vec<&str>> {
    let (mut items, mut start, mut quote, mut escaped) = (Vec::new(), 0, None, false);
    for (at, char) in text.char_indices() {
        match quote {
            None if char == ',' => {
                items.push(text[start..at].trim());
                start = at + 1;
            }
            None if char == '"' || char == '\'' => quote = Some(char),
            Some(_) if escaped => escaped = false,
            Some(_) if char == '\\' => escaped = true,
            Some(open) if char == open => quote = None,
            _ => {}
        }
    }
    let last = text[start..].trim();
    if !last.is_empty() {
        items.push(last);
    }
    (quote.is_none() && items.iter().all(|item| !item.is_empty())).then_some(items)
}

fn scalar_or_text<N>(text: &str, kind: &Kind<N>) -> Option<Value> {
    match kind {
        Kind::Text { .. } => unquoted(text).map(Value::String),
        Kind::Scalar(Scalar::Bool) => match text {
            "true" | "True" | "1" => Some(json!(true)),
            "false" | "False" | "0" => Some(json!(false)),
            _ => None,
        },
        Kind::Scalar(Scalar::F32) => text.parse::<f32>().ok().map(|number| value::number(number.into())),
        Kind::Scalar(Scalar::F64) => text.parse::<f64>().ok().map(value::number),
        Kind::Scalar(scalar) => {
            let (least, greatest) = scalar.range()?;
            let number = whole(text).filter(|number| (least..=greatest).contains(number))?;
            u64::try_from(number).map(Value::from).or_else(|_| i64::try_from(number).map(Value::from)).ok()
        }
        Kind::Nested(_) => None,
    }
}

fn whole(text: &str) -> Option<i128> {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => (-1, digits),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let radix = |prefix: [&str; 2]| prefix.iter().find_map(|prefix| digits.strip_prefix(prefix));
    let number = if let Some(digits) = radix(["0x", "0X"]) {
        i128::from_str_radix(digits, 16)
    } else if let Some(digits) = radix(["0b", "0B"]) {
        i128::from_str_radix(digits, 2)
    } else if let Some(digits) = radix(["0o", "0O"]) {
        i128::from_str_radix(digits, 8)
    } else {
        digits.parse()
    };
    number.ok().map(|number| sign * number)
}

/// A text in quotes, or one without any as constants may be written.
fn unquoted(text: &str) -> Option<String> {
    let Some(quote) = text.chars().next().filter(|char| ['"', '\''].contains(char)) else {
        return Some(text.to_string());
    };
    let inside = text.get(1..)?.strip_suffix(quote)?;
    let (mut plain, mut chars) = (String::new(), inside.chars());
    while let Some(char) = chars.next() {
        match char {
            '\\' => match chars.next()? {
                'n' => plain.push('\n'),
                't' => plain.push('\t'),
                'r' => plain.push('\r'),
                other => plain.push(other),
            },
            // The end came before the end.
            char if char == quote => return None,
            char => plain.push(char),
        }
    }
    Some(plain)
}
