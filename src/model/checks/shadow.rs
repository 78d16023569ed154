//! Transitions that are never taken, because an earlier one always is.

use super::guards::{after, always, tested};
use crate::lua::FieldUse;
use crate::model::ids::*;
use crate::model::program::*;
use crate::model::transition_names::spelled;
use crate::syntax::{Code, Diagnostic};

/// Out of each of its states, an earlier transition is taken whenever this one could be: one that always is, one for the
/// same event, or one with a timeout that is no longer.
pub fn shadowed_transition(program: &Program) -> Vec<Diagnostic> {
    let mut told = vec![Told::default(); program.transitions.len()];
    for state in (0..program.states.len() as u32).map(StateId) {
        let mut before = Before::default();
        for id in tested(program, state) {
            let told = &mut told[id.index()];
            match before.shadows(program, id) {
                Some(by) => told.by = told.by.or(Some(by)),
                None => told.free = true,
            }
            before.add(program, id);
        }
    }
    let shadowed = told.iter().enumerate().filter(|(_, told)| !told.free);
    shadowed.filter_map(|(index, told)| Some(shadow(program, TransitionId(index as u32), told.by?))).collect()
}

#[derive(Clone, Copy, Default)]
struct Told {
    by: Option<TransitionId>,
    /// Whether it may be taken out of some state.
    free: bool,
}

/// Transitions of a state that are tested earlier.
#[derive(Default)]
struct Before {
    always: Option<TransitionId>,
    shortest: Option<(f64, TransitionId)>,
    events: Vec<(EventId, TransitionId)>,
}

impl Before {
    fn add(&mut self, program: &Program, id: TransitionId) {
        let trigger = &program[id].trigger;
        if always(program, trigger) {
            self.always = self.always.or(Some(id));
        } else if let Some(ms) = after(program, trigger) {
            if self.shortest.is_none_or(|(shortest, _)| ms < shortest) {
                self.shortest = Some((ms, id));
            }
        } else if let Trigger::Event(event) = *trigger
            && !by_chance(program, event)
        {
            self.events.push((event, id));
        }
    }

    fn shadows(&self, program: &Program, id: TransitionId) -> Option<TransitionId> {
        let trigger = &program[id].trigger;
        let sooner = self.shortest.filter(|(shortest, _)| after(program, trigger).is_some_and(|ms| ms >= *shortest));
        let same = self.events.iter().find(|(event, _)| matches!(trigger, Trigger::Event(it) if it == event));
        self.always.or(sooner.map(|(_, id)| id)).or(same.map(|&(_, id)| id))
    }
}

/// Whether an event that didn't occur may occur when it is asked again in the same step.
fn by_chance(program: &Program, event: EventId) -> bool {
    let block = &program[program[event].block];
    let random = |used: &FieldUse| used.name == "math" && used.fields[0] == "random";
    !block.writes.is_empty() || block.facts.fields.iter().any(random)
}

fn shadow(program: &Program, id: TransitionId, by: TransitionId) -> Diagnostic {
    let (shadowed, other) = (spelled(program, id), spelled(program, by));
    let help = match (&program[by].trigger, program[by].kind) {
        (_, TransitionKind::Exit) => "an exit is tested before what is inside moves: give it a narrower trigger",
        (Trigger::Event(_), _) => "guards are tested in the order written: put it first, or remove one of them",
        (Trigger::After(ms), _) if *ms > 0.0 => "the shorter timeout is always due first: remove one of them",
        _ => "guards are tested in the order written: put it first, or remove it",
    };
    let message = format!("`{shadowed}` is never taken: `{other}` is taken before it");
    Diagnostic::warning(Code::ShadowedTransition, program[id].span, message)
        .also(program[by].span, "this one")
        .help(help)
}
