//! Comments for the checks: `; lrp: allow CODE` stands for the next form and all that is in it. Knows nothing of codes.

use super::findings::Findings;
use super::pieces::{Piece, PieceKind, pieces};
use super::source::{FileId, Span};

/// One code in such a comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Allow {
    pub code: String,
    /// Where the code stands.
    pub span: Span,
    /// The form that it is about; none where no form follows.
    pub form: Option<Span>,
}

const MARK: &str = "lrp:";
const ALLOW: &str = "allow";

/// Those of a text whose brackets match, in its order.
pub fn allows(text: &str, file: FileId) -> Vec<Allow> {
    if !text.contains(MARK) {
        return Vec::new();
    }
    let pieces = pieces(text, file, &mut Findings::default());
    let comments = pieces.iter().enumerate().filter(|(_, piece)| piece.kind == PieceKind::Comment);
    comments.flat_map(|(at, comment)| in_comment(text, file, *comment, &pieces[at + 1..])).collect()
}

fn in_comment(text: &str, file: FileId, comment: Piece, after: &[Piece]) -> Vec<Allow> {
    let said = text[comment.range()].trim_start_matches(';').trim_start();
    let codes = said.strip_prefix(MARK).map(str::trim_start).and_then(|said| said.strip_prefix(ALLOW));
    let Some(codes) = codes.filter(|codes| codes.starts_with(char::is_whitespace)) else { return Vec::new() };
    let form = next_form(file, after);
    let start = comment.end as usize - codes.len();
    let mut found = Vec::new();
    for code in codes.split(|c: char| c.is_whitespace() || c == ',').filter(|code| !code.is_empty()) {
        let at = start + (code.as_ptr() as usize - codes.as_ptr() as usize);
        found.push(Allow { code: code.to_string(), span: Span::new(file, at, at + code.len()), form });
    }
    found
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
