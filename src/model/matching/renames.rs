//! Renames among what is gone and what is new: one of each with the same body, and all uses renamed along. In doubt it is
//! none.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

use super::keys::inside;
use super::scopes::{self, Left};
use super::uses::Uses;
use super::{Key, Matching, Reading, Side};
use crate::model::element::{ElementId, Kind};
use crate::model::program::Program;

/// An element of the old program and the one of the new program that it may have become.
pub(super) type Rename = (ElementId, ElementId);

pub(super) fn find(old: &Program, new: &Program, matching: &mut Matching, mut left: Vec<Left>) {
    let mut renames: Vec<Rename> = Vec::new();
    while !left.is_empty() {
        let found: Vec<Rename> = left.iter().flat_map(|left| same_bodies(old, new, matching, left)).collect();
        found.iter().for_each(|&(was, now)| matching.link(was, now));
        left.clear();
        for &rename in &found {
            scopes::match_inside(old, new, matching, rename, &mut left);
        }
        renames.extend(found);
    }
    let uses = Uses::of(old, new, matching, &renames);
    loop {
        let holds = |&(was, now): &Rename| {
            uses.go_along(matching, was, now) && same_text(Side::Old(old, new), was, Side::New(new), now, matching)
        };
        let refuted: Vec<Rename> = renames.iter().copied().filter(|rename| !holds(rename)).collect();
        if refuted.is_empty() {
            return;
        }
        for (was, _) in refuted {
            matching.unlink(was);
            scopes::inside(old, was, &mut |inner| matching.unlink(inner));
        }
        renames.retain(|&(was, _)| matching.now(was).is_some());
    }
}

/// Pairs that have a body of which there is just one on either side: first among those whose names inside are the same,
/// too, then among the others, where names that only one side has don't count.
fn same_bodies(old: &Program, new: &Program, matching: &Matching, left: &Left) -> Vec<Rename> {
    let (before, after) = (Side::Old(old, new), Side::New(new));
    let body = |side: Side, element| {
        let inside = inside(side.program(), element);
        hash(side, element, matching, Reading::Body(&inside))
    };
    let mut pairing = Pairing::default();
    pairing.add(left, |gone| body(before, gone), |added| body(after, added));
    let may_hold_names = left.gone.iter().any(|gone| matches!(gone.kind, Kind::Machine | Kind::State));
    if may_hold_names && left.gone.iter().any(|gone| !pairing.settled_old.contains(gone)) {
        let common: HashSet<_> =
            names_inside(before, &left.gone).intersection(&names_inside(after, &left.new)).copied().collect();
        let shape = |side: Side, element| {
            let inside = inside(side.program(), element);
            hash(side, element, matching, Reading::Shape(&inside, &common))
        };
        pairing.add(left, |gone| shape(before, gone), |added| shape(after, added));
    }
    pairing.found
}

#[derive(Default)]
struct Pairing {
    found: Vec<Rename>,
    /// What was one of those with the same body, whether that made a pair or a doubt.
    settled_old: HashSet<ElementId>,
    settled_new: HashSet<ElementId>,
}

impl Pairing {
    fn add(&mut self, left: &Left, old: impl Fn(ElementId) -> u64, new: impl Fn(ElementId) -> u64) {
        let mut bodies: HashMap<u64, (Vec<ElementId>, Vec<ElementId>)> = HashMap::new();
        for &gone in left.gone.iter().filter(|gone| !self.settled_old.contains(gone)) {
            bodies.entry(old(gone)).or_default().0.push(gone);
        }
        for &added in left.new.iter().filter(|added| !self.settled_new.contains(added)) {
            bodies.entry(new(added)).or_default().1.push(added);
        }
        for (gone, added) in bodies.into_values().filter(|(gone, added)| !gone.is_empty() && !added.is_empty()) {
            if let ([was], [now]) = (&*gone, &*added) {
                self.found.push((*was, *now));
            }
            self.settled_old.extend(gone);
            self.settled_new.extend(added);
        }
    }
}

fn hash(side: Side, element: ElementId, matching: &Matching, reading: Reading) -> u64 {
    let mut hasher = DefaultHasher::new();
    side.keys(matching, reading, |words| words.element(element)).hash(&mut hasher);
    hasher.finish()
}

/// The names given inside of any of the elements.
fn names_inside<'p>(side: Side<'p>, elements: &[ElementId]) -> HashSet<(Kind, &'p str)> {
    let mut names = HashSet::new();
    for &element in elements {
        scopes::inside(side.program(), element, &mut |inner| {
            names.insert(side.label(inner));
        });
    }
    names
}

/// Whether what is written in two elements is the same, by the names that things have now.
fn same_text(was_in: Side, was: ElementId, now_in: Side, now: ElementId, matching: &Matching) -> bool {
    fn text<'p>(side: Side<'p>, element: ElementId, matching: &Matching) -> Vec<Key<'p>> {
        side.keys(matching, Reading::Current, |words| words.element(element))
    }
    text(was_in, was, matching) == text(now_in, now, matching)
}
