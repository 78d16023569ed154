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
/// too, then among the others.
fn same_bodies(old: &Program, new: &Program, matching: &Matching, left: &Left) -> Vec<Rename> {
    let mut found: Vec<Rename> = Vec::new();
    let (mut settled, mut settled_new): (HashSet<ElementId>, HashSet<ElementId>) = Default::default();
    for as_written in [true, false] {
        let mut bodies: HashMap<u64, (Vec<ElementId>, Vec<ElementId>)> = HashMap::new();
        let hash = |side: Side, element: ElementId| {
            let inside = inside(side.program(), element);
            let reading = if as_written { Reading::Body(&inside) } else { Reading::Shape(&inside) };
            let mut hasher = DefaultHasher::new();
            side.keys(matching, reading, |words| words.element(element)).hash(&mut hasher);
            hasher.finish()
        };
        for &gone in left.gone.iter().filter(|gone| !settled.contains(gone)) {
            bodies.entry(hash(Side::Old(old, new), gone)).or_default().0.push(gone);
        }
        for &added in left.new.iter().filter(|added| !settled_new.contains(added)) {
            bodies.entry(hash(Side::New(new), added)).or_default().1.push(added);
        }
        for (gone, added) in bodies.into_values().filter(|(gone, added)| !gone.is_empty() && !added.is_empty()) {
            settled.extend(&gone);
            settled_new.extend(&added);
            if let ([was], [now]) = (&*gone, &*added) {
                found.push((*was, *now));
            }
        }
        let has_names_inside = left.gone.iter().any(|gone| matches!(gone.kind, Kind::Machine | Kind::State));
        if !has_names_inside {
            break;
        }
    }
    found
}

/// Whether what is written in two elements is the same, by the names that things have now.
fn same_text(was_in: Side, was: ElementId, now_in: Side, now: ElementId, matching: &Matching) -> bool {
    fn text<'p>(side: Side<'p>, element: ElementId, matching: &Matching) -> Vec<Key<'p>> {
        side.keys(matching, Reading::Current, |words| words.element(element))
    }
    text(was_in, was, matching) == text(now_in, now, matching)
}
