//! Strings between quotes as Lua reads and a person writes them.

use crate::syntax::lua_tokens::with_line_feeds;

/// A record cuts strings longer than about a kilobyte.
const LONGEST: usize = 1000;

/// A string in quotes or long brackets as the text it stands for; none where that is no text.
pub fn unquoted(string: &str) -> Option<String> {
    let inside = ['"', '\''].iter().find_map(|&quote| string.strip_prefix(quote)?.strip_suffix(quote));
    match inside {
        Some(inside) => unescaped(&with_line_feeds(inside)),
        None => long(string),
    }
}

fn long(string: &str) -> Option<String> {
    let level = string.strip_prefix('[')?.find('[')?;
    let inside = with_line_feeds(string.get(level + 2..string.len() - level - 2)?);
    Some(inside.strip_prefix('\n').unwrap_or(&inside).to_owned())
}

fn unescaped(inside: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(inside.len());
    let mut rest = inside;
    while let Some(at) = rest.find('\\') {
        bytes.extend_from_slice(&rest.as_bytes()[..at]);
        rest = escape(&rest[at + 1..], &mut bytes)?;
    }
    bytes.extend_from_slice(rest.as_bytes());
    String::from_utf8(bytes).ok()
}

/// What stands behind a backslash; gives the rest.
fn escape<'a>(text: &'a str, bytes: &mut Vec<u8>) -> Option<&'a str> {
    let first = text.chars().next()?;
    let rest = &text[first.len_utf8()..];
    let byte = match first {
        'a' => 7,
        'b' => 8,
        't' => b'\t',
        'n' | '\n' => b'\n',
        'v' => 11,
        'f' => 12,
        'r' => b'\r',
        '\\' | '"' | '\'' => first as u8,
        'z' => return Some(rest.trim_start_matches([' ', '\t', '\n', '\r', '\x0b', '\x0c'])),
        'x' => {
            bytes.push(u8::from_str_radix(rest.get(..2)?, 16).ok()?);
            return rest.get(2..);
        }
        'u' => {
            let (code, rest) = rest.strip_prefix('{')?.split_once('}')?;
            let c = char::from_u32(u32::from_str_radix(code, 16).ok()?)?;
            bytes.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes());
            return Some(rest);
        }
        '0'..='9' => {
            let digits = text.bytes().take(3).take_while(u8::is_ascii_digit).count();
            bytes.push(text[..digits].parse().ok()?);
            return Some(&text[digits..]);
        }
        _ => return None,
    };
    bytes.push(byte);
    Some(rest)
}

/// A text between quotes. None for what a record has for something else: numbers that JSON has no form for, bytes that
/// are no text, what may have been cut.
pub fn quoted(text: &str, quote: char) -> Option<String> {
    let cut = text.len() > LONGEST && text.ends_with('…');
    if matches!(text, "inf" | "-inf" | "nan") || text.contains('\u{fffd}') || cut {
        return None;
    }
    let mut quoted = String::from(quote);
    for c in text.chars() {
        match c {
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            '\\' => quoted.push_str("\\\\"),
            c if c == quote => quoted.extend(['\\', c]),
            // As such they have no place in a program's text.
            c if c.is_ascii_control() => quoted.push_str(&format!("\\{:03}", c as u32)),
            c if c.is_control() => quoted.push_str(&format!("\\u{{{:x}}}", c as u32)),
            c => quoted.push(c),
        }
    }
    quoted.push(quote);
    Some(quoted)
}
