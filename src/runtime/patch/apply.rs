//! What an edit asks for where the program goes on: variables that are initialised, machines that start, now or again.

use std::rc::Rc;
use std::sync::Arc;

use super::verdict::Again;
use super::{Passage, Verdict};
use crate::model::diff::same_block;
use crate::model::*;
use crate::runtime::engine::Engine;
use crate::runtime::machine::Spawner;
use crate::runtime::plan::Plan;

impl Engine {
    pub(super) fn apply(&mut self, passage: &Passage, verdict: &Verdict) {
        for var in self.to_initialise(passage, verdict) {
            self.initialise(var);
        }
        let plan = Rc::clone(&self.plan);
        let mut started = Vec::new();
        for again in &verdict.again {
            self.start_again(&plan, again);
            started.push(again.machine);
        }
        self.spawn_new(passage, &plan, &mut started);
        self.retry_spawns(passage, &plan, &mut started);
        for index in 0..self.tops.len() {
            self.settle_started(&plan, self.tops[index], &started);
        }
    }

    /// New variables whose scope runs, those with another initial value, and those whose initial value reads them. A
    /// machine that starts again sees to its own.
    fn to_initialise(&self, passage: &Passage, verdict: &Verdict) -> Vec<VarId> {
        let Passage { old, new, matching } = passage;
        let alive: Vec<VarId> = (0..new.vars.len() as u32).map(VarId).filter(|&var| self.is_alive(var)).collect();
        let mut found: Vec<bool> = vec![false; new.vars.len()];
        for &var in &alive {
            let was = matching.was(var).map(|was| VarId(was.index));
            let same = |was: VarId| same_block(old, old[was].init, new, new[var].init, matching);
            found[var.index()] = !was.is_some_and(same);
        }
        let mut grown = true;
        while grown {
            grown = false;
            for &var in &alive {
                if !found[var.index()] && new[new[var].init].uses.iter().any(|read| found[read.index()]) {
                    found[var.index()] = true;
                    grown = true;
                }
            }
        }
        let anew = |machine| verdict.again.iter().any(|again| again.machine == machine);
        let wanted = alive.into_iter().filter(|&var| found[var.index()] && !new[var].machine.is_some_and(anew));
        let (globals, locals): (Vec<VarId>, Vec<VarId>) = wanted.partition(|&var| new[var].machine.is_none());
        new.globals.iter().copied().filter(|var| globals.contains(var)).chain(locals).collect()
    }

    /// It has its place among the running machines already.
    fn start_again(&mut self, plan: &Plan, &Again { machine, state, by, .. }: &Again) {
        self.begin_run(machine, by);
        self.enter(plan, machine, state);
    }

    fn spawn_new(&mut self, passage: &Passage, plan: &Plan, started: &mut Vec<MachineId>) {
        let mut spawned_before = vec![false; passage.new.machines.len()];
        for (machine, _) in passage.old.spawns.iter().filter_map(|spawn| spawn.target) {
            if let Some(now) = passage.matching.machine(machine) {
                spawned_before[now.index()] = true;
            }
        }
        for (index, spawn) in passage.new.spawns.iter().enumerate() {
            if let Some((machine, state)) = spawn.target
                && !self.runs(machine)
                && !spawned_before[machine.index()]
            {
                self.spawn(plan, machine, state, Spawner::Top { index });
                started.push(machine);
            }
        }
        self.order_tops();
    }

    fn order_tops(&mut self) {
        let program = Arc::clone(&self.program);
        let mut place = vec![usize::MAX; program.machines.len()];
        for (index, spawn) in program.spawns.iter().enumerate().rev() {
            if let Some((machine, _)) = spawn.target {
                place[machine.index()] = index;
            }
        }
        self.tops.sort_by_key(|machine| place[machine.index()]);
    }

    /// Spawns of active states that named something unknown are tried again when it exists.
    fn retry_spawns(&mut self, passage: &Passage, plan: &Plan, started: &mut Vec<MachineId>) {
        for machine in (0..passage.new.machines.len() as u32).map(MachineId) {
            let Some(state) = self.active_state(machine) else { continue };
            let Some(was) = passage.matching.was(state).map(|was| StateId(was.index)) else { continue };
            let known = started.len();
            for ((_, was), (index, spawn)) in passage.old[was].spawns().zip(passage.new[state].spawns()) {
                if let (None, Some((nested, start))) = (was.target, spawn.target)
                    && !self.runs(nested)
                {
                    self.spawn(plan, nested, start, Spawner::Entry { state, index });
                    started.push(nested);
                }
            }
            if started.len() > known {
                self.order_nested(machine, state);
            }
        }
    }

    /// Nested machines take their steps in the order of the spawn statements, however late one succeeded.
    fn order_nested(&mut self, machine: MachineId, state: StateId) {
        let spawned: Vec<Option<MachineId>> =
            self.program[state].spawns().map(|(_, spawn)| spawn.target.map(|(machine, _)| machine)).collect();
        let place = |machine: &MachineId| spawned.iter().position(|&it| it == Some(*machine)).unwrap_or(usize::MAX);
        if let Some(running) = &mut self.running[machine.index()] {
            running.nested.sort_by_key(place);
        }
    }

    /// Where an outer machine is about to leave its state, what started inside stays silent.
    fn settle_started(&mut self, plan: &Plan, machine: MachineId, started: &[MachineId]) {
        if started.contains(&machine) {
            return self.settle(plan, machine);
        }
        let Some(running) = self.running[machine.index()].as_ref().filter(|running| running.decided.is_none()) else {
            return;
        };
        for nested in running.nested.clone() {
            self.settle_started(plan, nested, started);
        }
    }
}
