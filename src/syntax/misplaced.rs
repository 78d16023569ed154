//! What to say of things that stand where they can't: unknown forms, forms in the wrong place, words outside of any form. Knows where forms may stand.

use super::diagnostic::{Code, Diagnostic};
use super::form::Text;
use super::keyword::{Keyword, Place};
use super::names::shortened;
use super::nearest::nearest;
use super::pieces::PieceKind;
use super::reader::{Group, Node};

/// A known form in the wrong place.
pub fn misplaced(text: Text, keyword: Keyword, group: &Group, parent: &Group, place: Place) -> Diagnostic {
    let message = format!("{} can't stand {place}", keyword.with_article());
    let error = Diagnostic::error(Code::MisplacedForm, text.head(group), message).help(belongs(keyword, place));
    if place != Place::Top && group.begins_line && group.indent <= parent.indent {
        return error.also(text.head(parent), "is this closed too late?");
    }
    error
}

fn belongs(keyword: Keyword, place: Place) -> String {
    let places: Vec<String> = keyword.places().iter().map(Place::to_string).collect();
    match (keyword, place) {
        (Keyword::Spawn, Place::State) => "write `(onentry (spawn MACHINE STATE))`".to_string(),
        (Keyword::On | Keyword::Eps | Keyword::Ontime | Keyword::Exit, Place::State) => {
            "it belongs in the machine, beside the state".to_string()
        }
        (Keyword::Break, _) => {
            "it belongs in a state, or at the end of a transition: `(on EVENT SOURCE -> TARGET (break))`".to_string()
        }
        _ => format!("it belongs {}", places.join(" or ")),
    }
}

/// A form that begins with a word no form begins with, and the form that was probably meant.
pub fn unknown(text: Text, first: &Node, place: Place) -> (Diagnostic, Option<Keyword>) {
    let word = text.of(first);
    let here = Keyword::ALL.iter().filter(|keyword| keyword.may_stand(place)).map(|keyword| keyword.name());
    let all = Keyword::ALL.iter().map(|keyword| keyword.name());
    let guess = nearest(word, here).or_else(|| nearest(word, all)).and_then(Keyword::of);
    let error =
        Diagnostic::error(Code::UnknownForm, first.span(text.file), format!("there is no form `{}`", shortened(word)));
    match guess {
        Some(keyword) => (error.help(format!("did you mean `{}`?", keyword.name())), guess),
        None => (error.help(choices(place)), None),
    }
}

/// Brackets that begin with anything but a word.
pub fn bad_first_node(text: Text, group: &Group, place: Place) -> Diagnostic {
    let (span, message) = match group.nodes.first() {
        None => (text.span(group.start as usize, group.end as usize), "these brackets are empty".to_string()),
        Some(first) => (text.point(first), format!("a form can't begin with {}", text.describe(first))),
    };
    Diagnostic::error(Code::BadForm, span, message).help(choices(place))
}

fn choices(place: Place) -> String {
    let names: Vec<String> = Keyword::ALL
        .iter()
        .filter(|keyword| keyword.may_stand(place))
        .map(|keyword| format!("`{}`", keyword.name()))
        .collect();
    match names.as_slice() {
        [] => "remove it".to_string(),
        [one] => format!("{place} there can be {one}"),
        [most @ .., last] => format!("{place} there can be {} and {last}", most.join(", ")),
    }
}

/// Words, blocks and the like, one after another, where only forms can stand.
pub fn outside(text: Text, nodes: &[Node], place: Place) -> Diagnostic {
    let first = &nodes[0];
    let start = first.range().start;
    let line_end = text.text[start..].find(['\n', '\r']).map_or(text.text.len(), |i| start + i);
    let end = nodes.last().map_or(line_end, |last| last.range().end).min(line_end);
    let (code, help) = if first.is(PieceKind::Other) {
        (Code::StrayCharacter, "remove it; a comment begins with `;`".to_string())
    } else if first.is(PieceKind::Block) && place == Place::State {
        (Code::BadForm, "say when it is to run: `(onentry [..])`, `(running [..])` or `(onexit [..])`".to_string())
    } else if first.is(PieceKind::Block) {
        (Code::BadForm, choices(place))
    } else if let Some(keyword) = Keyword::of(text.of(first)).filter(|keyword| keyword.may_stand(place)) {
        (Code::BadForm, format!("a form begins with a bracket: write `({}`", keyword.name()))
    } else {
        (Code::BadForm, "a comment begins with `;`, a form with `(`".to_string())
    };
    let message = format!("{} can't stand by itself {place}", text.describe(first));
    Diagnostic::error(code, text.span(start, end), message).help(help)
}
