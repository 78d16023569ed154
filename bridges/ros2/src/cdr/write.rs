//! JSON to bytes. Fields that a message doesn't give take their defaults; those that its type doesn't have are errors.

use std::fmt;
use std::sync::Arc;

use lrp_bridge::value;
use serde_json::Value;

use super::Order;
use crate::types::{Count, Field, Kind, Scalar, Struct};

/// What a message has that its type can't take, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Mismatch {
    /// The fields on the way, outermost first.
    path: Vec<String>,
    what: String,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.path.is_empty() {
            let path: Vec<&str> = self.path.iter().rev().map(String::as_str).collect();
            write!(formatter, "`{}`: ", path.join("."))?;
        }
        formatter.write_str(&self.what)
    }
}

impl Mismatch {
    fn new(what: impl Into<String>) -> Mismatch {
        Mismatch { path: Vec::new(), what: what.into() }
    }

    fn inside(mut self, place: impl Into<String>) -> Mismatch {
        self.path.push(place.into());
        self
    }
}

/// The payload of a message, without encapsulation header.
pub fn write(kind: &Struct, message: &Value, order: Order) -> Result<Vec<u8>, Mismatch> {
    let mut writer = Writer { bytes: Vec::with_capacity(kind.least), order };
    writer.message(kind, message)?;
    Ok(writer.bytes)
}

struct Writer {
    bytes: Vec<u8>,
    order: Order,
}

impl Writer {
    fn message(&mut self, kind: &Struct, message: &Value) -> Result<(), Mismatch> {
        let given = match message {
            Value::Object(fields) => Some(fields),
            // An empty table of Lua is either.
            Value::Array(items) if items.is_empty() => None,
            Value::Null => None,
            other => {
                let fields = kind.field_names();
                return Err(Mismatch::new(format!(
                    "a {} is a table with fields ({fields}), not {}",
                    kind.name,
                    brief(other)
                )));
            }
        };
        if let Some(name) = given.and_then(|fields| fields.keys().find(|name| kind.field(name).is_none())) {
            let fields = kind.field_names();
            return Err(Mismatch::new(format!("{} has no field `{name}`, its fields are: {fields}", kind.name)));
        }
        if kind.fields.is_empty() {
            self.bytes.push(0);
        }
        for field in &kind.fields {
            let value = given.and_then(|fields| fields.get(&field.name)).filter(|value| !value.is_null());
            let written = match value {
                Some(value) => self.field(field, value),
                None => self.field(field, &field.blank()),
            };
            written.map_err(|mismatch| mismatch.inside(&field.name))?;
        }
        Ok(())
    }

    fn field(&mut self, field: &Field<Arc<Struct>>, value: &Value) -> Result<(), Mismatch> {
        if field.count == Count::One {
            return self.one(&field.kind, value);
        }
        if field.is_bytes()
            && let Some(bytes) = value::as_bytes(value)
        {
            self.count(field.count, bytes.len())?;
            self.bytes.extend(bytes);
            return Ok(());
        }
        let items: &[Value] = match value {
            Value::Array(items) => items,
            Value::Object(fields) if fields.is_empty() => &[],
            other => return Err(Mismatch::new(format!("takes a list, not {}", brief(other)))),
        };
        self.count(field.count, items.len())?;
        for (number, item) in items.iter().enumerate() {
            // As Lua counts.
            self.one(&field.kind, item).map_err(|mismatch| mismatch.inside(format!("{}", number + 1)))?;
        }
        Ok(())
    }

    /// Checks how many there are, and writes it where it isn't known.
    fn count(&mut self, count: Count, given: usize) -> Result<(), Mismatch> {
        match count {
            Count::Exactly(count) if given != count as usize => {
                return Err(Mismatch::new(format!("takes exactly {count} values, not {given}")));
            }
            Count::AtMost(bound) if given > bound as usize => {
                return Err(Mismatch::new(format!("takes at most {bound} values, not {given}")));
            }
            Count::Exactly(_) | Count::One => return Ok(()),
            Count::AtMost(_) | Count::Any => {}
        }
        self.length(given)
    }

