//! Comments for the checks: `; lrp: allow CODE: reason` stands for the next form and all that is in it. Knows nothing of
//! codes.

use super::findings::Findings;
use super::pieces::{Piece, PieceKind, pieces};
use super::source::{FileId, Span};

/// Such a comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Allow {
    /// The words before the reason, with their places: codes, if it is right.
    pub words: Vec<(String, Span)>,
    /// The form that it is about; none where no form follows.
    pub form: Option<Span>,
}

const MARK: &str = "lrp:";
const ALLOW: &str = "allow";
/// What comes before a reason.
const REASON: char = ':';

/// Those of a text whose brackets match, in its order.
pub fn allows(text: &str, file: FileId) -> Vec<Allow> {
    if !text.contains(MARK) {
        return Vec::new();
    }
    let pieces = pieces(text, file, &mut Findings::default());
    let comments = pieces.iter().enumerate().filter(|(_, piece)| piece.kind == PieceKind::Comment);
    comments.filter_map(|(at, comment)| in_comment(text, file, *comment, &pieces[at + 1..])).collect()
}

fn in_comment(text: &str, file: FileId, comment: Piece, after: &[Piece]) -> Option<Allow> {
    let said = text[comment.range()].trim_start_matches(';').trim_start();
    let said = said.strip_prefix(MARK)?.trim_start().strip_prefix(ALLOW)?;
    if !said.starts_with(char::is_whitespace) {
        return None;
    }
    let codes = said.split(REASON).next().unwrap_or(said);
    let start = comment.end as usize - said.len();
    let words = codes.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
    let placed = words.map(|word| {
        let at = start + (word.as_ptr() as usize - codes.as_ptr() as usize);
        (word.to_string(), Span::new(file, at, at + word.len()))
    });
    Some(Allow { words: placed.collect(), form: next_form(file, after) })
}

/// The form that begins first among these pieces, if nothing but space and comments comes before it.
fn next_form(file: FileId, pieces: &[Piece]) -> Option<Span> {
    let start = pieces.iter().position(|piece| !piece.is_trivia())?;
    let mut depth = 0_usize;
    for piece in &pieces[start..] {
        match piece.kind {
            PieceKind::Open => depth += 1,
            PieceKind::Close => depth = depth.checked_sub(1)?,
            _ => {}
        }
        if depth == 0 {
            return (piece.kind == PieceKind::Close)
                .then(|| Span::new(file, pieces[start].start as usize, piece.end as usize));
        }
    }
    None
}
