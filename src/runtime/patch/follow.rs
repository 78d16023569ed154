//! The machines that run, from the old program's elements to the new one's.

use std::sync::Arc;

use super::{Passage, Verdict};
use crate::model::*;
use crate::runtime::engine::{Engine, Running};

impl Engine {
    /// What goes on is where it was; what starts again is where it will, not yet entered. Gives the paths of the machines
    /// that ended, inner ones first.
    pub(super) fn follow(&mut self, passage: &Passage, verdict: &Verdict) -> Vec<Arc<str>> {
        let mut ended = Vec::new();
        verdict.ending().for_each(|machine| self.end(passage, machine, &mut ended));
        let mut running: Vec<Option<Running>> = passage.new.machines.iter().map(|_| None).collect();
        for (index, was) in std::mem::take(&mut self.running).into_iter().enumerate() {
            let machine = passage.matching.machine(MachineId(index as u32));
            if let (Some(was), Some(machine)) = (was, machine) {
                running[machine.index()] = passage.running(was, self.step + 1);
            }
        }
        for again in &verdict.again {
            let start = passage.new[again.state].name.clone();
            running[again.machine.index()] = Some(Running::new(again.state, self.now, start));
        }
        let runs: Vec<bool> = running.iter().map(Option::is_some).collect();
        running.iter_mut().flatten().for_each(|running| running.nested.retain(|nested| runs[nested.index()]));
        self.tops = passage.machines(&self.tops);
        self.tops.retain(|top| runs[top.index()]);
        self.running = running;
        self.visits = passage.visits(&self.visits);
        ended
    }

    fn end(&mut self, passage: &Passage, machine: MachineId, ended: &mut Vec<Arc<str>>) {
        let Some(running) = self.running[machine.index()].take() else { return };
        running.nested.into_iter().for_each(|nested| self.end(passage, nested, ended));
        for &var in &passage.old[machine].vars {
            self.store.lua.clear(self.store.cell(var));
        }
        ended.push(passage.path(machine));
    }
}

impl Passage<'_> {
    /// Its guards may be others now: they are looked at in step `tested`.
    fn running(&self, was: Running, tested: u64) -> Option<Running> {
        let state = self.matching.state(was.state)?;
        Some(Running {
            state,
            entered: was.entered,
            tested,
            start: self.start(self.old[was.state].machine, was.start),
            nested: self.machines(&was.nested),
            decided: was.decided.and_then(|fired| self.decided(was.state, state, fired)),
        })
    }

    /// What the state is called now that a machine was started in.
    fn start(&self, machine: MachineId, was: Arc<str>) -> Arc<str> {
        let now = self.old.state_named(machine, &was).and_then(|state| self.matching.state(state));
        now.map_or(was, |state| self.new[state].name.clone())
    }

    fn machines(&self, old: &[MachineId]) -> Vec<MachineId> {
        old.iter().filter_map(|&machine| self.matching.machine(machine)).collect()
    }

    fn visits(&self, old: &[u64]) -> Vec<u64> {
        let was = |state| self.matching.was(StateId(state)).map(|was| old[was.index as usize]);
        (0..self.new.states.len() as u32).map(|state| was(state).unwrap_or(0)).collect()
    }
}
