//! Reads a world's text into statements with their places, each line by itself; knows which numbers a statement takes, not what they mean together.

use crate::fault::{Fault, Place, nearest};
use crate::form::{FORMS, Field, Form, Word};

/// One line of the text, understood.
#[derive(Debug)]
pub(crate) struct Statement {
    pub word: Word,
    pub name: &'static str,
    pub place: Place,
    /// One for each field of its form, within the field's limits.
    pub numbers: Vec<Number>,
}

/// A number and where it was written; a default is where its statement is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Number {
    pub value: f64,
    pub place: Place,
}

#[derive(Clone, Copy)]
struct Token<'a> {
    text: &'a str,
    place: Place,
}

/// Every statement that could be read, and the faults of those that couldn't.
pub(crate) fn read(text: &str) -> (Vec<Statement>, Vec<Fault>) {
    let mut statements = Vec::new();
    let mut faults = Vec::new();
    for (index, line) in lines(text).enumerate() {
        let tokens = tokens(line, index + 1);
        let Some((first, rest)) = tokens.split_first() else {
            continue;
        };
        match form_named(*first) {
            Ok(form) => match numbers(form, *first, rest) {
                Ok(numbers) => {
                    statements.push(Statement { word: form.word, name: form.name, place: first.place, numbers });
                }
                Err(fault) => faults.push(fault),
            },
            Err(fault) => faults.push(fault),
        }
    }
    (statements, faults)
}

/// The lines of the text, ended by LF, CRLF or CR.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.trim_start_matches('\u{feff}').split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

fn tokens(line: &str, number: usize) -> Vec<Token<'_>> {
    let code = line.split('#').next().unwrap_or_default();
    let mut tokens = Vec::new();
    let mut start = None;
    for (column, (at, letter)) in code.char_indices().enumerate() {
        match (start, letter.is_whitespace()) {
            (None, false) => start = Some((at, column)),
            (Some((from, first)), true) => {
                tokens.push(token(&code[from..at], number, first));
                start = None;
            }
            _ => {}
        }
    }
    if let Some((from, first)) = start {
        tokens.push(token(&code[from..], number, first));
    }
    tokens
}

fn token(text: &str, line: usize, column: usize) -> Token<'_> {
    Token { text, place: Place { line, column: column + 1 } }
}

fn form_named(token: Token) -> Result<&'static Form, Fault> {
    FORMS.iter().find(|form| form.name == token.text).ok_or_else(|| {
        let fault = token.place.fault(format!("unknown word `{}`", shortened(token.text)));
        match nearest(&token.text.to_lowercase(), FORMS.iter().map(|form| form.name)) {
            Some(name) => fault.with_help(format!("did you mean `{name}`?")),
            None => {
                let known: Vec<_> = FORMS.iter().map(|form| form.name).collect();
                fault.with_help(format!("a line begins with one of: {}", known.join(", ")))
            }
        }
    })
}

/// The numbers of one statement in the order of its fields. A field's name may stand before its number, and must where an earlier one is left out.
fn numbers(form: &Form, first: Token, rest: &[Token]) -> Result<Vec<Number>, Fault> {
    let mut found: Vec<Option<Number>> = vec![None; form.fields.len()];
    let mut tokens = rest.iter().copied();
    while let Some(token) = tokens.next() {
        let named = form.fields.iter().position(|field| field.name == token.text);
        let (index, value) = match named {
            Some(index) => (index, tokens.next().ok_or_else(|| lacks_number(form, token))?),
            None => (next_free(form, &found, token)?, token),
        };
        if found[index].is_some() {
            return Err(token
                .place
                .fault(format!("`{}` is given twice", form.fields[index].name))
                .with_help(usage(form)));
        }
        found[index] = Some(number(form, &form.fields[index], value)?);
    }
    form.fields
        .iter()
        .zip(found)
        .map(|(field, number)| number.map_or_else(|| left_out(form, field, first), Ok))
        .collect()
}

fn next_free(form: &Form, found: &[Option<Number>], token: Token) -> Result<usize, Fault> {
    let last_given = found.iter().rposition(Option::is_some).map_or(0, |index| index + 1);
    if last_given < found.len() {
        return Ok(last_given);
    }
    Err(token
        .place
        .fault(format!("`{}` is one too many for `{}`", shortened(token.text), form.name))
        .with_help(usage(form)))
}

fn number(form: &Form, field: &Field, token: Token) -> Result<Number, Fault> {
    let value: f64 = token.text.parse().map_err(|_| {
        let fault =
            token.place.fault(format!("`{}` is no number, and `{}` needs one", shortened(token.text), field.name));
        match nearest(token.text, form.fields.iter().map(|field| field.name)) {
            Some(name) => fault.with_help(format!("did you mean `{name}`?")),
            None => fault.with_help(usage(form)),
        }
    })?;
    // A nan is in no range, so it is refused here too.
    if !(field.least..=field.most).contains(&value) {
        let message = format!("`{}` can't be {}", field.name, shortened(token.text));
        return Err(token.place.fault(message).with_help(format!("from {} to {}", field.least, field.most)));
    }
    Ok(Number { value, place: token.place })
}

fn left_out(form: &Form, field: &Field, first: Token) -> Result<Number, Fault> {
    match field.default {
        Some(value) => Ok(Number { value, place: first.place }),
        None => Err(first.place.fault(format!("`{}` lacks its `{}`", form.name, field.name)).with_help(usage(form))),
    }
}

fn lacks_number(form: &Form, token: Token) -> Fault {
    token.place.fault(format!("a number must follow `{}`", token.text)).with_help(usage(form))
}

fn usage(form: &Form) -> String {
    format!("write `{}`", form.usage)
}

/// The text, cut where it would fill the screen.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(24) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}
