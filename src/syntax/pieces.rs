//! Cuts a text into words, brackets, arrows, strings, blocks, comments and what lies between, so that every byte belongs to exactly one piece.
//! Knows nothing of forms, but that a block belongs to the bracket before it.

use super::block::{BlockEnd, Culprit, end_of_block};
use super::diagnostic::{Code, Diagnostic};
use super::findings::Findings;
use super::keyword::Keyword;
use super::layout::column;
use super::source::{FileId, Span};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceKind {
    Space,
    Comment,
    Open,
    Close,
    /// A name, a number, or something that should have been one.
    Word,
    Star,
    Arrow,
    Assign,
    /// A single character that no form has a use for.
    Other,
    /// Between quotes, quotes included.
    Text,
    UnclosedText,
    /// Lua between square brackets, brackets included.
    Block,
    UnclosedBlock,
    /// Already reported, and of no meaning.
    Junk,
    /// What follows the last diagnostic there is room for.
    Unread,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    pub kind: PieceKind,
    pub start: u32,
    pub end: u32,
    /// Of the line it begins in, in columns.
    pub indent: u32,
    /// Whether it is the first in its line but for white space.
    pub begins_line: bool,
}

impl Piece {
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }

    pub fn is_trivia(self) -> bool {
        matches!(self.kind, PieceKind::Space | PieceKind::Comment | PieceKind::Junk | PieceKind::Unread)
    }
}

/// Cuts up the whole text; what is wrong with single pieces is added to the findings.
pub fn pieces(text: &str, file: FileId, findings: &mut Findings) -> Vec<Piece> {
    let mut cutter = Cutter { text, file, at: 0, pieces: Vec::new(), indent: 0, fresh_line: true, open: Vec::new() };
    while cutter.at < text.len() {
        let start = cutter.at;
        let kind = if findings.is_full() { cutter.give_up() } else { cutter.cut(findings) };
        cutter.push(kind, start);
    }
    cutter.pieces
}

/// What to say of a text with control characters in it: it is hardly a program, and nothing more is said of it.
pub fn control_characters(text: &str, file: FileId) -> Option<Diagnostic> {
    let mut controls = text.char_indices().filter(|&(_, c)| is_control(c));
    let (at, first) = controls.next()?;
    let more = match controls.count() {
        0 => String::new(),
        1 => ", and another one further on".to_string(),
        n => format!(", and {n} more further on"),
    };
    let span = Span::new(file, at, at + first.len_utf8());
    let name = if first == '\0' { "NUL byte".to_string() } else { format!("control character U+{:04X}", first as u32) };
    let error = Diagnostic::error(Code::StrayCharacter, span, format!("a {name} stands here{more}"));
    Some(error.help("a program is plain text: remove it, or check that this is the right file"))
}

fn is_control(c: char) -> bool {
    c.is_control() && !c.is_whitespace()
}

/// Characters that show nothing, but would make two names differ.
fn is_invisible(c: char) -> bool {
    matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2064}' | '\u{feff}')
}

/// Typographic quotes and arrows, that word processors put in.
fn is_typography(c: char) -> bool {
    matches!(c, '\u{2018}'..='\u{201f}' | '«' | '»' | '\u{2190}'..='\u{21ff}' | '\u{27f5}'..='\u{27ff}')
}

fn is_word(c: char) -> bool {
    match c {
        '_' | '-' | '.' => true,
        _ if c.is_ascii() => c.is_ascii_alphanumeric(),
        _ => !(c.is_whitespace() || c.is_control() || is_invisible(c) || is_typography(c)),
    }
}

struct Cutter<'a> {
    text: &'a str,
    file: FileId,
    at: usize,
    pieces: Vec<Piece>,
    indent: u32,
    fresh_line: bool,
    /// The indentation of each round bracket that is open.
    open: Vec<u32>,
}

