//! The text of a program with one more setting in a robot's form: only what is added changes.

use super::literal::{Form, Literal};
use super::program::{Bridge, Program};
use crate::syntax::FileId;
use crate::syntax::lua_tokens::{Token, TokenKind, tokens};

/// Where a setting belongs, and what it is: `subscribe.odom` and `"/odom"`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    pub key: String,
    /// A Lua literal.
    pub value: String,
}

impl Setting {
    /// From `subscribe.odom = "/odom"`; else what is wrong with it.
    pub fn read(text: &str) -> Result<Setting, String> {
        let (key, value) = text.split_once('=').ok_or("a setting is written `key = value`")?;
        let (key, value) = (key.trim(), value.trim());
        let is_name = |part: &str| {
            part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
                && part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        };
        if !key.split('.').all(is_name) || key.split('.').count() > 2 {
            return Err(format!("`{key}` can't be a setting: write `key = value` or `table.key = value`"));
        }
        match Literal::read(value) {
            Some(literal) if !literal.range.is_empty() => Ok(Setting { key: key.into(), value: value.into() }),
            _ => Err(format!("`{value}` is no Lua literal, as \"/odom\" or 500 are")),
        }
    }
}

/// The text of the form's file with the setting in it; else why that can't be.
pub fn with_setting(program: &Program, robot: &str, setting: &Setting) -> Result<(FileId, String), String> {
    let bridge = program.bridges.iter().find(|bridge| &*bridge.name == robot);
    let bridge = bridge.filter(|bridge| bridge.span.start < bridge.span.end);
    let bridge = bridge.ok_or_else(|| format!("the text has no form `(bridge {robot} ..)` to write it into"))?;
    let text = &program.source(bridge.span).text;
    let form = program.source(bridge.span).slice(bridge.span);
    let new = in_form(bridge, form, setting)?;
    let (before, after) = (&text[..bridge.span.start as usize], &text[bridge.span.end as usize..]);
    Ok((bridge.span.file, format!("{before}{new}{after}")))
}

fn in_form(bridge: &Bridge, form: &str, Setting { key, value }: &Setting) -> Result<String, String> {
    let (outer, inner) = match key.split_once('.') {
        Some((outer, inner)) => (outer, Some(inner)),
        None => (key.as_str(), None),
    };
    let entry = match inner {
        Some(inner) => format!("{outer} = {{ {inner} = {value} }}"),
        None => format!("{outer} = {value}"),
    };
    let unreadable = || format!("the configuration of `{}` is no plain table: change it in the editor", bridge.name);
    let (Some(open), Some(close)) = (form.find('['), form.rfind(']')) else {
        let end = form.rfind(')').ok_or_else(unreadable)?;
        return Ok(format!("{} [ {entry} ]{}", form[..end].trim_end(), &form[end..]));
    };
    // As a table, whose braces are where the brackets were.
    let table = format!("{{{}}}", &form[open + 1..close]);
    let literal = Literal::read(&table).ok_or_else(unreadable)?;
    let Form::Table(entries) = &literal.form else { return Err(unreadable()) };
    let known = entries.iter().find(|(known, _)| known == outer);
    let new = match (known, inner) {
        (None, _) => appended(&table, literal.range.end - 1, &entry),
        (Some((_, Literal { range, form: Form::Table(within) })), Some(inner)) => {
            if within.iter().any(|(known, _)| known == inner) {
                return Err(format!("`{key}` is set already: change it in the editor"));
            }
            appended(&table, range.end - 1, &format!("{inner} = {value}"))
        }
        (Some(_), _) => return Err(format!("`{outer}` is set already: change it in the editor")),
    };
    Ok(format!("{}[{}]{}", &form[..open], &new[1..new.len() - 1], &form[close + 1..]))
}

/// With one more entry before the brace that ends a table; comments behind the last entry stay with it.
fn appended(table: &str, brace: usize, entry: &str) -> String {
    let comment = |token: &Token| matches!(token.kind, TokenKind::Comment | TokenKind::UnclosedComment);
    let last = tokens(&table[..brace]).filter(|token| !comment(token)).last().map_or(0, |token| token.range.end);
    let comma = if table[..last].ends_with(['{', ',', ';']) { "" } else { "," };
    let filled = table[..brace].trim_end();
    let (behind, blank) = (&table[last..filled.len()], &table[filled.len()..brace]);
    let gap = match blank.contains('\n') || !behind.is_empty() {
        true => format!("\n{}", indent_of(filled)),
        false => " ".to_string(),
    };
    let blank = if blank.is_empty() { " " } else { blank };
    format!("{}{comma}{behind}{gap}{entry}{blank}{}", &table[..last], &table[brace..])
}

/// The blanks before the last line.
fn indent_of(text: &str) -> String {
    let line = text.rsplit('\n').next().unwrap_or_default();
    line.chars().take_while(|c| c.is_whitespace()).collect()
}
