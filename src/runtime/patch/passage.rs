//! From one program to the next: which element of the new one an element of the old one is.

use std::sync::Arc;

use crate::model::*;

pub(super) struct Passage<'p> {
    pub old: &'p Program,
    pub new: &'p Program,
    pub matching: &'p Matching,
}

impl Passage<'_> {
    /// What an old machine is called now, or was called last.
    pub fn path(&self, machine: MachineId) -> Arc<str> {
        match self.matching.machine(machine) {
            Some(now) => self.new[now].path.clone(),
            None => self.old[machine].path.clone(),
        }
    }

    /// By new state: the old one it was.
    pub fn states_before(&self) -> Vec<Option<StateId>> {
        let mut before = vec![None; self.new.states.len()];
        for was in (0..self.old.states.len() as u32).map(StateId) {
            if let Some(now) = self.matching.state(was) {
                before[now.index()] = Some(was);
            }
        }
        before
    }

    /// By new variable: the old one it was.
    pub fn vars_before(&self) -> Vec<Option<VarId>> {
        let mut before = vec![None; self.new.vars.len()];
        for was in (0..self.old.vars.len() as u32).map(VarId) {
            if let Some(now) = self.matching.var(was) {
                before[now.index()] = Some(was);
            }
        }
        before
    }
}
