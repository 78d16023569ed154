//! Taking a program over while the old one runs: what the edit doesn't concern stays as it is.

mod apply;
mod decided;
mod faults;
mod follow;
mod held;
mod passage;
mod verdict;

use std::rc::Rc;
use std::sync::Arc;

use super::engine::Engine;
use super::plan::Plan;
use super::record::{Change, Load, What};
use crate::model::blocks::syntax_diagnostic;
use crate::model::edit::Comparison;
use crate::model::*;
pub(super) use held::Pending;
use passage::Passage;
use verdict::Verdict;

impl Engine {
    /// Takes a program over; one that was held is forgotten.
    pub(super) fn load(&mut self, edit: Edit) {
        let comparison = edit.comparison(&self.program);
        self.held = None;
        self.take_over(edit.program, &comparison);
    }

    fn take_over(&mut self, mut new: Arc<Program>, Comparison { matching, changes, .. }: &Comparison) {
        let old = Arc::clone(&self.program);
        let first = old.sources.is_empty();
        let verdict = self.verdict(&Passage { old: &old, new: &new, matching });
        let ended = self.follow(&Passage { old: &old, new: &new, matching }, &verdict);
        self.take_over_modules(&old, &new);
        self.compile(&old, &mut new, matching);
        let passage = Passage { old: &old, new: &new, matching };
        let still = self.faults_that_stand(&passage);
        self.plan = Rc::new(Plan::of(&new, &self.store));
        self.changes.follow(&new);
        self.why.begin_anew(&new);
        self.program = Arc::clone(&new);
        self.rare(What::Load(loaded(&new, changes.clone(), &verdict)));
        self.follow_breakpoints(&old, matching);
        ended.into_iter().for_each(|machine| self.rare(What::Discard { machine }));
        if let Some(reason) = verdict.restarts() {
            return self.restart(&reason);
        }
        still.into_iter().for_each(|fault| self.rare(What::Error(fault)));
        self.report_findings();
        self.report_missing(&verdict);
        match first {
            true => self.begin(),
            false => self.apply(&passage, &verdict),
        }
    }

    /// What Lua refuses although it was checked before is a finding like those of the checks.
    fn compile(&mut self, old: &Program, new: &mut Arc<Program>, matching: &Matching) {
        for uncompiled in self.store.take_over(old, new, matching) {
            let span = new[uncompiled.block].span;
            let finding = syntax_diagnostic(new.source(span), span, &uncompiled.error);
            if !new.findings.iter().any(|known| known.span == finding.span) {
                Arc::make_mut(new).findings.push(finding);
            }
        }
    }
}

fn loaded(program: &Arc<Program>, changes: Vec<Change>, verdict: &Verdict) -> Load {
    Load {
        changes,
        restarted: verdict.restarts().is_some(),
        reason: verdict.restarts(),
        again: verdict.again_paths(program),
        discarded: verdict.discarded_paths(),
        because: verdict.because(),
        findings: super::findings::findings(program, |finding| !finding.is_error()),
        files: super::findings::files(program),
        program: Some(Arc::clone(program)),
    }
}