impl Cutter<'_> {
    fn push(&mut self, kind: PieceKind, start: usize) {
        let begins_line = self.fresh_line && kind != PieceKind::Space;
        self.pieces.push(Piece { kind, start: start as u32, end: self.at as u32, indent: self.indent, begins_line });
        match kind {
            PieceKind::Space => self.after_space(start),
            PieceKind::Open => self.open.push(self.indent),
            PieceKind::Close => drop(self.open.pop()),
            _ => {}
        }
        if kind != PieceKind::Space {
            self.fresh_line = false;
        }
    }

    fn after_space(&mut self, start: usize) {
        if let Some(column) = column(self.text, start, self.at) {
            self.indent = column as u32;
            self.fresh_line = true;
        }
    }

    fn give_up(&mut self) -> PieceKind {
        self.at = self.text.len();
        PieceKind::Unread
    }

    fn cut(&mut self, findings: &mut Findings) -> PieceKind {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else {
            return PieceKind::Space;
        };
        match first {
            _ if first.is_whitespace() || (first == '\u{feff}' && self.at == 0) => {
                self.at += first.len_utf8();
                self.skip_while(char::is_whitespace);
                PieceKind::Space
            }
            ';' => {
                self.skip_while(|c| c != '\n' && c != '\r');
                PieceKind::Comment
            }
            '(' => self.take(1, PieceKind::Open),
            ')' => self.take(1, PieceKind::Close),
            '*' => self.take(1, PieceKind::Star),
            '[' => self.block(findings),
            ']' => self.stray_bracket(findings),
            '"' | '\'' => self.quoted(first, findings),
            _ if rest.starts_with("->") => self.take(2, PieceKind::Arrow),
            _ if rest.starts_with(":=") => self.take(2, PieceKind::Assign),
            _ if is_word(first) => self.word(),
            _ if is_control(first) => {
                self.skip_while(is_control);
                PieceKind::Junk
            }
            _ if is_invisible(first) => self.invisible(first, findings),
            _ => self.take(first.len_utf8(), PieceKind::Other),
        }
    }

    fn take(&mut self, bytes: usize, kind: PieceKind) -> PieceKind {
        self.at += bytes;
        kind
    }

    fn skip_while(&mut self, wanted: impl Fn(char) -> bool) {
        let rest = &self.text[self.at..];
        self.at += rest.find(|c| !wanted(c)).unwrap_or(rest.len());
    }

    fn word(&mut self) -> PieceKind {
        let rest = &self.text[self.at..];
        let end = rest.char_indices().find(|&(i, c)| !is_word(c) || rest[i..].starts_with("->"));
        self.at += end.map_or(rest.len(), |(i, _)| i);
        PieceKind::Word
    }

    fn invisible(&mut self, first: char, findings: &mut Findings) -> PieceKind {
        let start = self.at;
        self.skip_while(is_invisible);
        let message = format!("an invisible character stands here (U+{:04X})", first as u32);
        findings.add(
            Diagnostic::error(Code::StrayCharacter, self.span(start, self.at), message)
                .help("remove it: it often comes along when text is copied from a web page"),
        );
        PieceKind::Junk
    }

    fn stray_bracket(&mut self, findings: &mut Findings) -> PieceKind {
        let start = self.at;
        self.skip_while(|c| c == ']');
        findings.add(
            Diagnostic::error(Code::StrayBracket, self.span(start, self.at), "this `]` closes nothing")
                .help("remove it, or add the `[` where the block begins"),
        );
        PieceKind::Junk
    }

    fn quoted(&mut self, quote: char, findings: &mut Findings) -> PieceKind {
        let start = self.at;
        let rest = &self.text[start + 1..];
        let end = rest.find(['\n', '\r', ';', quote]).unwrap_or(rest.len());
        if rest[end..].starts_with(quote) {
            return self.take(end + 2, PieceKind::Text);
        }
        let line = &rest[..end];
        let other = if quote == '"' { '\'' } else { '"' };
        let (length, help) = match line.find(other) {
            Some(i) => (i + 1, format!("it begins with `{quote}`, so end it with `{quote}` too")),
            None => (
                line[..line.find(')').unwrap_or(line.len())].trim_end().len(),
                self.where_to_close(quote, &rest[end..]),
            ),
        };
        self.at += 1 + length;
        findings.add(
            Diagnostic::error(Code::UnclosedString, self.span(start, self.at), "this string is not closed").help(help),
        );
        PieceKind::UnclosedText
    }

    fn where_to_close(&self, quote: char, after: &str) -> String {
        let last = self.pieces.iter().rev().find(|piece| !piece.is_trivia());
        if last.is_none_or(|piece| &self.text[piece.range()] != Keyword::Import.name()) {
            return format!("only a file's name after `import` has quotes: remove `{quote}`");
        }
        let reason = if after.starts_with(';') { "`;` begins a comment" } else { "it can't go on in the next line" };
        format!("add `{quote}` where the string ends: {reason}")
    }

    fn block(&mut self, findings: &mut Findings) -> PieceKind {
        let start = self.at;
        let indent = self.open.last().copied().unwrap_or(self.indent);
        match end_of_block(self.text, start + 1, indent as usize) {
            BlockEnd::Closed(bracket) => {
                self.at = bracket + 1;
                PieceKind::Block
            }
            BlockEnd::Open { end, culprit } => {
                self.at = end;
                findings.add(self.unclosed_block(start, culprit));
                PieceKind::UnclosedBlock
            }
            BlockEnd::TooDeep { bracket, end } => {
                self.at = end;
                findings.add(too_deep(self.span(bracket, bracket + 1)));
                PieceKind::UnclosedBlock
            }
        }
    }

    fn unclosed_block(&self, start: usize, culprit: Option<Culprit>) -> Diagnostic {
        let end = self.at;
        let error = Diagnostic::error(Code::UnclosedBlock, self.span(start, start + 1), "this block is not closed");
        match culprit {
            Some(Culprit::String(range)) => error
                .also(self.span(range.start, range.end), "this string is not closed, and takes in the `]`")
                .help("close the string with the quote it begins with"),
            Some(Culprit::LongBracket(range)) => error
                .also(self.span(range.start, range.end), "what begins here is not closed")
                .help("close the long string or comment with `]]`, or with as many `=` between as it begins with"),
            Some(Culprit::Comment(range)) => error
                .also(self.span(range.start, range.end), "this comment takes in the `]`")
                .help("a comment in Lua ends with its line: put the `]` in the next one"),
            None => error.also(self.span(end, end), "it probably ends here").help("add `]` where the block ends"),
        }
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }
}

pub fn too_deep(span: Span) -> Diagnostic {
    let message = format!("brackets are nested more than {} deep", super::block::MAX_DEPTH);
    Diagnostic::error(Code::NestedTooDeep, span, message).help("take it apart, or check that this is the right file")
}
