//! Lua 5.4 as its lexer sees it: names, numbers, strings, comments, symbols, each with its place. Knows no grammar, and never refuses a text.

use std::borrow::Cow;
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TokenKind {
    Name,
    Keyword,
    /// Also a malformed one, such as `3x`.
    Number,
    /// Short or long, quotes included.
    String,
    /// A short string that meets the end of its line, or a long one that meets the end of the text.
    UnclosedString,
    Symbol,
    Comment,
    /// A long comment that meets the end of the text.
    UnclosedComment,
    /// Characters that Lua has no use for.
    Unknown,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    pub kind: TokenKind,
    /// Bytes of the code the tokens were taken from.
    pub range: Range<usize>,
}

/// The tokens of a piece of Lua, comments included, white space left out.
pub fn tokens(code: &str) -> impl Iterator<Item = Token> + '_ {
    Tokens { code, at: 0 }
}

/// Whether two pieces of Lua are equal but for white space and comments.
pub fn same_code(a: &str, b: &str) -> bool {
    a == b || meaningful(a).eq(meaningful(b))
}

/// What compares equal when two tokens mean the same: Lua reads every kind of line end in a string as a line feed.
fn meaningful(code: &str) -> impl Iterator<Item = (TokenKind, Vec<&str>)> + '_ {
    tokens(code)
        .filter(|token| !matches!(token.kind, TokenKind::Comment | TokenKind::UnclosedComment))
        .map(|token| (token.kind, lines(&code[token.range])))
}

/// The text of a string as Lua reads it, whatever the line ends are.
pub fn with_line_feeds(text: &str) -> Cow<'_, str> {
    match text.contains('\r') {
        true => Cow::Owned(lines(text).join("\n")),
        false => Cow::Borrowed(text),
    }
}

fn lines(text: &str) -> Vec<&str> {
    let mut lines = Vec::with_capacity(1);
    let mut rest = text;
    while let Some(i) = rest.find(['\n', '\r']) {
        lines.push(&rest[..i]);
        rest = &rest[i + line_end(&rest.as_bytes()[i..])..];
    }
    lines.push(rest);
    lines
}

/// The 22 reserved words of Lua 5.4.
pub fn is_keyword(word: &str) -> bool {
    matches!(
        word,
        "and"
            | "break"
            | "do"
            | "else"
            | "elseif"
            | "end"
            | "false"
            | "for"
            | "function"
            | "goto"
            | "if"
            | "in"
            | "local"
            | "nil"
            | "not"
            | "or"
            | "repeat"
            | "return"
            | "then"
            | "true"
            | "until"
            | "while"
    )
}

/// Whether a word has the shape of a Lua name; keywords have it too.
pub fn is_name(word: &str) -> bool {
    let bytes = word.as_bytes();
    bytes.first().is_some_and(|&b| starts_name(b)) && bytes.iter().all(|&b| continues_name(b))
}

fn starts_name(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_'
}

fn continues_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Bytes of the line end these begin with: 2 for CRLF and for LFCR, which Lua counts as one as well.
fn line_end(bytes: &[u8]) -> usize {
    match bytes {
        [b'\r', b'\n', ..] | [b'\n', b'\r', ..] => 2,
        _ => 1,
    }
}

struct Tokens<'a> {
    code: &'a str,
    at: usize,
}

impl Iterator for Tokens<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        self.skip_while(|b| matches!(b, b' ' | b'\t'..=b'\r'));
        let start = self.at;
        let kind = match *self.rest() {
            [] => return None,
            [b'-', b'-', ..] => self.comment(),
            [b'"' | b'\'', ..] => self.short_string(),
            [b'[', b'[' | b'=', ..] => self.long_string(),
            [b'0'..=b'9', ..] | [b'.', b'0'..=b'9', ..] => self.number(),
            [b, ..] if starts_name(b) => self.name(),
            _ => self.symbol(),
        };
        Some(Token { kind, range: start..self.at })
    }
}

