//! Lua's messages: positions, names and wording. Knows nothing of how errors come about.

use super::desk::{Desk, MARK, Spot};

/// A position that begins a message, and the rest.
pub(super) fn split_position(text: &str) -> (Option<Spot>, &str) {
    match position(text) {
        Some((spot, length)) => (Some(spot), text[length..].trim_start()),
        None => (None, text),
    }
}

/// The `MARK chunk:line:` that `text` begins with, and its length.
fn position(text: &str) -> Option<(Spot, usize)> {
    let (chunk, rest) = text.strip_prefix(MARK)?.split_once(':')?;
    let (line, rest) = rest.split_once(':')?;
    let spot = Spot { chunk: chunk.parse().ok()?, line: line.parse().ok()? };
    Some((spot, text.len() - rest.len()))
}

/// The message with the positions in it as users know them, `x.lrp:14:`, and variables called so.
pub(super) fn relocate(text: &str, desk: &Desk) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    let mut last = None;
    while let Some(at) = rest.find(MARK) {
        result.push_str(&rest[..at]);
        // Each wrapped coroutine that an error passes says where it is: in a recursion always the same.
        let again = at <= 1 && rest[..at].trim().is_empty();
        rest = &rest[at..];
        let length = match position(rest) {
            Some((spot, length)) if again && last == Some(spot) => {
                result.truncate(result.trim_end().len());
                length
            }
            Some((spot, length)) => {
                last = Some(spot);
                let (file, line) = desk.place(spot.chunk, spot.line).unwrap_or(("block".to_owned(), spot.line));
                result.push_str(&format!("{file}:{line}:"));
                length
            }
            None => MARK.len_utf8(),
        };
        rest = &rest[length..];
    }
    result.push_str(rest);
    result.replace("(upvalue '", "(variable '")
}

/// What stands before a name in Lua's messages.
const BEFORE_NAME: [&str; 11] = [
    "function '",
    "global '",
    "local '",
    "field '",
    "upvalue '",
    "variable '",
    "method '",
    "constant '",
    "name '",
    "near '",
    "label '",
];

/// The name a message is about, to be looked for in its line.
pub(super) fn token(message: &str) -> Option<String> {
    let after = |before: &&str| message.find(before).map(|at| at + before.len());
    let start = BEFORE_NAME.iter().filter_map(after).min()?;
    let length = message[start..].find('\'')?;
    Some(message[start..start + length].to_owned()).filter(|token| !token.is_empty())
}

/// Adds `by` to the line numbers Lua mentions within its messages: `(to close 'if' at line 12)`.
pub(super) fn move_lines(message: &str, by: u32) -> String {
    let mut result = String::with_capacity(message.len() + 4);
    let mut rest = message;
    while let Some(at) = rest.find(" line ") {
        let (before, after) = rest.split_at(at + " line ".len());
        let digits = after.len() - after.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        result.push_str(before);
        match after[..digits].parse::<u32>() {
            Ok(line) => result.push_str(&line.saturating_add(by).to_string()),
            Err(_) => result.push_str(&after[..digits]),
        }
        rest = &after[digits..];
    }
    result.push_str(rest);
    result
}
