//! Numbers, times and values in the few columns there are. Knows nothing of where they are shown.

use serde_json::{Map, Value};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use super::glyphs;
use super::view::Timeout;
use crate::runtime::time::Time;

/// Columns a text takes.
pub fn width(text: &str) -> u16 {
    text.width().min(u16::MAX as usize) as u16
}

/// A text in at most `room` columns on one line; what is left out shows as an ellipsis.
pub fn fit(text: &str, room: u16) -> String {
    let one_line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if width(&one_line) <= room {
        return one_line;
    }
    if width(one_line.trim_end()) <= room {
        return one_line.trim_end().into();
    }
    let mut short = String::new();
    let mut taken = 1;
    for c in one_line.chars() {
        taken += c.width().unwrap_or(0) as u16;
        if taken > room {
            break;
        }
        short.push(c);
    }
    if room > 0 {
        short.push_str(glyphs::ELLIPSIS);
    }
    short
}

/// A text in lines of at most `room` columns, broken between words where it can be.
pub fn wrap(text: &str, room: u16) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        let words = paragraph.split_whitespace().flat_map(|word| pieces(word, room));
        for word in words {
            if !line.is_empty() && width(&line) + 1 + width(&word) > room {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&word);
        }
        lines.push(line);
    }
    lines
}

/// A text cut between words into what fits `room` columns and the rest.
pub fn split(text: &str, room: u16) -> (String, String) {
    let mut lines = wrap(&text.replace(|c: char| c.is_control(), " "), room).into_iter();
    let first = lines.next().unwrap_or_default();
    (first, lines.collect::<Vec<_>>().join(" "))
}

/// A word, cut where it is longer than a line.
fn pieces(word: &str, room: u16) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for c in word.chars() {
        let last = pieces.len() - 1;
        if width(&pieces[last]) + c.width().unwrap_or(0) as u16 > room && !pieces[last].is_empty() {
            pieces.push(c.into());
        } else {
            pieces[last].push(c);
        }
    }
    pieces
}

/// How long: `120 ms`, `4.3 s`, `2:04`, `1:02:04`.
pub fn duration(ms: f64) -> String {
    match ms {
        ms if ms < 999.5 => format!("{} ms", ms.max(0.0).round()),
        ms if ms < 59_950.0 => format!("{:.1} s", ms / 1000.0),
        ms => clock_of((ms / 1000.0).min(1e15) as u64),
    }
}

/// Program time: `0:02.9`, `1:02:03.9`.
pub fn clock(t: Time) -> String {
    let tenths = t.0 / 100_000;
    format!("{}.{}", clock_of(tenths / 10), tenths % 10)
}

fn clock_of(seconds: u64) -> String {
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match hours {
        0 => format!("{minutes}:{seconds:02}"),
        _ => format!("{hours}:{minutes:02}:{seconds:02}"),
    }
}

/// Steps a second.
pub fn rate(hz: f64) -> String {
    match hz {
        0.0 => "max".into(),
        hz if hz >= 1e6 => format!("{:.1} MHz", hz / 1e6),
        hz if hz >= 1e4 => format!("{:.0} kHz", hz / 1e3),
        hz => format!("{} Hz", number(hz)),
    }
}

/// The last part of a path.
pub fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// At most six significant digits, no needless zeros.
pub fn number(n: f64) -> String {
    if n == 0.0 {
        return "0".into();
    }
    if !n.is_finite() {
        return if n.is_nan() {
            "nan".into()
        } else if n > 0.0 {
            "inf".into()
        } else {
            "-inf".into()
        };
    }
    let magnitude = n.abs().log10().floor() as i32;
    if !(-5..9).contains(&magnitude) {
        return format!("{n:.3e}");
    }
    let decimals = (5 - magnitude).clamp(0, 6) as usize;
    let text = format!("{n:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

/// A value as Lua would write it, with numbers shortened for reading.
pub fn value(value: &Value) -> String {
    lua(value, &|n| n.as_f64().filter(|_| n.is_f64()).map_or_else(|| n.to_string(), number))
}

/// A value as Lua text that gives the same value; none for what has no such text: functions, devices, cut tables.
pub fn source(value: &Value) -> Option<String> {
    is_whole(value).then(|| lua(value, &|n| n.to_string()))
}

/// With all its digits where it has a text, else as it is read.
pub fn exactly(value: &Value) -> String {
    source(value).unwrap_or_else(|| self::value(value))
}

/// What a value is: `integer`, `string of 5 characters`, `table of 2`.
pub fn kind(value: &Value) -> String {
    let counted = |of: &str, count: usize, noun: &str| match count {
        1 => format!("{of} of 1{noun}"),
        _ if noun.is_empty() => format!("{of} of {count}"),
        _ => format!("{of} of {count}{noun}s"),
    };
    match value {
        Value::Null => "nil".into(),
        Value::Bool(_) => "boolean".into(),
        Value::Number(number) if number.is_f64() => "number".into(),
        Value::Number(_) => "integer".into(),
        Value::String(text) if matches!(&**text, "nan" | "inf" | "-inf") => "number".into(),
        Value::String(text) => counted("string", text.chars().count(), " character"),
        Value::Array(items) => counted("table", items.len(), ""),
        Value::Object(_) if marker(value).is_some() => "not to be written down".into(),
        Value::Object(fields) => counted("table", fields.len(), ""),
    }
}

fn is_whole(value: &Value) -> bool {
    match value {
        Value::Array(items) => items.iter().all(is_whole),
        Value::Object(fields) if marker(value).is_some() => fields.is_empty(),
        Value::Object(fields) => fields.values().all(is_whole),
        _ => true,
    }
}

/// What stands for a value that JSON has no form for.
fn marker(value: &Value) -> Option<String> {
    let fields = value.as_object().filter(|fields| fields.len() == 1)?;
    if let Some(what) = fields.get("lua").and_then(Value::as_str) {
        return Some(what.into());
    }
    fields.get("cut").map(|_| format!("{{{}}}", glyphs::ELLIPSIS))
}

fn lua(value: &Value, number: &dyn Fn(&serde_json::Number) -> String) -> String {
    if let Some(mark) = marker(value) {
        return mark;
    }
    match value {
        Value::Null => "nil".into(),
        Value::Bool(yes) => yes.to_string(),
        Value::Number(n) => number(n),
        Value::String(text) => quoted(text),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| lua(item, number)).collect();
            format!("{{{}}}", items.join(", "))
        }
        Value::Object(fields) => {
            let fields: Vec<String> =
                fields.iter().map(|(key, item)| format!("{} = {}", field(key), lua(item, number))).collect();
            format!("{{{}}}", fields.join(", "))
        }
    }
}

