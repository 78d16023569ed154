//! Values between a test's Lua and records: as JSON, as Lua's own, as text. Numbers that JSON hasn't are the strings that
//! records have for them.

use mlua::{Lua, Table};
use serde_json::{Map, Number, Value};

use super::failure::Complaint;

/// How deep tables may lie in each other: one that holds itself has no end.
const DEPTH: usize = 32;

/// A value of a record in a test's Lua.
pub fn to_lua(lua: &Lua, value: &Value) -> mlua::Result<mlua::Value> {
    Ok(match value {
        Value::Null => mlua::Value::Nil,
        Value::Bool(flag) => mlua::Value::Boolean(*flag),
        Value::Number(number) => match number.as_i64() {
            Some(integer) => mlua::Value::Integer(integer),
            None => mlua::Value::Number(number.as_f64().unwrap_or(f64::NAN)),
        },
        Value::String(text) => match &**text {
            "nan" => mlua::Value::Number(f64::NAN),
            "inf" => mlua::Value::Number(f64::INFINITY),
            "-inf" => mlua::Value::Number(f64::NEG_INFINITY),
            text => mlua::Value::String(lua.create_string(text)?),
        },
        Value::Array(items) => {
            let items: Vec<mlua::Value> = items.iter().map(|item| to_lua(lua, item)).collect::<mlua::Result<_>>()?;
            mlua::Value::Table(lua.create_sequence_from(items)?)
        }
        Value::Object(fields) => {
            let table = lua.create_table()?;
            for (key, item) in fields {
                table.raw_set(&**key, to_lua(lua, item)?)?;
            }
            mlua::Value::Table(table)
        }
    })
}

/// A message as a robot would send it.
pub fn to_json(value: &mlua::Value) -> Result<Value, Complaint> {
    json(value, DEPTH)
}

fn json(value: &mlua::Value, depth: usize) -> Result<Value, Complaint> {
    match value {
        mlua::Value::Nil => Ok(Value::Null),
        mlua::Value::Boolean(flag) => Ok(Value::Bool(*flag)),
        mlua::Value::Integer(number) => Ok((*number).into()),
        mlua::Value::Number(number) => {
            let number = Number::from_f64(*number)
                .ok_or_else(|| Complaint::new(format!("a message can't hold the number {number}")))?;
            Ok(Value::Number(number))
        }
        mlua::Value::String(text) => Ok(Value::String(text.to_string_lossy())),
        mlua::Value::Table(_) if depth == 0 => {
            Err(Complaint::new("a message can't hold tables that lie this deep in each other"))
        }
        mlua::Value::Table(table) => json_table(table, depth - 1),
        other => Err(Complaint::new(format!("a message can't hold a {}", other.type_name()))),
    }
}

fn json_table(table: &Table, depth: usize) -> Result<Value, Complaint> {
    if table.raw_len() > 0 {
        let items = table.sequence_values::<mlua::Value>().flatten().map(|item| json(&item, depth));
        return items.collect::<Result<_, _>>().map(Value::Array);
    }
    let mut fields = Map::new();
    for (key, item) in table.pairs::<mlua::Value, mlua::Value>().flatten() {
        let mlua::Value::String(key) = key else {
            return Err(Complaint::new(format!("a message has fields with names, not with a {}", key.type_name())));
        };
        fields.insert(key.to_string_lossy(), json(&item, depth)?);
    }
    Ok(Value::Object(fields))
}

/// A Lua expression for a test's value.
pub fn source(value: &mlua::Value) -> Result<String, Complaint> {
    expression(value, DEPTH)
}

fn expression(value: &mlua::Value, depth: usize) -> Result<String, Complaint> {
    Ok(match value {
        mlua::Value::Nil => "nil".to_string(),
        mlua::Value::Boolean(flag) => flag.to_string(),
        mlua::Value::Integer(number) => number.to_string(),
        mlua::Value::Number(number) if number.is_nan() => "0/0".to_string(),
        mlua::Value::Number(number) if number.is_infinite() => {
            format!("{}math.huge", if *number < 0.0 { "-" } else { "" })
        }
        mlua::Value::Number(number) => format!("{number:?}"),
        mlua::Value::String(text) => quoted(&text.as_bytes()),
        mlua::Value::Table(table) if depth > 0 => table_expression(table, depth - 1)?,
        mlua::Value::Table(_) => {
            return Err(Complaint::new("a variable can't be set to tables that lie this deep in each other"));
        }
        other => return Err(Complaint::new(format!("a variable can't be set to a {} from a test", other.type_name()))),
    })
}

fn table_expression(table: &Table, depth: usize) -> Result<String, Complaint> {
    let listed = table.raw_len() as i64;
    let mut items = Vec::new();
    for item in table.sequence_values::<mlua::Value>().flatten() {
        items.push(expression(&item, depth)?);
    }
    for (key, item) in table.pairs::<mlua::Value, mlua::Value>().flatten() {
        if !key.as_integer().is_some_and(|key| (1..=listed).contains(&key)) {
            items.push(format!("[{}] = {}", expression(&key, depth)?, expression(&item, depth)?));
        }
    }
    Ok(format!("{{{}}}", items.join(", ")))
}

fn quoted(bytes: &[u8]) -> String {
    let mut text = String::from("\"");
    for &byte in bytes {
        match byte {
            b'"' | b'\\' => text.extend(['\\', char::from(byte)]),
            b' '..=b'~' => text.push(char::from(byte)),
            _ => text += &format!("\\{byte:03}"),
        }
    }
    text + "\""
}

/// A value of a record for reading, in Lua's words.
pub fn text(value: &Value) -> String {
    match value {
        Value::Null => "nil".to_string(),
        Value::String(text) => format!("{text:?}"),
        Value::Array(items) => format!("{{ {} }}", items.iter().map(text).collect::<Vec<_>>().join(", ")),
        Value::Object(fields) if fields.is_empty() => "{}".to_string(),
        Value::Object(fields) => match fields.get("lua") {
            Some(Value::String(what)) => what.clone(),
            _ => {
                let fields: Vec<String> = fields.iter().map(|(key, item)| format!("{key} = {}", text(item))).collect();
                format!("{{ {} }}", fields.join(", "))
            }
        },
        plain => plain.to_string(),
    }
}