    fn length(&mut self, length: usize) -> Result<(), Mismatch> {
        let length = u32::try_from(length).map_err(|_| Mismatch::new("is too long for any message"))?;
        self.number(length.to_le_bytes());
        Ok(())
    }

    fn one(&mut self, kind: &Kind<Arc<Struct>>, value: &Value) -> Result<(), Mismatch> {
        match kind {
            Kind::Scalar(scalar) => self.scalar(*scalar, value),
            Kind::Text { wide, bound } => self.text(*wide, *bound, value),
            Kind::Nested(inner) => self.message(inner, value),
        }
    }

    fn scalar(&mut self, scalar: Scalar, value: &Value) -> Result<(), Mismatch> {
        match scalar {
            Scalar::Bool => {
                let wanted = || Mismatch::new(format!("takes true or false, not {}", brief(value)));
                self.bytes.push(value.as_bool().ok_or_else(wanted)?.into());
            }
            // Beyond the greatest it becomes infinite, as everywhere.
            Scalar::F32 => self.number((float(value)? as f32).to_le_bytes()),
            Scalar::F64 => self.number(float(value)?.to_le_bytes()),
            _ => {
                let number = whole(scalar, value)?;
                match scalar.size() {
                    1 => self.number([number[0]]),
                    2 => self.number([number[0], number[1]]),
                    4 => self.number([number[0], number[1], number[2], number[3]]),
                    _ => self.number(number),
                }
            }
        }
        Ok(())
    }

    fn text(&mut self, wide: bool, bound: Option<u32>, value: &Value) -> Result<(), Mismatch> {
        let text =
            value::as_bytes(value).ok_or_else(|| Mismatch::new(format!("takes a text, not {}", brief(value))))?;
        let units: Vec<u16> = match wide {
            true => String::from_utf8_lossy(&text).encode_utf16().collect(),
            false => Vec::new(),
        };
        let length = if wide { units.len() } else { text.len() };
        if let Some(bound) = bound.filter(|bound| length > *bound as usize) {
            return Err(Mismatch::new(format!("takes a text of at most {bound}, not of {length}")));
        }
        if wide {
            self.length(units.len())?;
            units.iter().for_each(|unit| self.number(u32::from(*unit).to_le_bytes()));
        } else {
            self.length(text.len() + 1)?;
            self.bytes.extend(text);
            self.bytes.push(0);
        }
        Ok(())
    }

    /// A number, given least byte first, at the next place where one of its size may stand.
    fn number<const N: usize>(&mut self, mut number: [u8; N]) {
        self.bytes.resize(self.bytes.len().next_multiple_of(N), 0);
        if self.order == Order::Big {
            number.reverse();
        }
        self.bytes.extend(number);
    }
}

fn float(value: &Value) -> Result<f64, Mismatch> {
    value::as_number(value).ok_or_else(|| Mismatch::new(format!("takes a number, not {}", brief(value))))
}

/// A whole number, also one that Lua made with a point, least byte first.
fn whole(scalar: Scalar, value: &Value) -> Result<[u8; 8], Mismatch> {
    let (least, greatest) = scalar.range().unwrap_or_default();
    let number = match value {
        Value::Number(number) => match (number.as_i64(), number.as_u64(), number.as_f64()) {
            (Some(number), _, _) => Some(i128::from(number)),
            (_, Some(number), _) => Some(i128::from(number)),
            (_, _, Some(number)) if number.fract() == 0.0 && number.abs() < 1e19 => Some(number as i128),
            _ => None,
        },
        _ => None,
    };
    match number.filter(|number| (least..=greatest).contains(number)) {
        // Of the wide two's complement the low bytes are the number.
        Some(number) => Ok((number as u64).to_le_bytes()),
        None => Err(Mismatch::new(format!("takes a whole number from {least} to {greatest}, not {}", brief(value)))),
    }
}

/// A value for an error.
fn brief(value: &Value) -> String {
    match value {
        Value::Object(fields) => match fields.get("lua").and_then(Value::as_str) {
            Some("bytes") => "a string of bytes".to_string(),
            Some(other) => format!("a {other}"),
            None => "a table".to_string(),
        },
        Value::Array(_) => "a list".to_string(),
        Value::String(text) if text.chars().count() > 40 => "a long text".to_string(),
        other => other.to_string(),
    }
}
