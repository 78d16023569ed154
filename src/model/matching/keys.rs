//! Words of two programs made comparable: what they name is said in terms that both have in common.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use super::Matching;
use crate::model::element::{ElementId, Kind};
use crate::model::program::Program;
use crate::model::words::{Word, Words};

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(in crate::model) enum Key<'p> {
    Mark(&'static str),
    Text(Cow<'p, str>),
    /// The bits of a number.
    Number(u64),
    /// Something that is in both programs, as the new one knows it.
    Is(ElementId),
    /// Something that only one of the programs has: it may have been renamed.
    Along(Kind),
    /// The element in question.
    Subject(Kind),
    /// Something inside the element in question, by its place there.
    Inner(u32),
    Declares(Kind),
    /// What it is called in the new program, or as written where that isn't known.
    Called(Kind, &'p str),
    Unknown(Kind, &'p str),
}

/// How words are to be read.
#[derive(Clone, Copy)]
pub(in crate::model) enum Reading<'a> {
    /// An element's text, by itself; with what is inside. Names given inside count as written.
    Body(&'a Inside),
    /// The same, but of the names given inside only these count.
    Shape(&'a Inside, &'a HashSet<(Kind, &'a str)>),
    /// A place that names this element.
    Use(ElementId),
    /// By the names that things have now.
    Current,
}

/// An element and what is written in it, each with its place.
pub(in crate::model) type Inside = HashMap<ElementId, u32>;

pub(super) fn inside(program: &Program, element: ElementId) -> Inside {
    let mut inside = HashMap::from([(element, 0)]);
    super::scopes::inside(program, element, &mut |inner| {
        let place = inside.len() as u32;
        inside.insert(inner, place);
    });
    inside
}

/// One of the two programs that are compared.
#[derive(Clone, Copy)]
pub(in crate::model) enum Side<'p> {
    Old(&'p Program, &'p Program),
    New(&'p Program),
}

impl<'p> Side<'p> {
    pub fn program(self) -> &'p Program {
        match self {
            Side::Old(program, _) | Side::New(program) => program,
        }
    }

    /// The element in terms of the new program.
    fn now(self, matching: &Matching, element: ElementId) -> Option<ElementId> {
        match self {
            Side::Old(..) => matching.now(element),
            Side::New(_) => matching.was(element).map(|_| element),
        }
    }

    /// What an element is called in the new program, if it is there.
    fn name_now(self, matching: &Matching, element: ElementId) -> Option<&'p str> {
        match self {
            Side::Old(_, new) => matching.now(element).map(|now| &**new.name(now)),
            Side::New(new) => Some(new.name(element)),
        }
    }

    pub fn keys(
        self,
        matching: &Matching,
        reading: Reading,
        say: impl FnOnce(&mut Words<'p, &mut dyn FnMut(Word<'p>)>),
    ) -> Vec<Key<'p>> {
        let mut keys = Vec::new();
        let mut each = |word| keys.push(self.key(matching, reading, word));
        say(&mut Words::of(self.program(), &mut each));
        keys
    }

    /// An element's text by itself.
    pub fn body(self, matching: &Matching, element: ElementId) -> Vec<Key<'p>> {
        let inside = inside(self.program(), element);
        self.keys(matching, Reading::Body(&inside), |words| words.element(element))
    }

    fn key(self, matching: &Matching, reading: Reading, word: Word<'p>) -> Key<'p> {
        match word {
            Word::Mark(mark) => Key::Mark(mark),
            Word::Text(text) => Key::Text(text),
            Word::Number(number) => Key::Number(number.to_bits()),
            Word::Names(kind, name, found) => self.named(matching, reading, (kind, name, found)),
            Word::Declares(element) => match reading {
                Reading::Shape(_, counting) if !counting.contains(&self.label(element)) => Key::Declares(element.kind),
                _ => Key::Called(element.kind, self.called(matching, reading, element)),
            },
        }
    }

    pub fn label(self, element: ElementId) -> (Kind, &'p str) {
        (element.kind, self.program().name(element))
    }

    /// What a name given inside reads as.
    fn called(self, matching: &Matching, reading: Reading, element: ElementId) -> &'p str {
        let now = matches!(reading, Reading::Current).then(|| self.name_now(matching, element)).flatten();
        now.unwrap_or_else(|| self.program().name(element))
    }

    fn named(
        self,
        matching: &Matching,
        reading: Reading,
        (kind, name, found): (Kind, &'p str, Option<ElementId>),
    ) -> Key<'p> {
        let Some(element) = found else {
            return match reading {
                Reading::Current => Key::Called(kind, name),
                _ => Key::Unknown(kind, name),
            };
        };
        match reading {
            Reading::Current => return Key::Called(kind, self.name_now(matching, element).unwrap_or(name)),
            Reading::Use(subject) if subject == element => return Key::Subject(kind),
            Reading::Use(_) => {}
            Reading::Body(inside) | Reading::Shape(inside, _) => match (inside.get(&element), reading) {
                (Some(0), _) => return Key::Subject(kind),
                (Some(&place), Reading::Shape(_, counting)) if !counting.contains(&self.label(element)) => {
                    return Key::Inner(place);
                }
                (Some(_), _) => return Key::Called(kind, self.program().name(element)),
                (None, _) => {}
            },
        }
        self.now(matching, element).map_or(Key::Along(kind), Key::Is)
    }
}
