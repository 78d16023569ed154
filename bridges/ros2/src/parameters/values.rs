//! Values of the program as `rcl_interfaces/msg/ParameterValue`, and back.

use lrp_bridge::value;
use serde_json::{Value, json};

/// Types, in `rcl_interfaces/msg/ParameterType`.
pub const NOT_SET: u64 = 0;
const BOOL: u64 = 1;
pub const INTEGER: u64 = 2;
pub const DOUBLE: u64 = 3;
const STRING: u64 = 4;
const BYTES: u64 = 5;
const BOOLS: u64 = 6;
pub const INTEGERS: u64 = 7;
pub const DOUBLES: u64 = 8;
const STRINGS: u64 = 9;

const NAMES: [&str; 10] =
    ["not set", "bool", "integer", "double", "string", "bytes", "bools", "integers", "doubles", "strings"];
const FIELDS: [&str; 10] = [
    "",
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "byte_array_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
];

/// What a `rcl_interfaces/msg/ParameterValue` holds.
pub fn read(name: &str, value: &Value) -> Result<Value, String> {
    match value["type"].as_u64() {
        None | Some(NOT_SET) => Err(format!("there is no parameter `{name}`, or it has no value")),
        Some(kind) => {
            let field = FIELDS.get(kind as usize).ok_or_else(|| format!("`{name}` is of an unknown type"))?;
            Ok(value[field].clone())
        }
    }
}

pub fn named(kind: u64) -> &'static str {
    NAMES.get(kind as usize).copied().unwrap_or("something else")
}

/// A `ParameterValue` that holds a value.
pub fn write(value: &Value) -> Option<Value> {
    as_type(value, type_of(value)?)
}

pub fn type_of(value: &Value) -> Option<u64> {
    match value {
        Value::Bool(_) => Some(BOOL),
        Value::Number(number) if number.is_f64() => Some(DOUBLE),
        Value::Number(number) => number.as_i64().map(|_| INTEGER),
        Value::String(_) => Some(STRING),
        Value::Array(items) => {
            let mut types = items.iter().map(|item| type_of(item).filter(|kind| *kind <= STRING));
            let first = types.next()??;
            types
                .try_fold(first, |kind, next| match (kind, next?) {
                    (one, other) if one == other => Some(one),
                    (INTEGER | DOUBLE, INTEGER | DOUBLE) => Some(DOUBLE),
                    _ => None,
                })
                .map(|kind| match kind {
                    BOOL => BOOLS,
                    INTEGER => INTEGERS,
                    DOUBLE => DOUBLES,
                    _ => STRINGS,
                })
        }
        other => match (value::as_number(other), value::as_bytes(other)) {
            (Some(_), _) => Some(DOUBLE),
            (None, Some(_)) => Some(BYTES),
            _ => None,
        },
    }
}

/// A `ParameterValue` of that type, where the value can be one.
pub fn as_type(value: &Value, kind: u64) -> Option<Value> {
    let one = |value: &Value, kind| match kind {
        BOOL => value.as_bool().map(Value::Bool),
        INTEGER => whole(value).map(Value::from),
        DOUBLE => value::as_number(value).map(value::number),
        _ => value.as_str().map(Value::from),
    };
    let all = |kind| {
        let items = match value {
            Value::Array(items) => items.iter().map(|item| one(item, kind)).collect::<Option<Vec<Value>>>()?,
            Value::Object(fields) if fields.is_empty() => Vec::new(),
            _ => return None,
        };
        Some(Value::Array(items))
    };
    let held = match kind {
        BOOL | INTEGER | DOUBLE | STRING => one(value, kind)?,
        BYTES => value::bytes(&value::as_bytes(value)?),
        BOOLS => all(BOOL)?,
        INTEGERS => all(INTEGER)?,
        DOUBLES => all(DOUBLE)?,
        STRINGS => all(STRING)?,
        _ => return None,
    };
    Some(json!({ "type": kind, (FIELDS[kind as usize]): held }))
}

fn whole(value: &Value) -> Option<i64> {
    let from_float = || value.as_f64().filter(|number| number.fract() == 0.0 && number.abs() < 9e15);
    value.as_i64().or_else(|| from_float().map(|number| number as i64))
}
