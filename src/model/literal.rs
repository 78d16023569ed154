//! Lua literals: what a piece of Lua says that is nothing but one, and how a person would write a value down.
//! Knows nothing of programs.

use std::ops::Range;

use serde_json::{Map, Value};

use super::quoted::{quoted, unquoted};
use crate::syntax::lua_tokens::{Token, TokenKind, is_keyword, is_name, tokens};

/// A literal and where it stands in its piece of Lua.
#[derive(Clone, Debug, PartialEq)]
pub struct Literal {
    /// Bytes; empty where nothing is written, which is nil.
    pub range: Range<usize>,
    pub form: Form,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// nil, a boolean, a number or a string.
    Plain(Value),
    /// Its entries by their keys as records have them, each key once.
    Table(Vec<(String, Literal)>),
}

/// Tables in tables beyond these are not read.
const DEPTH: usize = 16;

impl Literal {
    /// None where the code is anything else; a `return` before it and comments are allowed.
    pub fn read(code: &str) -> Option<Literal> {
        let comment = |token: &Token| matches!(token.kind, TokenKind::Comment | TokenKind::UnclosedComment);
        let tokens: Vec<Token> = tokens(code).filter(|token| !comment(token)).collect();
        let mut reader = Reader { code, tokens: &tokens };
        if tokens.is_empty() {
            return Some(Literal { range: 0..0, form: Form::Plain(Value::Null) });
        }
        reader.take("return");
        let literal = reader.literal(DEPTH)?;
        reader.take(";");
        reader.tokens.is_empty().then_some(literal)
    }

    /// As a record would tell it.
    pub fn value(&self) -> Value {
        let entries = match &self.form {
            Form::Plain(value) => return value.clone(),
            Form::Table(entries) => entries.iter().map(|(key, entry)| (key, entry.value())),
        };
        let entries: Vec<(&String, Value)> = entries.filter(|(_, value)| !value.is_null()).collect();
        let place = |place: usize| entries.iter().find(|(key, _)| **key == place.to_string());
        let items: Option<Vec<Value>> = (1..=entries.len()).map(|at| Some(place(at)?.1.clone())).collect();
        match items {
            Some(items) if !items.is_empty() => Value::Array(items),
            _ => Value::Object(entries.into_iter().map(|(key, value)| (key.clone(), value)).collect::<Map<_, _>>()),
        }
    }
}

struct Reader<'a> {
    code: &'a str,
    tokens: &'a [Token],
}

impl Reader<'_> {
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| &self.code[token.range.clone()])
    }

    fn take(&mut self, text: &str) -> bool {
        let taken = self.text(0) == text;
        if taken {
            self.tokens = &self.tokens[1..];
        }
        taken
    }

    fn literal(&mut self, depth: usize) -> Option<Literal> {
        let first = self.tokens.first()?.clone();
        if self.take("{") {
            return self.table(first.range.start, depth.checked_sub(1)?);
        }
        let negative = self.take("-");
        let token = self.tokens.first()?.clone();
        let text = self.text(0);
        let value = match (token.kind, text) {
            (TokenKind::Number, _) => number(text, negative)?,
            _ if negative => return None,
            (TokenKind::String, _) => Value::String(unquoted(text)?),
            (TokenKind::Keyword, "nil") => Value::Null,
            (TokenKind::Keyword, "true" | "false") => Value::Bool(text == "true"),
            _ => return None,
        };
        self.tokens = &self.tokens[1..];
        Some(Literal { range: first.range.start..token.range.end, form: Form::Plain(value) })
    }

    fn table(&mut self, start: usize, depth: usize) -> Option<Literal> {
        let mut entries: Vec<(String, Literal)> = Vec::new();
        let mut places = 0;
        loop {
            let end = self.tokens.first()?.range.end;
            if self.take("}") {
                return Some(Literal { range: start..end, form: Form::Table(entries) });
            }
            let key = match self.key()? {
                Some(key) => key,
                None => {
                    places += 1;
                    i32::to_string(&places)
                }
            };
            if entries.iter().any(|(known, _)| *known == key) {
                return None;
            }
            entries.push((key, self.literal(depth)?));
            if !self.take(",") && !self.take(";") && self.text(0) != "}" {
                return None;
            }
        }
    }

    /// `name =`, `["name"] =`, `[3] =`; none where an entry has only a place.
    fn key(&mut self) -> Option<Option<String>> {
        if self.text(1) == "=" && is_name(self.text(0)) {
            let name = self.text(0).to_owned();
            self.tokens = &self.tokens[2..];
            return Some(Some(name));
        }
        if !self.take("[") {
            return Some(None);
        }
        let key = match self.literal(0)?.form {
            Form::Plain(Value::String(key)) => key,
            Form::Plain(Value::Number(key)) if key.is_i64() => key.to_string(),
            _ => return None,
        };
        (self.take("]") && self.take("=")).then_some(Some(key))
    }
}

/// As Lua reads it: integers as long as they fit, hexadecimal ones wrapped around.
fn number(text: &str, negative: bool) -> Option<Value> {
    let hexadecimal = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    let whole = match hexadecimal {
        Some(digits) => Some(i64::from_ne_bytes(u64::from_str_radix(digits, 16).ok()?.to_ne_bytes())),
        None => text.parse::<i64>().ok(),
    };
    match whole {
        Some(whole) => Some(if negative { whole.wrapping_neg() } else { whole }.into()),
        None => {
            let number: f64 = text.parse().ok()?;
            serde_json::Number::from_f64(if negative { -number } else { number }).map(Value::Number)
        }
    }
}

/// A value as Lua text that says the same; none for what has no literal: functions and devices, what a record has cut,
/// infinities, bytes that are no text. `like`: the text whose place it takes, for its quotes.
pub fn written(value: &Value, like: &str) -> Option<String> {
    match value {
        Value::Null => Some("nil".into()),
        Value::Bool(yes) => Some(yes.to_string()),
        // It would be read as the negative of a float.
        Value::Number(number) if number.as_i64() == Some(i64::MIN) => None,
        Value::Number(number) => Some(number.to_string()),
        Value::String(text) => quoted(text, if like.starts_with('\'') { '\'' } else { '"' }),
        Value::Array(items) => {
            let items: Option<Vec<String>> = items.iter().map(|item| written(item, "")).collect();
            Some(format!("{{{}}}", items?.join(", ")))
        }
        // What stands for a function, or for what was left out.
        Value::Object(fields) if fields.contains_key("cut") || fields.contains_key("lua") => None,
        Value::Object(fields) => {
            let field = |(key, item): (&String, &Value)| Some(format!("{} = {}", field(key)?, written(item, "")?));
            let fields: Option<Vec<String>> = fields.iter().map(field).collect();
            Some(format!("{{{}}}", fields?.join(", ")))
        }
    }
}

/// Which kind of key a number was, a record doesn't tell.
fn field(key: &str) -> Option<String> {
    match key {
        _ if is_name(key) && !is_keyword(key) => Some(key.into()),
        _ if key.parse::<f64>().is_ok() => None,
        _ => Some(format!("[{}]", quoted(key, '"')?)),
    }
}
