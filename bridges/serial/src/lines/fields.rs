//! The fields of a line, in each of the ways in which robots write them.

use serde_json::Value;

use super::{Columns, nmea};

/// How a line holds its fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fields {
    /// `light=230 bumper:0`
    #[default]
    Kv,
    /// `230,0`
    Csv,
    /// `{"light":230}`
    Json,
    /// `$GPGLL,..*1D`
    Nmea,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    Text(String),
    Json(Value),
}

pub type Named = Vec<(String, Field)>;

impl Fields {
    pub fn of_name(name: &str) -> Option<Fields> {
        match name {
            "kv" => Some(Fields::Kv),
            "csv" => Some(Fields::Csv),
            "json" => Some(Fields::Json),
            "nmea" => Some(Fields::Nmea),
            _ => None,
        }
    }

    /// Each field with its name. An error says what is wrong with the line.
    pub fn read(self, line: &str, columns: &Columns) -> Result<Named, String> {
        match self {
            Fields::Kv => pairs(line),
            Fields::Csv => columns.name(split(line)?),
            Fields::Nmea => columns.name(nmea::sentence(line)?.split(',').map(str::to_string).collect()),
            Fields::Json => match serde_json::from_str(line) {
                Ok(Value::Object(table)) => {
                    Ok(table.into_iter().map(|(key, value)| (key, Field::Json(value))).collect())
                }
                Ok(_) => Err("it is no JSON object".into()),
                Err(_) => Err("it is no JSON".into()),
            },
        }
    }
}

impl Field {
    /// How a form would declare it; a table has to be written out by hand.
    pub fn example(&self) -> Option<&'static str> {
        match self.type_name() {
            "number" => Some("0"),
            "text" => Some("\"\""),
            "boolean" => Some("false"),
            _ => None,
        }
    }

    pub fn type_name(&self) -> &'static str {
        match self {
            Field::Text(text) if super::template::number(text).is_some() => "number",
            Field::Text(_) | Field::Json(Value::String(_)) => "text",
            Field::Json(Value::Number(_)) => "number",
            Field::Json(Value::Bool(_)) => "boolean",
            Field::Json(_) => "table",
        }
    }
}

fn pairs(line: &str) -> Result<Named, String> {
    let is_gap = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '|');
    let (mut all, mut rest) = (Vec::new(), line.trim_start_matches(is_gap));
    while !rest.is_empty() {
        let end = rest.find(['=', ':']).ok_or("it isn't made of name=value")?;
        let name = rest[..end].trim();
        if name.is_empty() || name.contains(is_gap) {
            return Err("it isn't made of name=value".into());
        }
        let value = rest[end + 1..].trim_start();
        let (value, after) = match value.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').ok_or("a quote has no end")?,
            None => value.split_at(value.find(is_gap).unwrap_or(value.len())),
        };
        all.push((name.to_string(), Field::Text(value.to_string())));
        rest = after.trim_start_matches(is_gap);
    }
    Ok(all)
}

/// At commas, semicolons or tabs, whichever comes first; quotes keep what is between them together.
fn split(line: &str) -> Result<Vec<String>, String> {
    let mut is_quoted = false;
    let mut outside = line.chars().filter(|c| {
        is_quoted ^= *c == '"';
        !is_quoted
    });
    let separator = outside.find(|c| matches!(c, ',' | ';' | '\t')).unwrap_or(',');
    let (mut all, mut rest) = (Vec::new(), line);
    loop {
        let (value, after) = match rest.trim_start_matches(' ').strip_prefix('"') {
            Some(quoted) => unquoted(quoted)?,
            None => {
                let end = rest.find(separator).unwrap_or(rest.len());
                (rest[..end].trim().to_string(), &rest[end..])
            }
        };
        all.push(value);
        match after.trim_start_matches(' ').strip_prefix(separator) {
            Some(next) => rest = next,
            None if after.trim().is_empty() => return Ok(all),
            None => return Err("something follows a quote".into()),
        }
    }
}

/// Up to the quote that ends it, of which two stand for one; and what follows.
fn unquoted(text: &str) -> Result<(String, &str), String> {
    let (mut value, mut rest) = (String::new(), text);
    loop {
        let (part, after) = rest.split_once('"').ok_or("a quote has no end")?;
        value.push_str(part);
        match after.strip_prefix('"') {
            Some(more) => {
                value.push('"');
                rest = more;
            }
            None => return Ok((value, after)),
        }
    }
}
