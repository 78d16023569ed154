//! Bytes to JSON. What comes from the network may be anything: nothing here panics, or takes more memory than the
//! message's own length warrants.

use std::fmt;
use std::sync::Arc;

use lrp_bridge::value;
use serde_json::{Map, Value};

use super::Order;
use crate::types::{Count, Field, Kind, Scalar, Struct};

/// A payload that isn't what its type says.
#[derive(Clone, Debug, PartialEq)]
pub struct Malformed {
    pub type_name: String,
    pub length: usize,
    pub at: usize,
    pub what: What,
}

#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// The payload ends before the message does.
    Truncated,
    /// A sequence or text longer than its type allows.
    TooLong(u32),
    NoBool(u8),
}

impl fmt::Display for Malformed {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Malformed { type_name, length, at, what } = self;
        write!(formatter, "a malformed {type_name} of {length} bytes: ")?;
        match what {
            What::Truncated => write!(formatter, "it ends in the middle (at byte {at})"),
            What::TooLong(count) => write!(formatter, "a length of {count} at byte {at} is more than its type allows"),
            What::NoBool(byte) => write!(formatter, "the bool at byte {at} is {byte}"),
        }
    }
}

/// The message in a payload, without its encapsulation header. What may follow, padding or fields of a later version, is
/// left alone.
pub fn read(kind: &Struct, payload: &[u8], order: Order) -> Result<Value, Malformed> {
    let mut reader = Reader { bytes: payload, at: 0, order };
    reader.message(kind).map_err(|what| Malformed {
        type_name: kind.name.clone(),
        length: payload.len(),
        at: reader.at,
        what,
    })
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    order: Order,
}

impl<'a> Reader<'a> {
    fn message(&mut self, kind: &Struct) -> Result<Value, What> {
        if kind.fields.is_empty() {
            self.take(1)?;
        }
        let mut message = Map::new();
        for field in &kind.fields {
            message.insert(field.name.clone(), self.field(field)?);
        }
        Ok(Value::Object(message))
    }

    fn field(&mut self, field: &Field<Arc<Struct>>) -> Result<Value, What> {
        let count = match field.count {
            Count::One => return self.one(&field.kind),
            Count::Exactly(count) => count,
            Count::AtMost(bound) => self.length(bound)?,
            Count::Any => self.length(u32::MAX)?,
        };
        if field.is_bytes() {
            return self.take(count as usize).map(value::bytes);
        }
        let least = field.kind.least().saturating_mul(count as usize);
        if least > self.bytes.len() - self.at {
            return Err(What::Truncated);
        }
        let items: Result<Vec<Value>, What> = (0..count).map(|_| self.one(&field.kind)).collect();
        items.map(Value::Array)
    }

    fn one(&mut self, kind: &Kind<Arc<Struct>>) -> Result<Value, What> {
        match kind {
            Kind::Scalar(scalar) => self.scalar(*scalar),
            Kind::Text { wide: false, bound } => self.text(*bound),
            Kind::Text { wide: true, bound } => self.wide_text(*bound),
            Kind::Nested(inner) => self.message(inner),
        }
    }

    fn scalar(&mut self, scalar: Scalar) -> Result<Value, What> {
        Ok(match scalar {
            Scalar::Bool => match self.number::<1>()? {
                [0] => Value::Bool(false),
                [1] => Value::Bool(true),
                [other] => {
                    self.at -= 1;
                    return Err(What::NoBool(other));
                }
            },
            Scalar::I8 => i8::from_le_bytes(self.number()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.number()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.number()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.number()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.number()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.number()?).into(),
            Scalar::I64 => i64::from_le_bytes(self.number()?).into(),
            Scalar::U64 => u64::from_le_bytes(self.number()?).into(),
            Scalar::F32 => value::number(f32::from_le_bytes(self.number()?).into()),
            Scalar::F64 => value::number(f64::from_le_bytes(self.number()?)),
        })
    }

    /// A text is followed by a zero, which counts.
    fn text(&mut self, bound: Option<u32>) -> Result<Value, What> {
        let longest = bound.map_or(u32::MAX, |bound| bound.saturating_add(1));
        let length = self.length(longest)?;
        let bytes = self.take(length as usize)?;
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        Ok(match std::str::from_utf8(text) {
            Ok(text) => Value::String(text.to_string()),
            Err(_) => value::bytes(text),
        })
    }

    /// UTF-16, four bytes for each unit, nothing at the end.
    fn wide_text(&mut self, bound: Option<u32>) -> Result<Value, What> {
        let length = self.length(bound.unwrap_or(u32::MAX))? as usize;
        if length > (self.bytes.len() - self.at) / 4 {
            return Err(What::Truncated);
        }
        let unit = |reader: &mut Self| reader.number().map(|unit| u32::from_le_bytes(unit) as u16);
        let units: Result<Vec<u16>, What> = (0..length).map(|_| unit(self)).collect();
        Ok(Value::String(String::from_utf16_lossy(&units?)))
    }

    fn length(&mut self, longest: u32) -> Result<u32, What> {
        let length = u32::from_le_bytes(self.number()?);
        if length > longest {
            self.at -= 4;
            return Err(What::TooLong(length));
        }
        Ok(length)
    }

    /// The bytes of a number, least first, from the next place where one of its size may stand.
    fn number<const N: usize>(&mut self) -> Result<[u8; N], What> {
        self.at = self.at.next_multiple_of(N).min(self.bytes.len());
        let mut number = [0; N];
        number.copy_from_slice(self.take(N)?);
        if self.order == Order::Big {
            number.reverse();
        }
        Ok(number)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], What> {
        let rest = &self.bytes[self.at..];
        let taken = rest.get(..count).ok_or(What::Truncated)?;
        self.at += count;
        Ok(taken)
    }
}