/// Records carry what JSON has no number for as these strings.
fn quoted(text: &str) -> String {
    match text {
        "nan" => "0/0".into(),
        "inf" => "math.huge".into(),
        "-inf" => "-math.huge".into(),
        _ => format!("{text:?}"),
    }
}

fn field(key: &str) -> String {
    let named =
        key.chars().enumerate().all(|(i, c)| c == '_' || c.is_ascii_alphabetic() || (i > 0 && c.is_ascii_digit()));
    if named && !key.is_empty() { key.into() } else { format!("[{key:?}]") }
}

/// Messages with more fields than this are told without those that are zero, false or empty.
const FEW: usize = 4;

/// What a message says, field by field, always in the same order: `x 3.50  y 1.62  theta 0.00`, `angular.z -0.80`.
pub fn message(message: &Value) -> String {
    let mut fields = Vec::new();
    collect("", message, &mut fields);
    if fields.len() > FEW {
        fields.retain(|(_, item)| !is_silent(item));
    }
    let word =
        |(path, item): &(String, &Value)| if path.is_empty() { short(item) } else { format!("{path} {}", short(item)) };
    if fields.is_empty() { "0".into() } else { fields.iter().map(word).collect::<Vec<_>>().join("  ") }
}

fn collect<'a>(path: &str, item: &'a Value, found: &mut Vec<(String, &'a Value)>) {
    match item {
        Value::Object(fields) if marker(item).is_none() => {
            for (field, item) in in_order(fields) {
                let path = if path.is_empty() { field.clone() } else { format!("{path}.{field}") };
                collect(&path, item, found);
            }
        }
        _ => found.push((path.into(), item)),
    }
}

fn in_order(fields: &Map<String, Value>) -> Vec<(&String, &Value)> {
    let mut fields: Vec<_> = fields.iter().collect();
    fields.sort_by_key(|(field, _)| rank(field));
    fields
}

/// What is in a table, each with its key; nothing for what is none.
pub fn entries(value: &Value) -> Vec<(String, &Value)> {
    match value {
        Value::Array(items) => (1..).zip(items).map(|(place, item): (u32, _)| (place.to_string(), item)).collect(),
        Value::Object(fields) if marker(value).is_none() => {
            in_order(fields).into_iter().map(|(field, item)| (field.clone(), item)).collect()
        }
        _ => Vec::new(),
    }
}

/// Where a field stands that has a place of its own among others; those without follow by name.
fn rank(field: &str) -> usize {
    const ORDER: [&str; 8] = ["linear", "angular", "x", "y", "z", "w", "theta", "data"];
    ORDER.iter().position(|&known| known == field).unwrap_or(ORDER.len())
}

/// A value with two decimals, so that it keeps its width while it changes.
fn short(item: &Value) -> String {
    let number = |n: &serde_json::Number| match n.as_f64() {
        // Adding zero makes nothing of a negative one.
        Some(number) if n.is_f64() && number.abs() < 1e6 => format!("{:.2}", (number * 100.0).round() / 100.0 + 0.0),
        _ => n.to_string(),
    };
    lua(item, &number)
}

fn is_silent(value: &Value) -> bool {
    match value {
        Value::Null | Value::Bool(false) => true,
        Value::Number(n) => n.as_f64() == Some(0.0),
        Value::String(text) => text.is_empty(),
        Value::Array(items) => items.is_empty(),
        _ => false,
    }
}

/// How much of a timeout is over.
pub fn bar(timeout: Timeout, columns: u16) -> String {
    let full = (timeout.part() * f64::from(columns)).round() as usize;
    let columns = columns as usize;
    glyphs::FULL.repeat(full.min(columns)) + &glyphs::EMPTY.repeat(columns - full.min(columns))
}