impl Tokens<'_> {
    fn rest(&self) -> &[u8] {
        &self.code.as_bytes()[self.at..]
    }

    fn skip_while(&mut self, wanted: impl Fn(u8) -> bool) {
        self.at += self.rest().iter().take_while(|&&b| wanted(b)).count();
    }

    fn name(&mut self) -> TokenKind {
        let start = self.at;
        self.skip_while(continues_name);
        if is_keyword(&self.code[start..self.at]) { TokenKind::Keyword } else { TokenKind::Name }
    }

    fn comment(&mut self) -> TokenKind {
        self.at += 2;
        if let Some(level) = self.long_bracket() {
            return if self.skip_long(level) { TokenKind::Comment } else { TokenKind::UnclosedComment };
        }
        self.skip_while(|b| b != b'\n' && b != b'\r');
        TokenKind::Comment
    }

    fn long_string(&mut self) -> TokenKind {
        match self.long_bracket() {
            Some(level) if self.skip_long(level) => TokenKind::String,
            Some(_) => TokenKind::UnclosedString,
            None => self.symbol(),
        }
    }

    /// The number of `=` where a long bracket opens here.
    fn long_bracket(&self) -> Option<usize> {
        let rest = self.rest().strip_prefix(b"[")?;
        let level = rest.iter().take_while(|&&b| b == b'=').count();
        (rest.get(level) == Some(&b'[')).then_some(level)
    }

    /// Goes behind the long bracket that opens here; true if it is closed.
    fn skip_long(&mut self, level: usize) -> bool {
        self.at += level + 2;
        let closing = format!("]{}]", "=".repeat(level));
        match self.code[self.at..].find(&closing) {
            Some(i) => {
                self.at += i + closing.len();
                true
            }
            None => {
                self.at = self.code.len();
                false
            }
        }
    }

    fn short_string(&mut self) -> TokenKind {
        let quote = self.rest()[0];
        self.at += 1;
        loop {
            match *self.rest() {
                [] | [b'\n' | b'\r', ..] => return TokenKind::UnclosedString,
                [b'\\', ..] => self.escape(),
                [b, ..] => {
                    self.at += 1;
                    if b == quote {
                        return TokenKind::String;
                    }
                }
            }
        }
    }

    fn escape(&mut self) {
        self.at += 1;
        match self.rest() {
            [] => {}
            [b'z', ..] => {
                self.at += 1;
                self.skip_while(|b| matches!(b, b' ' | b'\t'..=b'\r'));
            }
            [b'\n' | b'\r', ..] => self.at += line_end(self.rest()),
            _ => self.skip_char(),
        }
    }

    fn skip_char(&mut self) {
        self.at += self.code[self.at..].chars().next().map_or(0, char::len_utf8);
    }

    /// Takes in what Lua's own lexer would before it converts the number.
    fn number(&mut self) -> TokenKind {
        let hexadecimal = matches!(self.rest(), [b'0', b'x' | b'X', ..]);
        let exponent: &[u8] = if hexadecimal { b"pP" } else { b"eE" };
        loop {
            match *self.rest() {
                [e, b'+' | b'-', ..] if exponent.contains(&e) => self.at += 2,
                [b, ..] if continues_name(b) || b == b'.' => self.at += 1,
                _ => return TokenKind::Number,
            }
        }
    }

    fn symbol(&mut self) -> TokenKind {
        let length = match *self.rest() {
            [b'.', b'.', b'.', ..] => 3,
            [b'=' | b'~' | b'<' | b'>', b'=', ..] => 2,
            [b'.', b'.', ..] | [b':', b':', ..] | [b'/', b'/', ..] | [b'<', b'<', ..] | [b'>', b'>', ..] => 2,
            [b, ..] if b"+-*/%^#&~|<>=(){}[];:,.".contains(&b) => 1,
            _ => {
                self.skip_char();
                return TokenKind::Unknown;
            }
        };
        self.at += length;
        TokenKind::Symbol
    }
}
