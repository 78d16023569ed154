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
}
