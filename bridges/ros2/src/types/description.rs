//! Definitions out of type descriptions: what a node answers that is asked for a type (`get_type_description`), and what
//! the JSON files of an installed ROS contain.

use serde_json::Value;

use super::{Count, Definition, Field, Kind, Scalar, parse};

/// A type without fields has this one in a description.
const NO_FIELDS: &str = "structure_needs_at_least_one_member";

/// The types in a `type_description_interfaces/msg/TypeDescription`.
pub fn definitions(description: &Value) -> Result<Vec<(String, Definition)>, String> {
    let own = description.get("type_description").ok_or("a description without a type")?;
    let others = description.get("referenced_type_descriptions").and_then(Value::as_array);
    std::iter::once(own).chain(others.into_iter().flatten()).map(definition).collect()
}

fn definition(described: &Value) -> Result<(String, Definition), String> {
    let name = text(described, "type_name")?;
    let mut definition = Definition::default();
    for described in described.get("fields").and_then(Value::as_array).into_iter().flatten() {
        let field = field(described).map_err(|what| format!("{name}: {what}"))?;
        if field.name != NO_FIELDS {
            definition.fields.push(field);
        }
    }
    Ok((name.to_string(), definition))
}

fn field(described: &Value) -> Result<Field<String>, String> {
    let name = text(described, "name")?;
    let kind = described.get("type").ok_or("a field without a type")?;
    let number = |key| kind.get(key).and_then(Value::as_u64).and_then(|number| u32::try_from(number).ok());
    let id = number("type_id").ok_or("a field without a type")?;
    let capacity = number("capacity").unwrap_or(0);
    // The same kinds again as arrays, bounded sequences and sequences.
    let count = match id / 48 {
        0 => Count::One,
        1 => Count::Exactly(capacity),
        2 => Count::AtMost(capacity),
        _ => Count::Any,
    };
    let scalar = match id % 48 {
        1 => None,
        2 => Some(Scalar::I8),
        3 | 13 | 16 => Some(Scalar::U8),
        4 => Some(Scalar::I16),
        5 => Some(Scalar::U16),
        6 => Some(Scalar::I32),
        7 => Some(Scalar::U32),
        8 => Some(Scalar::I64),
        9 => Some(Scalar::U64),
        10 => Some(Scalar::F32),
        11 => Some(Scalar::F64),
        15 => Some(Scalar::Bool),
        17 | 18 | 21 | 22 => None,
        other => return Err(format!("`{name}` is of a kind ({other}) that can't be read here")),
    };
    let kind = match (scalar, id % 48) {
        (Some(scalar), _) => Kind::Scalar(scalar),
        (None, 1) => Kind::Nested(text(kind, "nested_type_name")?.to_string()),
        (None, id) => {
            let bound = number("string_capacity").filter(|_| id > 20);
            Kind::Text { wide: id == 18 || id == 22, bound }
        }
    };
    let mut field = Field { name: name.to_string(), kind, count, default: None };
    if let Some(default) = described.get("default_value").and_then(Value::as_str).filter(|text| !text.is_empty()) {
        field.default = parse::default(default, &field);
    }
    Ok(field)
}

fn text<'a>(described: &'a Value, key: &str) -> Result<&'a str, String> {
    described.get(key).and_then(Value::as_str).ok_or_else(|| format!("a description without `{key}`"))
}
