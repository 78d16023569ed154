//! Bringing a machine to a state by hand: as a transition would, or without any action.

use std::rc::Rc;

use super::engine::Engine;
use super::machine::Spawner;
use super::plan::{EntryItem, Plan};
use super::record::{Forced, What};
use crate::model::*;

/// The states to be in from a running machine, or from one to be spawned, down to the wanted state.
struct Way {
    first: (MachineId, StateId),
    then: Vec<(MachineId, StateId)>,
}

impl Engine {
    pub(super) fn force(&mut self, target: StateId, how: Forced) {
        self.rare(What::Force { state: self.program[target].path.clone(), how });
        let plan = Rc::clone(&self.plan);
        let Way { first: (machine, state), then } = self.way_to(target);
        let running = self.runs(machine);
        match how {
            Forced::Transition if running => {
                self.leave(&plan, machine);
                self.enter_on_way(&plan, machine, state, &then);
            }
            Forced::Transition => {
                self.start(machine, state, None);
                self.enter(&plan, machine, state);
            }
            Forced::Jump => {
                if running {
                    self.discard_nested(machine);
                } else {
                    self.start(machine, state, None);
                }
                self.arrive_on_way(machine, state, &then);
            }
        }
        self.forget_exits(machine);
    }

    /// An `exit` that was found to hold right after entry counts no more where its machine was moved since.
    fn forget_exits(&mut self, moved: MachineId) {
        for index in 0..self.running.len() {
            let decided = self.running[index].as_ref().and_then(|running| running.decided);
            let leaves_from = decided.and_then(|fired| fired.via).map(|state| self.program[state].machine);
            if leaves_from.is_some_and(|machine| machine == moved || !self.runs(machine))
                && let Some(running) = &mut self.running[index]
            {
                running.decided = None;
            }
        }
    }

    /// Up from the wanted state to the nearest machine that runs; with none, the machine itself is spawned at top level.
    fn way_to(&self, target: StateId) -> Way {
        let program = &self.program;
        let wanted = (program[target].machine, target);
        let mut then = vec![wanted];
        while let Some(&(machine, _)) = then.last() {
            if self.runs(machine) {
                let first = then.pop().unwrap_or(wanted);
                then.reverse();
                return Way { first, then };
            }
            match program[machine].parent {
                Some(parent) => then.push((program[parent].machine, parent)),
                None => break,
            }
        }
        Way { first: wanted, then: Vec::new() }
    }

    /// Enters a state; what its onentry spawns on the way starts in the state on the way.
    fn enter_on_way(&mut self, plan: &Plan, machine: MachineId, state: StateId, then: &[(MachineId, StateId)]) {
        self.arrive(machine, state);
        if self.breakpoints.are_armed {
            self.meet_state(state);
        }
        let next = then.first().copied();
        for &item in plan.onentry(state) {
            match item {
                EntryItem::Actions(actions) => self.run_all(plan, actions),
                EntryItem::Spawn(index, (nested, start)) => match next {
                    Some((wanted, _)) if wanted == nested && !self.runs(nested) => self.spawn_on_way(plan, state, then),
                    _ => self.spawn(plan, nested, start, Spawner::Entry { state, index }),
                },
            }
        }
        if let Some((wanted, _)) = next
            && !self.runs(wanted)
        {
            self.spawn_on_way(plan, state, then);
        }
    }

    fn spawn_on_way(&mut self, plan: &Plan, by: StateId, then: &[(MachineId, StateId)]) {
        if let Some((&(machine, state), rest)) = then.split_first() {
            self.start(machine, state, Some(by));
            self.enter_on_way(plan, machine, state, rest);
        }
    }

    fn arrive_on_way(&mut self, machine: MachineId, state: StateId, then: &[(MachineId, StateId)]) {
        self.arrive(machine, state);
        if let Some((&(nested, next), rest)) = then.split_first() {
            self.start(nested, next, Some(state));
            self.arrive_on_way(nested, next, rest);
        }
    }
}
