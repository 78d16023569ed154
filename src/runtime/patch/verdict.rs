//! What an edit does to the machines that run, found out without doing any of it.

use std::sync::Arc;

use super::Passage;
use crate::model::diff::{same_actions, same_spawns};
use crate::model::*;
use crate::runtime::OnEdit;
use crate::runtime::engine::{Engine, Running};
use crate::syntax::Span;

#[derive(Default)]
pub(super) struct Verdict {
    /// Why the program starts again from scratch.
    pub restarts: Option<String>,
    /// Machines that start again on their own, outer ones first.
    pub again: Vec<Again>,
    /// Machines that run no longer.
    pub discarded: Vec<Discarded>,
}

pub(super) struct Again {
    /// In the old program.
    pub was: MachineId,
    pub machine: MachineId,
    pub state: StateId,
    /// The active state that holds it; none at top level.
    pub by: Option<StateId>,
}

pub(super) struct Discarded {
    /// In the old program.
    pub was: MachineId,
    pub path: Arc<str>,
    /// What it would have started again in, where the machine itself is still there.
    pub missing: Option<Missing>,
}

pub(super) struct Missing {
    /// A name that no state of the machine has.
    pub state: Arc<str>,
    /// Where it is named, or else the machine.
    pub span: Span,
}

impl Verdict {
    /// The old machines whose run ends, though some of them start again.
    pub fn ending(&self) -> impl Iterator<Item = MachineId> {
        let again = self.again.iter().map(|again| again.was);
        again.chain(self.discarded.iter().map(|discarded| discarded.was))
    }

    pub fn again_paths(&self, new: &Program) -> Vec<Arc<str>> {
        self.again.iter().map(|again| new[again.machine].path.clone()).collect()
    }

    pub fn discarded_paths(&self) -> Vec<Arc<str>> {
        self.discarded.iter().map(|discarded| discarded.path.clone()).collect()
    }
}

impl Engine {
    pub(super) fn verdict(&self, passage: &Passage) -> Verdict {
        Verdict::of(&self.tops, &self.running, passage, self.on_edit)
    }
}

impl Verdict {
    /// `tops` and `running` are those of the old program.
    pub fn of(tops: &[MachineId], running: &[Option<Running>], passage: &Passage, mode: OnEdit) -> Verdict {
        let judge = Judge { running, passage };
        let mut verdict = Verdict::default();
        match mode {
            OnEdit::Restart => verdict.restarts = tops.iter().find_map(|&machine| judge.why_restart(machine)),
            OnEdit::Keep => tops.iter().for_each(|&machine| judge.keep(machine, None, &mut verdict)),
        }
        verdict
    }
}

struct Judge<'v> {
    running: &'v [Option<Running>],
    passage: &'v Passage<'v>,
}

impl Judge<'_> {
    /// The one case in which a program can't go on: what is active is gone, or would have done something else.
    fn why_restart(&self, machine: MachineId) -> Option<String> {
        let Passage { old, new, matching } = self.passage;
        let running = self.running[machine.index()].as_ref()?;
        if matching.machine(machine).is_none() {
            return Some(format!("active machine {} removed", old[machine].path));
        }
        match matching.state(running.state) {
            None => Some(format!("active state {} removed", old[running.state].path)),
            Some(now) if !same_actions(old, running.state, new, now, matching) => {
                Some(format!("active state {} changed", new[now].path))
            }
            Some(_) => running.nested.iter().find_map(|&nested| self.why_restart(nested)),
        }
    }

    /// `by`: the new active state that holds the machine.
    fn keep(&self, was: MachineId, by: Option<StateId>, verdict: &mut Verdict) {
        let Passage { old, new, matching } = self.passage;
        let Some(running) = &self.running[was.index()] else { return };
        let Some(machine) = matching.machine(was) else {
            return verdict.discarded.push(Discarded { was, path: old[was].path.clone(), missing: None });
        };
        let stays = matching.state(running.state).filter(|&now| same_spawns(old, running.state, new, now, matching));
        if let Some(state) = stays {
            return running.nested.iter().for_each(|&nested| self.keep(nested, Some(state), verdict));
        }
        match self.start(machine, by, &running.start) {
            Ok(state) => verdict.again.push(Again { was, machine, state, by }),
            Err(missing) => {
                let path = new[machine].path.clone();
                verdict.discarded.push(Discarded { was, path, missing: Some(missing) });
            }
        }
    }

    /// Where a machine starts again: as the spawn says that runs it, or else where it was started last.
    fn start(&self, machine: MachineId, by: Option<StateId>, last: &Arc<str>) -> Result<StateId, Missing> {
        let new = self.passage.new;
        let mut spawns = match by {
            None => new.spawns.iter().collect::<Vec<_>>(),
            Some(state) => new[state].spawns().map(|(_, spawn)| spawn).collect(),
        };
        spawns.retain(|spawn| spawn.machine == Some(machine));
        let missing = match (spawns.iter().find_map(|spawn| spawn.target), spawns.first()) {
            (Some((_, state)), _) => return Ok(state),
            (None, Some(spawn)) => Missing { state: spawn.state_name.clone(), span: spawn.span },
            (None, None) => Missing { state: last.clone(), span: new[machine].name_span },
        };
        new.state_named(machine, &missing.state).ok_or(missing)
    }
}
