//! What JSON has no word for: bytes, and numbers that are none or endless. A table `{"lua": ..}` stands for each.

use serde_json::{Value, json};

/// Bytes, which Lua sees as a string.
pub fn bytes(bytes: &[u8]) -> Value {
    json!({ "lua": "bytes", "base64": encode(bytes) })
}

/// A number, also nan and the infinities.
pub fn number(number: f64) -> Value {
    match number {
        _ if number.is_nan() => json!({ "lua": "nan" }),
        f64::INFINITY => json!({ "lua": "inf" }),
        f64::NEG_INFINITY => json!({ "lua": "-inf" }),
        _ => json!(number),
    }
}

/// The number that a value stands for.
pub fn as_number(value: &Value) -> Option<f64> {
    match value.get("lua").and_then(Value::as_str) {
        Some("nan") => Some(f64::NAN),
        Some("inf") => Some(f64::INFINITY),
        Some("-inf") => Some(f64::NEG_INFINITY),
        _ => value.as_f64(),
    }
}

/// The bytes that a value stands for: a string's own, or those of a table for bytes.
pub fn as_bytes(value: &Value) -> Option<Vec<u8>> {
    match value {
        Value::String(text) => Some(text.as_bytes().to_vec()),
        Value::Object(table) if table.get("lua").and_then(Value::as_str) == Some("bytes") => {
            decode(table.get("base64")?.as_str()?)
        }
        _ => None,
    }
}

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let group = chunk.iter().fold(0u32, |group, &byte| group << 8 | u32::from(byte)) << (8 * (3 - chunk.len()));
        for digit in 0..4 {
            let value = (group >> (18 - 6 * digit)) as usize & 63;
            text.push(if digit <= chunk.len() { DIGITS[value] as char } else { '=' });
        }
    }
    text
}

fn decode(text: &str) -> Option<Vec<u8>> {
    let digits = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(digits.len() * 3 / 4);
    for chunk in digits.chunks(4) {
        let mut group = 0u32;
        for &digit in chunk {
            group = group << 6 | value_of(digit)?;
        }
        group <<= 6 * (4 - chunk.len());
        bytes.extend(&group.to_be_bytes()[1..chunk.len()]);
    }
    Some(bytes)
}

fn value_of(digit: u8) -> Option<u32> {
    Some(u32::from(match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    }))
}
