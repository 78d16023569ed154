//! Messages between blocks and robots: whole, unlike values that are shown. What JSON has no word for is written as
//! the bridges' protocol has it; what a record shows of a large one is cut.

use lrp_bridge::value::{as_bytes, as_number, bytes, number};
use mlua::{IntoLua, Lua, Table};
use serde_json::{Map, Value, json};

/// Tables within tables, of a message that is sent.
const DEPTH: usize = 32;
/// About how many bytes of a message are put into a record.
const SHOWN: usize = 1024;

/// A message as blocks see it; an absent field is nil.
pub fn to_lua(lua: &Lua, message: &Value) -> mlua::Result<mlua::Value> {
    match message {
        Value::Null => Ok(mlua::Value::Nil),
        Value::Bool(value) => value.into_lua(lua),
        Value::Number(number) => match number.as_i64() {
            Some(integer) => integer.into_lua(lua),
            None => number.as_f64().into_lua(lua),
        },
        Value::String(text) => text.as_str().into_lua(lua),
        Value::Array(items) => {
            let table = lua.create_table_with_capacity(items.len(), 0)?;
            for (index, item) in items.iter().enumerate() {
                table.raw_set(index + 1, to_lua(lua, item)?)?;
            }
            Ok(mlua::Value::Table(table))
        }
        Value::Object(fields) if fields.contains_key("lua") => match (as_bytes(message), as_number(message)) {
            (Some(bytes), _) => lua.create_string(bytes)?.into_lua(lua),
            (None, Some(number)) => number.into_lua(lua),
            (None, None) => Ok(mlua::Value::Nil),
        },
        Value::Object(fields) => {
            let table = lua.create_table_with_capacity(0, fields.len())?;
            for (field, value) in fields {
                table.raw_set(field.as_str(), to_lua(lua, value)?)?;
            }
            Ok(mlua::Value::Table(table))
        }
    }
}

/// A message as a bridge gets it; none: a function or something else that is no data, or tables that go too deep.
pub fn from_lua(value: &mlua::Value) -> Option<Value> {
    within(value, DEPTH)
}

fn within(value: &mlua::Value, depth: usize) -> Option<Value> {
    match value {
        mlua::Value::Nil => Some(Value::Null),
        mlua::Value::Boolean(value) => Some(json!(value)),
        mlua::Value::Integer(integer) => Some(json!(integer)),
        mlua::Value::Number(float) => Some(number(*float)),
        mlua::Value::String(text) => Some(match text.to_str() {
            Ok(text) => json!(*text),
            Err(_) => bytes(&text.as_bytes()),
        }),
        mlua::Value::Table(table) => of_table(table, depth.checked_sub(1)?),
        _ => None,
    }
}

fn of_table(table: &Table, depth: usize) -> Option<Value> {
    let length = table.raw_len();
    let pairs = table.pairs::<mlua::Value, mlua::Value>().map(Result::ok).collect::<Option<Vec<_>>>()?;
    if length > 0 && pairs.len() == length {
        return (1..=length).map(|index| within(&table.raw_get(index).ok()?, depth)).collect();
    }
    let field = |(key, value): (mlua::Value, mlua::Value)| {
        let key = match key {
            mlua::Value::String(key) => key.to_string_lossy(),
            mlua::Value::Integer(key) => key.to_string(),
            _ => return None,
        };
        Some((key, within(&value, depth)?))
    };
    pairs.into_iter().map(field).collect::<Option<Map<_, _>>>().map(Value::Object)
}

/// As much of a message as a record shows.
pub fn shown(message: Value) -> Value {
    let mut left = SHOWN;
    if size(&message, SHOWN) <= SHOWN { message } else { cut(message, &mut left) }
}

/// About how many bytes it takes; counted no further than a limit.
fn size(value: &Value, limit: usize) -> usize {
    let mut all = 4;
    match value {
        Value::String(text) => all += text.len(),
        Value::Array(items) => items.iter().take_while(|item| add(&mut all, size(item, limit), limit)).for_each(drop),
        Value::Object(fields) => {
            fields.iter().take_while(|(key, item)| add(&mut all, key.len() + size(item, limit), limit)).for_each(drop);
        }
        _ => {}
    }
    all
}

fn add(all: &mut usize, more: usize, limit: usize) -> bool {
    *all += more;
    *all <= limit
}

fn cut(value: Value, left: &mut usize) -> Value {
    *left = left.saturating_sub(4);
    match value {
        Value::String(text) => Value::String(cut_text(text, left)),
        Value::Array(items) => {
            let (mut kept, mut rest) = (Vec::new(), items.into_iter());
            while *left > 0
                && let Some(item) = rest.next()
            {
                kept.push(cut(item, left));
            }
            if rest.len() > 0 {
                kept.push(json!({ "cut": rest.len() }));
            }
            Value::Array(kept)
        }
        Value::Object(fields) => {
            let (mut kept, mut rest) = (Map::new(), fields.into_iter());
            while *left > 0
                && let Some((key, item)) = rest.next()
            {
                *left = left.saturating_sub(key.len());
                kept.insert(key, cut(item, left));
            }
            match rest.count() {
                0 => {}
                count => drop(kept.insert("cut".to_string(), json!(count))),
            }
            Value::Object(kept)
        }
        other => other,
    }
}

fn cut_text(mut text: String, left: &mut usize) -> String {
    let mut end = text.len().min(*left);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    *left -= end;
    if end < text.len() {
        text.truncate(end);
        text.push('…');
    }
    text
}
