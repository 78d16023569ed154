//! What a name may look like, in the language and in Lua, and what to say where it doesn't. Knows nothing of forms.

use super::diagnostic::{Code, Diagnostic};
use super::lua_tokens::{is_keyword, is_name};
use super::source::Span;

/// Names of machines, states, events and the like: letters, digits, `_` and `-`.
pub fn check_name(word: &str, span: Span) -> Result<(), Diagnostic> {
    let reason = match word.chars().find(|&c| !is_name_char(c)) {
        Some(c) => format!("it holds `{c}`"),
        None if word.contains(|c| c != '-') => return Ok(()),
        None => "it has no letter or digit".to_string(),
    };
    let message = format!("`{}` can't be a name: {reason}", shortened(word));
    Err(Diagnostic::error(Code::BadName, span, message).help("use letters, digits, `_` and `-`"))
}

/// Names that blocks see: they must be Lua's.
pub fn check_lua_name(word: &str, span: Span) -> Result<(), Diagnostic> {
    let shown = shortened(word);
    if is_keyword(word) {
        let message = format!("`{shown}` is a keyword of Lua, so blocks couldn't use it as a name");
        return Err(Diagnostic::error(Code::BadName, span, message).help(format!("choose another, such as `{word}_`")));
    }
    if !is_name(word) {
        let message = format!("`{shown}` is no name in Lua, so blocks couldn't use it");
        let help = match suggestion(word) {
            Some(better) => format!("write `{better}`"),
            None => "use the letters a to z, digits and `_`, not beginning with a digit".to_string(),
        };
        return Err(Diagnostic::error(Code::BadName, span, message).help(help));
    }
    Ok(())
}

fn is_name_char(c: char) -> bool {
    // Letters may come with accents that are characters of their own.
    c.is_alphanumeric() || matches!(c, '_' | '-' | '\u{300}'..='\u{36f}')
}

/// The word with what Lua doesn't take replaced, if that makes a name of it.
fn suggestion(word: &str) -> Option<String> {
    let mut better = word.replace(['-', '.'], "_");
    if better.starts_with(|c: char| c.is_ascii_digit()) {
        better.insert(0, '_');
    }
    (is_name(&better) && !is_keyword(&better) && better.contains(|c| c != '_')).then_some(better)
}

/// As much of a word as fits in a message.
pub fn shortened(word: &str) -> String {
    match word.char_indices().nth(40) {
        Some((i, _)) => format!("{}...", &word[..i]),
        None => word.to_string(),
    }
}
