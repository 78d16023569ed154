//! What an edit does to the machines that run, found out without doing any of it.

use std::sync::Arc;

use super::Passage;
use crate::model::diff::{same_actions, same_spawns};
use crate::model::*;
use crate::runtime::OnEdit;
use crate::runtime::engine::{Engine, Running};
use crate::runtime::record::{Because, Element, Op};
use crate::syntax::Span;

#[derive(Default)]
pub(super) struct Verdict {
    /// Why the program starts again from scratch, if at all: each machine that can't go on, in step order.
    pub restarts: Vec<Because>,
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
    pub because: Because,
}

pub(super) struct Discarded {
    /// In the old program.
    pub was: MachineId,
    pub path: Arc<str>,
    pub because: Because,
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

    /// The reason to start again from scratch: the first.
    pub fn restarts(&self) -> Option<String> {
        self.restarts.first().map(Because::to_string)
    }

    pub fn because(&self) -> Vec<Because> {
        let again = self.again.iter().map(|again| &again.because);
        let discarded = self.discarded.iter().map(|discarded| &discarded.because);
        self.restarts.iter().chain(again).chain(discarded).cloned().collect()
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
            OnEdit::Restart => tops.iter().for_each(|&machine| judge.restart(machine, &mut verdict)),
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
    fn restart(&self, was: MachineId, verdict: &mut Verdict) {
        let Passage { old, new, matching } = self.passage;
        let Some(running) = &self.running[was.index()] else { return };
        let Some(machine) = matching.machine(was) else { return verdict.restarts.push(self.gone(was)) };
        match matching.state(running.state).filter(|&now| same_actions(old, running.state, new, now, matching)) {
            Some(_) => running.nested.iter().for_each(|&nested| self.restart(nested, verdict)),
            None => verdict.restarts.push(self.unlike(machine, running.state)),
        }
    }

    fn gone(&self, was: MachineId) -> Because {
        let path = &self.passage.old[was].path;
        Because { machine: path.clone(), kind: Element::Machine, path: path.clone(), op: Op::Removed }
    }

    /// `was`: its active state, which is gone or changed.
    fn unlike(&self, machine: MachineId, was: StateId) -> Because {
        let Passage { old, new, matching } = self.passage;
        let (path, op) = match matching.state(was) {
            Some(now) => (&new[now].path, Op::Changed),
            None => (&old[was].path, Op::Removed),
        };
        Because { machine: new[machine].path.clone(), kind: Element::State, path: path.clone(), op }
    }

    /// `by`: the new active state that holds the machine.
    fn keep(&self, was: MachineId, by: Option<StateId>, verdict: &mut Verdict) {
        let Passage { old, new, matching } = self.passage;
        let Some(running) = &self.running[was.index()] else { return };
        let Some(machine) = matching.machine(was) else {
            let (path, because) = (old[was].path.clone(), self.gone(was));
            return verdict.discarded.push(Discarded { was, path, because, missing: None });
        };
        let stays = matching.state(running.state).filter(|&now| same_spawns(old, running.state, new, now, matching));
        if let Some(state) = stays {
            return running.nested.iter().for_each(|&nested| self.keep(nested, Some(state), verdict));
        }
        let because = self.unlike(machine, running.state);
        match self.start(machine, by, &running.start) {
            Ok(state) => verdict.again.push(Again { was, machine, state, by, because }),
            Err(missing) => {
                let path = new[machine].path.clone();
                verdict.discarded.push(Discarded { was, path, because, missing: Some(missing) });
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
