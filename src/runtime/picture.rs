//! Looking at an engine from outside, by path: for tests and for those who ask rather than follow the records.

use std::sync::Arc;

use serde_json::Value;

use super::engine::Engine;
use super::record::Fault;
use super::time::Time;
use crate::model::*;

impl Engine {
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// The paths of the active states, in the order in which a step visits them.
    pub fn active(&self) -> Vec<String> {
        let mut paths = Vec::new();
        for &machine in &self.tops {
            self.collect_active(machine, &mut paths);
        }
        paths
    }

    fn collect_active(&self, machine: MachineId, paths: &mut Vec<String>) {
        if let Some(running) = &self.running[machine.index()] {
            paths.push(self.program[running.state].path.to_string());
            for &nested in &running.nested {
                self.collect_active(nested, paths);
            }
        }
    }

    /// The value of a global variable, or of one of a machine that runs.
    pub fn value(&self, path: &str) -> Option<Value> {
        let var = self.program.var(path)?;
        self.is_alive(var).then(|| self.store.lua.get(self.store.cell(var)))
    }

    /// Every variable that has a value now, by path.
    pub fn values(&self) -> Vec<(String, Value)> {
        let vars = self.program.vars.iter().enumerate().map(|(index, var)| (VarId(index as u32), var));
        let alive = vars.filter(|&(id, _)| self.is_alive(id));
        alive.map(|(id, var)| (var.path.to_string(), self.store.lua.get(self.store.cell(id)))).collect()
    }

    pub fn visits(&self, state: &str) -> Option<u64> {
        Some(self.visits[self.program.state(state)?.index()])
    }

    /// When the state that is active in a machine was entered.
    pub fn entered(&self, machine: &str) -> Option<Time> {
        let machine = self.program.machine(machine)?;
        Some(self.running[machine.index()].as_ref()?.entered)
    }

    /// What went wrong since the last edit that concerned it, as it was last reported.
    pub fn faults(&self) -> impl Iterator<Item = Fault> + '_ {
        self.faults.reported()
    }

    pub fn is_paused(&self) -> bool {
        self.paused
    }

    pub fn now(&self) -> Time {
        self.now
    }

    pub fn steps(&self) -> u64 {
        self.step
    }

    /// Whether a variable's scope runs, so that it has a value.
    pub(super) fn is_alive(&self, var: VarId) -> bool {
        self.program[var].machine.is_none_or(|machine| self.running[machine.index()].is_some())
    }
}
