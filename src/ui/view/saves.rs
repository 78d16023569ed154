//! What a save changes in the picture: taken over, held or refused.

use std::sync::Arc;

use super::problem::{Origin, Problem};
use super::{Edit, Outcome, Path, Renames, View, describe, owner, within};
use crate::model::Program;
use crate::runtime::record::{File, Finding, Held, Load};
use crate::syntax::Source;

/// More changes than these are counted in the log.
const TOLD: usize = 6;

impl View {
    pub(super) fn load(&mut self, load: &Load) {
        let edit = if self.loads == 0 { Edit::Loaded } else { Edit::of_load(load, self.edit.as_ref()) };
        self.loads += 1;
        if matches!(self.mode, super::Mode::Waiting { .. }) {
            self.mode = super::Mode::Running;
        }
        self.held = None;
        self.refused.clear();
        self.guards.clear();
        self.rename(&Renames::of(&load.changes));
        self.note_edit(&edit);
        if let Edit::Taken(outcome) = &edit {
            self.given_by(outcome);
        }
        self.edit = Some(edit);
        self.end_again(&load.again, &load.discarded);
        if let Some(program) = &load.program {
            self.take_over(program);
        }
        if load.restarted {
            self.begin_again();
        }
        self.problems.retain(|problem| problem.origin == Origin::Config);
        let found = load.findings.iter().map(|finding| Problem::from_finding(finding, Origin::Check, self.t));
        self.problems.splice(0..0, found);
    }

    /// Machines inside those that start again or end are gone; what they do next has records of its own.
    fn end_again(&mut self, again: &[Path], discarded: &[Path]) {
        let ends = |machine: &str| {
            let inside = |outer: &Path| within(machine, outer) && *machine != **outer;
            discarded.iter().any(|outer| within(machine, outer)) || again.iter().any(inside)
        };
        self.remember_tuned(|var| owner(var).is_some_and(ends));
        let ended: Vec<Path> = self.machines.keys().filter(|machine| ends(machine)).cloned().collect();
        ended.iter().for_each(|machine| self.discard(machine));
    }

    fn take_over(&mut self, program: &Arc<Program>) {
        self.machines.retain(|path, _| program.machine(path).is_some());
        self.states.retain(|path, _| program.state(path).is_some());
        self.variables.retain(|path, _| program.var(path).is_some());
        self.tuned.retain(|path, _| program.var(path).is_some());
        self.by_hand.retain(|path, _| program.var(path).is_some());
        self.follow_trails(program);
        self.program = Some(program.clone());
        self.find_transitions();
    }

    /// Told again where it would do something else now: that is no news of a save.
    pub(super) fn hold(&mut self, held: &Held) {
        let known = self.held.as_ref().is_some_and(|before| before.changes == held.changes);
        if !known {
            let edit = Edit::Held { changes: Outcome::of_held(held).summary() };
            self.note_edit(&edit);
            self.edit = Some(edit);
        }
        self.held = Some(held.clone());
    }

    pub(super) fn drop_held(&mut self) {
        if self.held.take().is_some() {
            self.note_edit(&Edit::Dropped);
            self.edit = Some(Edit::Dropped);
        }
    }

    pub(super) fn reject(&mut self, findings: &[Finding], files: &[File]) {
        self.refused = files.iter().map(|file| Source::new(file.name.clone(), file.text.clone())).collect();
        self.problems.retain(|problem| problem.origin != Origin::Rejected);
        let rejected = findings.iter().map(|finding| Problem::from_finding(finding, Origin::Rejected, self.t));
        self.problems.splice(0..0, rejected);
        let edit = Edit::of_reject(findings);
        self.note_edit(&edit);
        self.edit = Some(edit);
    }

    /// The newest stands first: what changed in particular comes below the line that sums it up.
    fn note_edit(&mut self, edit: &Edit) {
        if let Edit::Taken(outcome) = edit
            && outcome.changes.len() > 1
        {
            let more = outcome.changes.len().saturating_sub(TOLD);
            if more > 0 {
                self.journal.note(self.t, format!("  and {more} more"));
            }
            for change in outcome.changes.iter().take(TOLD).rev() {
                self.journal.note(self.t, format!("  {}", describe(change)));
            }
        }
        let text = match edit {
            Edit::Loaded => "program loaded".into(),
            Edit::Taken(outcome) => {
                let told = [format!("saved: {}", outcome.summary())].into_iter().chain(outcome.effects());
                told.collect::<Vec<_>>().join("; ")
            }
            Edit::Held { changes } => format!("held: {changes}"),
            Edit::Dropped => "the held edit is dropped".into(),
            Edit::Restarted => "restarted".into(),
            Edit::Mended => "mended: what runs is what the files say".into(),
            Edit::Rejected { first, .. } if first.line == 0 => self.headline(first),
            Edit::Rejected { first, .. } => format!("not taken over: {}", self.headline(first)),
        };
        self.journal.note(self.t, text);
    }
}
