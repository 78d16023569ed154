//! Elements of the same name in the same scope are the same, from the top down.

use std::collections::HashMap;

use super::Matching;
use crate::model::element::{ElementId, Kind};
use crate::model::ids::*;
use crate::model::program::Program;

/// Elements of one scope and kind that are gone and those that are new; some of both.
pub(super) struct Left {
    pub gone: Vec<ElementId>,
    pub new: Vec<ElementId>,
}

/// Matches by name what is at top level, and what is inside of what it matches.
pub(super) fn match_names(old: &Program, new: &Program, matching: &mut Matching) -> Vec<Left> {
    let mut left = Vec::new();
    match_children(old, new, matching, (None, None), &mut left);
    left
}

/// The same inside of two elements that are one.
pub(super) fn match_inside(
    old: &Program,
    new: &Program,
    matching: &mut Matching,
    (was, now): (ElementId, ElementId),
    left: &mut Vec<Left>,
) {
    match_children(old, new, matching, (Some(was), Some(now)), left);
}

fn match_children(
    old: &Program,
    new: &Program,
    matching: &mut Matching,
    scope: (Option<ElementId>, Option<ElementId>),
    left: &mut Vec<Left>,
) {
    for kind in [Kind::Var, Kind::Event, Kind::Machine, Kind::State] {
        // Files that are imported may have their own machines of a name.
        let called = |program, element| label(program, scope.0, element);
        let gone = children(old, scope.0, kind);
        let mut there = HashMap::new();
        let candidates = children(new, scope.1, kind);
        let mut next = candidates.iter().copied();
        let mut missing = Vec::new();
        for was in gone {
            // Mostly they are in the same order.
            let same = next.next().filter(|&now| called(new, now) == called(old, was));
            let now = same.or_else(|| {
                if there.is_empty() {
                    there.extend(candidates.iter().map(|&now| (called(new, now), now)));
                }
                there.get(called(old, was)).copied()
            });
            match now {
                Some(now) => {
                    matching.link(was, now);
                    match_inside(old, new, matching, (was, now), left);
                }
                None => missing.push(was),
            }
        }
        let added: Vec<ElementId> = candidates.into_iter().filter(|&now| matching.was(now).is_none()).collect();
        if !missing.is_empty() && !added.is_empty() {
            left.push(Left { gone: missing, new: added });
        }
    }
}

fn label(program: &Program, scope: Option<ElementId>, element: ElementId) -> &str {
    if scope.is_some() { program.name(element) } else { program.path(element) }
}

/// What of a kind is written directly in a machine or state, or at top level.
pub(super) fn children(program: &Program, scope: Option<ElementId>, kind: Kind) -> Vec<ElementId> {
    fn ids<Id: Copy + Into<ElementId>>(list: &[Id]) -> Vec<ElementId> {
        list.iter().copied().map(Into::into).collect()
    }
    match (scope.map(|scope| (scope.kind, scope.index)), kind) {
        (None, Kind::Machine) => ids(&program.tops),
        (None, Kind::Var) => ids(&program.globals),
        (Some((Kind::Machine, index)), Kind::Var) => ids(&program[MachineId(index)].vars),
        (Some((Kind::Machine, index)), Kind::Event) => ids(&program[MachineId(index)].events),
        (Some((Kind::Machine, index)), Kind::State) => ids(&program[MachineId(index)].states),
        (Some((Kind::State, index)), Kind::Machine) => ids(&program[StateId(index)].machines),
        _ => Vec::new(),
    }
}

/// Everything inside an element, at every depth.
pub(super) fn inside(program: &Program, element: ElementId, each: &mut impl FnMut(ElementId)) {
    for kind in [Kind::Var, Kind::Event, Kind::Machine, Kind::State] {
        for child in children(program, Some(element), kind) {
            each(child);
            inside(program, child, each);
        }
    }
}
