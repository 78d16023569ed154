//! What a ROS type is: fields with kinds, counts and defaults. Plain data; knows nothing of bytes or networks.

pub mod bundled;
pub mod description;
pub mod parse;
pub mod registry;

use std::sync::Arc;

use lrp_bridge::value;
use serde_json::{Map, Value, json};

pub use registry::Registry;

/// A type as it is written: other types by name, as `geometry_msgs/msg/Vector3`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Definition {
    pub fields: Vec<Field<String>>,
    pub constants: Vec<(String, Value)>,
}

/// A type with all that it is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Struct {
    pub name: String,
    pub fields: Vec<Field<Arc<Struct>>>,
    pub constants: Vec<(String, Value)>,
    /// No message takes fewer bytes, padding aside.
    pub least: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Field<N> {
    pub name: String,
    pub kind: Kind<N>,
    pub count: Count,
    pub default: Option<Value>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Kind<N> {
    Scalar(Scalar),
    /// At most so many bytes, or characters where it is wide.
    Text {
        wide: bool,
        bound: Option<u32>,
    },
    Nested(N),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    Bool,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    One,
    Exactly(u32),
    AtMost(u32),
    Any,
}

impl Scalar {
    /// By its name in a definition.
    pub fn named(name: &str) -> Option<Scalar> {
        Some(match name {
            "bool" | "boolean" => Scalar::Bool,
            "byte" | "char" | "uint8" | "octet" => Scalar::U8,
            "int8" => Scalar::I8,
            "int16" => Scalar::I16,
            "uint16" => Scalar::U16,
            "int32" => Scalar::I32,
            "uint32" => Scalar::U32,
            "int64" => Scalar::I64,
            "uint64" => Scalar::U64,
            "float32" | "float" => Scalar::F32,
            "float64" | "double" => Scalar::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Scalar::Bool | Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::I64 | Scalar::U64 | Scalar::F64 => 8,
        }
    }

    /// The least and greatest whole number; none: it isn't for whole numbers.
    pub fn range(self) -> Option<(i128, i128)> {
        Some(match self {
            Scalar::I8 => (i8::MIN.into(), i8::MAX.into()),
            Scalar::U8 => (0, u8::MAX.into()),
            Scalar::I16 => (i16::MIN.into(), i16::MAX.into()),
            Scalar::U16 => (0, u16::MAX.into()),
            Scalar::I32 => (i32::MIN.into(), i32::MAX.into()),
            Scalar::U32 => (0, u32::MAX.into()),
            Scalar::I64 => (i64::MIN.into(), i64::MAX.into()),
            Scalar::U64 => (0, u64::MAX.into()),
            Scalar::Bool | Scalar::F32 | Scalar::F64 => return None,
        })
    }

    fn zero(self) -> Value {
        match self {
            Scalar::Bool => json!(false),
            Scalar::F32 | Scalar::F64 => json!(0.0),
            _ => json!(0),
        }
    }
}

impl Struct {
    /// A message with every field at its default.
    pub fn blank(&self) -> Value {
        let fields = self.fields.iter().map(|field| (field.name.clone(), field.blank()));
        Value::Object(fields.collect::<Map<_, _>>())
    }

    pub fn field(&self, name: &str) -> Option<&Field<Arc<Struct>>> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// For errors: the names of its fields.
    pub fn field_names(&self) -> String {
        let names: Vec<&str> = self.fields.iter().map(|field| field.name.as_str()).collect();
        if names.is_empty() { "none".to_string() } else { names.join(", ") }
    }
}

impl<N> Field<N> {
    /// Whether Lua sees it as a string of bytes.
    pub fn is_bytes(&self) -> bool {
        matches!(self.kind, Kind::Scalar(Scalar::U8)) && self.count != Count::One
    }
}

impl Field<Arc<Struct>> {
    /// What it is where a message doesn't say.
    pub fn blank(&self) -> Value {
        if let Some(default) = &self.default {
            return default.clone();
        }
        match self.count {
            Count::One => self.kind.blank(),
            Count::Exactly(count) if self.is_bytes() => value::bytes(&vec![0; count as usize]),
            Count::Exactly(count) => Value::Array(vec![self.kind.blank(); count as usize]),
            Count::AtMost(_) | Count::Any if self.is_bytes() => value::bytes(&[]),
            Count::AtMost(_) | Count::Any => json!([]),
        }
    }
}

impl Kind<Arc<Struct>> {
    fn blank(&self) -> Value {
        match self {
            Kind::Scalar(scalar) => scalar.zero(),
            Kind::Text { .. } => json!(""),
            Kind::Nested(inner) => inner.blank(),
        }
    }

    /// No value takes fewer bytes, padding aside.
    pub fn least(&self) -> usize {
        match self {
            Kind::Scalar(scalar) => scalar.size(),
            Kind::Text { .. } => 4,
            Kind::Nested(inner) => inner.least,
        }
    }
}
