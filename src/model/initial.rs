//! The initial value of a variable as the text has it, and the text with another one: only that literal changes.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use serde_json::Value;

use super::ids::VarId;
use super::literal::{Form, Literal, written};
use super::program::Program;
use crate::syntax::FileId;

/// Why a value can't be written into a text as a variable's initial value; what is said of the variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unwritable {
    /// The text reads otherwise than the program's where the initial value is.
    Changed,
    /// What it begins with is worked out by this code.
    NotLiteral(String),
    /// A function, a device, what is too long to be told whole.
    NoText,
    /// The table in the text has other entries.
    OtherEntries,
    /// The text says so already.
    Same,
}

impl fmt::Display for Unwritable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unwritable::Changed => f.write_str("reads otherwise in the file by now"),
            Unwritable::NotLiteral(code) => {
                write!(f, "begins with `{code}`, which is no literal: change it in the editor")
            }
            Unwritable::NoText => f.write_str("holds what can't be written as a literal"),
            Unwritable::OtherEntries => {
                f.write_str("has other entries than the table in the text: change it in the editor")
            }
            Unwritable::Same => f.write_str("begins with this value already"),
        }
    }
}

/// What a variable begins with, where that is a literal.
pub fn initial(program: &Program, var: VarId) -> Option<Value> {
    let span = program[program[var].init].span;
    Literal::read(program.source(span).slice(span)).map(|literal| literal.value())
}

/// The text of a variable's file with its initial value changed to `value`. Before the place of its initial value the text
/// must be the program's own; behind it, it may have been changed in the same way.
pub fn with_initial(program: &Program, text: &str, var: VarId, value: &Value) -> Result<String, Unwritable> {
    let span = program[program[var].init].span;
    let code = program.source(span).slice(span);
    if text.get(span.range()) != Some(code) {
        return Err(Unwritable::Changed);
    }
    let literal = Literal::read(code).ok_or_else(|| Unwritable::NotLiteral(one_line(code)))?;
    let mut changes = Vec::new();
    collect(&literal, code, value, &mut changes)?;
    if changes.is_empty() {
        return Err(Unwritable::Same);
    }
    let mut new = code.to_owned();
    changes.sort_by_key(|(range, _)| range.start);
    for (range, literal) in changes.into_iter().rev() {
        let glued = new[..range.start].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        new.replace_range(range, &if glued { format!(" {literal}") } else { literal });
    }
    match Literal::read(&new) {
        Some(literal) if literal.value() == *value => {
            Ok(format!("{}{new}{}", &text[..span.start as usize], &text[span.end as usize..]))
        }
        _ => Err(Unwritable::NoText),
    }
}

/// The texts of the files in which initial values change, and the variables for which that can't be.
pub fn with_initials(
    program: &Program,
    values: &[(VarId, Value)],
) -> (BTreeMap<FileId, String>, Vec<(VarId, Unwritable)>) {
    let (mut texts, mut refused): (BTreeMap<FileId, String>, _) = (BTreeMap::new(), Vec::new());
    let mut values: Vec<&(VarId, Value)> = values.iter().collect();
    // From the end, so that the places before are still where the program has them.
    values.sort_by_key(|(var, _)| Reverse(program[program[*var].init].span));
    for (var, value) in values {
        let span = program[program[*var].init].span;
        let text = texts.get(&span.file).map_or(&*program.source(span).text, |text| text);
        match with_initial(program, text, *var, value) {
            Ok(new) => _ = texts.insert(span.file, new),
            Err(why) => refused.push((*var, why)),
        }
    }
    (texts, refused)
}

/// The literals that have to change, and what they are to be.
fn collect(
    literal: &Literal,
    code: &str,
    value: &Value,
    changes: &mut Vec<(Range<usize>, String)>,
) -> Result<(), Unwritable> {
    if literal.value() == *value {
        return Ok(());
    }
    match (&literal.form, value) {
        (Form::Plain(_), _) => {
            let text = written(value, &code[literal.range.clone()]).ok_or(Unwritable::NoText)?;
            changes.push((literal.range.clone(), text));
            Ok(())
        }
        (Form::Table(entries), Value::Array(items)) if entries.len() == items.len() => {
            entries.iter().try_for_each(|(key, entry)| {
                let place = key.parse::<usize>().ok().and_then(|place| place.checked_sub(1));
                let item = place.and_then(|place| items.get(place)).ok_or(Unwritable::OtherEntries)?;
                collect(entry, code, item, changes)
            })
        }
        (Form::Table(entries), Value::Object(fields)) if entries.len() == fields.len() => {
            entries.iter().try_for_each(|(key, entry)| {
                collect(entry, code, fields.get(key).ok_or(Unwritable::OtherEntries)?, changes)
            })
        }
        (Form::Table(_), _) => Err(Unwritable::OtherEntries),
    }
}

/// Columns of a code that is named in a sentence.
const SHORT: usize = 30;

fn one_line(code: &str) -> String {
    let words = code.split_whitespace().collect::<Vec<_>>().join(" ");
    match words.char_indices().nth(SHORT) {
        Some((end, _)) => format!("{}…", &words[..end]),
        None => words,
    }
}
