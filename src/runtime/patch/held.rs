//! An edit that waits to be taken over: what that would do is told, and told again when the program has moved on to where
//! it would do something else.

use std::sync::Arc;

use super::{Passage, Verdict};
use crate::model::edit::Comparison;
use crate::model::*;
use crate::runtime::Saves;
use crate::runtime::engine::Engine;
use crate::runtime::findings::findings;
use crate::runtime::note::Note;
use crate::runtime::obey::Refused;
use crate::runtime::record::{Change, Finding, Held, What};

pub(in crate::runtime) struct Pending {
    program: Arc<Program>,
    comparison: Arc<Comparison>,
    /// What it would do, as last told.
    told: Held,
}

impl Engine {
    /// Whether a program that is loaded now would be held.
    pub fn holds_saves(&self) -> bool {
        self.saves == Saves::Hold && !self.program.sources.is_empty()
    }

    /// What taking the held edit over would do now.
    pub fn held(&self) -> Option<&Held> {
        self.held.as_ref().map(|pending| &pending.told)
    }

    pub fn held_program(&self) -> Option<&Arc<Program>> {
        self.held.as_ref().map(|pending| &pending.program)
    }

    /// Has the held program taken over with findings that came later.
    pub fn amend_held(&mut self, program: Arc<Program>) {
        if let Some(pending) = &mut self.held {
            pending.program = program;
        }
    }

    pub(in crate::runtime) fn hold(&mut self, edit: Edit) {
        let comparison = edit.comparison(&self.program);
        let program = edit.program;
        let verdict = self.verdict(&Passage { old: &self.program, new: &program, matching: &comparison.matching });
        let changes = comparison.changes.clone();
        let told = told(changes, findings(&program, |_| true), &program, &verdict);
        self.rare(What::Held(told.clone()));
        self.held = Some(Pending { program, comparison, told });
    }

    pub(in crate::runtime) fn apply_held(&mut self) -> Result<(), Refused> {
        let Pending { program, comparison, .. } = self.held.take().ok_or_else(nothing_held)?;
        self.take_over(program, &comparison);
        Ok(())
    }

    pub(in crate::runtime) fn drop_held(&mut self) -> Result<(), Refused> {
        self.held.take().map(drop).ok_or_else(nothing_held)
    }

    /// After a step or a command.
    pub(in crate::runtime) fn tell_held_again(&mut self) {
        if !self.notes.iter().any(Note::may_change_a_verdict) {
            return;
        }
        let Some(Pending { program, comparison, told: before }) = &self.held else { return };
        let verdict = self.verdict(&Passage { old: &self.program, new: program, matching: &comparison.matching });
        let now = told(before.changes.clone(), before.findings.clone(), program, &verdict);
        if now != *before {
            self.rare(What::Held(now.clone()));
            if let Some(pending) = &mut self.held {
                pending.told = now;
            }
        }
    }
}

fn told(changes: Vec<Change>, findings: Vec<Finding>, program: &Program, verdict: &Verdict) -> Held {
    Held {
        changes,
        restarts: verdict.restarts(),
        again: verdict.again_paths(program),
        discarded: verdict.discarded_paths(),
        because: verdict.because(),
        findings,
    }
}

fn nothing_held() -> Refused {
    Refused("no save is held: the last one was taken over or dropped".to_string())
}
