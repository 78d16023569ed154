//! What each stretch of a text is, for its colour: as the parser cuts it up, and Lua's lexer what is in its blocks.

use std::ops::Range;

use crate::syntax::findings::Findings;
use crate::syntax::keyword::Keyword;
use crate::syntax::lua_tokens::{TokenKind, tokens};
use crate::syntax::pieces::{Piece, PieceKind, pieces};
use crate::syntax::{FileId, Source};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    Comment,
    /// The word a form begins with.
    Form(Keyword),
    /// What is between quotes.
    Text,
    /// The brackets around Lua.
    Bracket,
    LuaKeyword,
}

/// The stretches that are more than plain text, in the order of the text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inked(Vec<(Range<usize>, Ink)>);

impl Inked {
    pub fn of(source: &Source) -> Inked {
        let mut inked = Inked::default();
        if source.name.ends_with(".lua") {
            inked.add_lua(&source.text, 0);
            return inked;
        }
        let mut before = PieceKind::Space;
        for piece in pieces(&source.text, FileId::default(), &mut Findings::default()) {
            inked.add_piece(&source.text, piece, before);
            if !piece.is_trivia() {
                before = piece.kind;
            }
        }
        inked
    }

    /// Those that lie in a range, or reach into it.
    pub fn within(&self, range: Range<usize>) -> impl Iterator<Item = (Range<usize>, Ink)> + '_ {
        let first = self.0.partition_point(|(stretch, _)| stretch.end <= range.start);
        let seen = self.0[first..].iter().take_while(move |(stretch, _)| stretch.start < range.end);
        seen.map(move |(stretch, ink)| (stretch.start.max(range.start)..stretch.end.min(range.end), *ink))
    }

    fn add_piece(&mut self, text: &str, piece: Piece, before: PieceKind) {
        let range = piece.range();
        match piece.kind {
            PieceKind::Comment => self.0.push((range, Ink::Comment)),
            PieceKind::Text | PieceKind::UnclosedText => self.0.push((range, Ink::Text)),
            PieceKind::Word if before == PieceKind::Open => {
                let form = Keyword::of(&text[range.clone()]);
                self.0.extend(form.map(|keyword| (range, Ink::Form(keyword))));
            }
            PieceKind::Block => {
                self.0.push((range.start..range.start + 1, Ink::Bracket));
                self.add_lua(&text[range.start + 1..range.end - 1], range.start + 1);
                self.0.push((range.end - 1..range.end, Ink::Bracket));
            }
            PieceKind::UnclosedBlock => {
                self.0.push((range.start..range.start + 1, Ink::Bracket));
                self.add_lua(&text[range.start + 1..range.end], range.start + 1);
            }
            _ => (),
        }
    }

    fn add_lua(&mut self, code: &str, at: usize) {
        for token in tokens(code) {
            let ink = match token.kind {
                TokenKind::Keyword => Ink::LuaKeyword,
                TokenKind::String | TokenKind::UnclosedString => Ink::Text,
                TokenKind::Comment | TokenKind::UnclosedComment => Ink::Comment,
                _ => continue,
            };
            self.0.push((token.range.start + at..token.range.end + at, ink));
        }
    }
}
