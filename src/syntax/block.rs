//! Finds where a Lua block ends, by Lua's own lexical rules, and where it was probably meant to end when it isn't closed.
//! Knows nothing of Lua's grammar, nor of what surrounds the block but how its forms begin.

use super::keyword::Keyword;
use super::layout::column;
use super::lua_tokens::{TokenKind, tokens};

/// More brackets inside one another than this are refused, in blocks as in forms.
pub const MAX_DEPTH: usize = 100;

#[derive(Debug, PartialEq, Eq)]
pub enum BlockEnd {
    /// Where its `]` stands.
    Closed(usize),
    /// Where it was probably meant to end, and what swallowed its `]`, if that can be told.
    Open { end: usize, culprit: Option<Culprit> },
    /// Closed or not: nested too deep from this bracket on; `end` is where to go on reading.
    TooDeep { bracket: usize, end: usize },
}

/// What in a block keeps its `]` from being seen: a range of bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Culprit {
    String(std::ops::Range<usize>),
    LongBracket(std::ops::Range<usize>),
    Comment(std::ops::Range<usize>),
}

/// How surely a line belongs to the program around the block.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Evidence {
    /// `(running [x])` is Lua as well.
    Weak,
    /// `(state a` can't be: no two names follow one another in Lua.
    Strong,
}

/// `inside` is the byte after the block's `[`; `indent` the indentation of the form that holds it, in columns.
pub fn end_of_block(text: &str, inside: usize, indent: usize) -> BlockEnd {
    let mut scan = Scan::new(text, inside, indent);
    for token in tokens(&text[inside..]) {
        let range = inside + token.range.start..inside + token.range.end;
        let found = match token.kind {
            TokenKind::Symbol => scan.symbol(range.start),
            TokenKind::UnclosedString if !is_short(text, range.start) => {
                Some(scan.swallowed(range, Culprit::LongBracket))
            }
            TokenKind::UnclosedComment => Some(scan.swallowed(range, Culprit::LongBracket)),
            TokenKind::UnclosedString if closes(&text[range.clone()]) => scan.suspect(Culprit::String(range)),
            TokenKind::Comment if closes(&text[range.clone()]) => scan.suspect(Culprit::Comment(range)),
            _ => None,
        };
        if let Some(end) = found {
            return end;
        }
    }
    scan.open(text.len())
}

fn is_short(text: &str, at: usize) -> bool {
    !text[at..].starts_with('[')
}

/// Whether a string or comment seems to hold a `]` that was meant for the block.
fn closes(text: &str) -> bool {
    text.matches(']').count() > text.matches('[').count()
}

struct Scan<'a> {
    text: &'a str,
    inside: usize,
    indent: usize,
    stack: Vec<u8>,
    /// How many of each kind are on the stack, the block's own left out: round, square, curly.
    round: usize,
    curly: usize,
    /// The first place where the block may have been meant to end.
    candidate: Option<usize>,
    /// A `)` that closes nothing in the block.
    stray: Option<usize>,
    culprit: Option<Culprit>,
    too_deep: Option<usize>,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str, inside: usize, indent: usize) -> Self {
        Scan {
            text,
            inside,
            indent,
            stack: vec![b'['],
            round: 0,
            curly: 0,
            candidate: None,
            stray: None,
            culprit: None,
            too_deep: None,
        }
    }

    fn symbol(&mut self, at: usize) -> Option<BlockEnd> {
        match self.text.as_bytes()[at] {
            b'(' => {
                if let Some(end) = self.form_outside(at) {
                    return Some(end);
                }
                self.push(b'(', at);
            }
            open @ (b'[' | b'{') => self.push(open, at),
            b')' if self.round > 0 => self.pop(b'('),
            b'}' if self.curly > 0 => self.pop(b'{'),
            b')' => {
                self.stray.get_or_insert(at);
                self.candidate.get_or_insert(at);
            }
            b']' => {
                self.pop(b'[');
                if self.stack.is_empty() {
                    return Some(self.closed(at));
                }
            }
            _ => {}
        }
        None
    }

    fn push(&mut self, open: u8, at: usize) {
        self.stack.push(open);
        self.count(open, 1);
        if self.stack.len() > MAX_DEPTH {
            self.too_deep.get_or_insert(at);
        }
    }

    /// Closes the innermost bracket of this kind, and those left open inside it: Lua's compiler has more to say of them.
    fn pop(&mut self, wanted: u8) {
        while let Some(open) = self.stack.pop() {
            self.count(open, -1);
            if open == wanted {
                return;
            }
        }
    }

    fn count(&mut self, open: u8, change: isize) {
        match open {
            b'(' => self.round = self.round.saturating_add_signed(change),
            b'{' => self.curly = self.curly.saturating_add_signed(change),
            _ => {}
        }
    }

    /// A line that begins like a form, not deeper than the form that holds the block, is taken as being outside.
    fn form_outside(&mut self, at: usize) -> Option<BlockEnd> {
        let column = column(self.text, self.inside, at)?;
        if column > self.indent {
            return None;
        }
        let evidence = begins_form(&self.text[at..])?;
        self.candidate.get_or_insert(at);
        (evidence == Evidence::Strong || self.stray.is_some()).then(|| self.open(at))
    }

    /// From here to the text's end everything is in a long string or comment: look for forms in it line by line.
    fn swallowed(&mut self, range: std::ops::Range<usize>, culprit: fn(std::ops::Range<usize>) -> Culprit) -> BlockEnd {
        let opening =
            self.text[range.clone()].match_indices('[').nth(1).map_or(range.end, |(i, _)| range.start + i + 1);

        self.culprit.get_or_insert(culprit(range.start..opening));
        if self.candidate.is_none() {
            self.candidate = self.text[range.clone()]
                .match_indices('(')
                .map(|(i, _)| range.start + i)
                .filter(|&at| begins_form(&self.text[at..]).is_some())
                .find(|&at| column(self.text, range.start, at).is_some_and(|column| column <= self.indent));
        }
        self.open(self.text.len())
    }

    fn suspect(&mut self, culprit: Culprit) -> Option<BlockEnd> {
        if self.candidate.is_none() {
            self.culprit.get_or_insert(culprit);
        }
        None
    }

    fn closed(&self, at: usize) -> BlockEnd {
        match self.too_deep {
            Some(bracket) => BlockEnd::TooDeep { bracket, end: at + 1 },
            None => BlockEnd::Closed(at),
        }
    }

    fn open(&mut self, at: usize) -> BlockEnd {
        let end = self.candidate.unwrap_or(at).min(at);
        let end = self.inside + self.text[self.inside..end].trim_end().len();
        match self.too_deep {
            Some(bracket) => BlockEnd::TooDeep { bracket, end: end.max(bracket + 1) },
            None => BlockEnd::Open { end, culprit: self.culprit.take() },
        }
    }
}

/// What speaks for a form where this text begins, with its `(`.
fn begins_form(text: &str) -> Option<Evidence> {
    let inside = text[1..].trim_start_matches([' ', '\t']);
    let word = first_word(inside);
    Keyword::of(word)?;
    let second = first_word(inside[word.len()..].trim_start());
    Some(if matches!(second, "" | "and" | "or") { Evidence::Weak } else { Evidence::Strong })
}

fn first_word(text: &str) -> &str {
    &text[..text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len())]
}
