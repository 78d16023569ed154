//! What holds for every text whatever, program or not: it is read without a panic, every byte has its place, every span
//! lies in its form.

use lrp::syntax::findings::Findings;
use lrp::syntax::pieces::pieces;
use lrp::syntax::render::{Style, one_line, render};
use lrp::syntax::{FileId, Source, Span, parse};

use super::spans::pairs;

pub fn check(text: &str) {
    let source = Source::new("a.lrp", text);
    let parsed = parse(&source, FileId(0));
    let whole = Span::new(FileId(0), 0, text.len());
    let inside = |span: Span| span.start <= span.end && text.get(span.range()).is_some();
    for (outer, inner) in pairs(&parsed.tree, whole) {
        assert!(inside(inner), "{inner:?} in {text:?}");
        assert!(outer.start <= inner.start && inner.end <= outer.end, "{inner:?} in {outer:?} of {text:?}");
    }
    for diagnostic in &parsed.diagnostics {
        let also = diagnostic.also.iter().map(|(span, _)| *span);
        for span in std::iter::once(diagnostic.span).chain(also) {
            assert!(inside(span), "{diagnostic:?} in {text:?}");
        }
        assert!(!diagnostic.message.contains('\n'), "{diagnostic:?}");
        one_line(diagnostic, std::slice::from_ref(&source));
    }
    assert!(parsed.diagnostics.len() <= 50);
    assert!(parsed.diagnostics.is_sorted_by_key(|diagnostic| diagnostic.span.start));
    render(&parsed.diagnostics, &[source], Style::Plain);
    tiles(text);
}

/// Every byte belongs to exactly one piece.
fn tiles(text: &str) {
    let mut at = 0;
    for piece in pieces(text, FileId(0), &mut Findings::default()) {
        assert_eq!(piece.start as usize, at, "{text:?}");
        assert!(piece.end > piece.start && text.get(piece.range()).is_some(), "{piece:?} of {text:?}");
        at = piece.end as usize;
    }
    assert_eq!(at, text.len(), "{text:?}");
}
