//! Which variables changed in a step: only those that a block which ran may have changed are compared.

use std::sync::Arc;

use super::engine::Engine;
use super::reach::{Group, Reach};
use super::record::What;
use crate::model::{BlockId, Program, VarId};

#[derive(Default)]
pub(super) struct Changes {
    touched: Vec<BlockId>,
    reach: Reach,
    /// Groups that were reached in a step; kept for its memory.
    reached: Vec<Group>,
    /// A robot said something of a call that a variable may hold.
    answered: Option<Arc<str>>,
}

impl Changes {
    /// A block that uses variables has run.
    pub fn touched(&mut self, block: BlockId) {
        self.touched.push(block);
    }

    /// A robot has changed what a call's value tells.
    pub fn answered(&mut self, bridge: &Arc<str>) {
        self.answered = Some(Arc::clone(bridge));
    }

    pub fn follow(&mut self, program: &Program) {
        self.reach = Reach::of(program);
    }
}

impl Engine {
    #[inline]
    pub(super) fn report_changes(&mut self) {
        if !self.changes.touched.is_empty() {
            self.compare();
        }
        if let Some(bridge) = self.changes.answered.take() {
            self.report_answered(&bridge);
        }
    }

    /// Any variable may hold the call that was answered.
    fn report_answered(&mut self, bridge: &Arc<str>) {
        for index in 0..self.program.vars.len() {
            let var = VarId(index as u32);
            if self.store.lua.changed(self.store.cell(var)) && self.is_alive(var) {
                self.report(var, Arc::clone(bridge));
            }
        }
    }

    fn compare(&mut self) {
        let touched = std::mem::take(&mut self.changes.touched);
        let mut reaches_others = false;
        for &block in &touched {
            for index in 0..self.program[block].uses.len() {
                let var = self.program[block].uses[index];
                self.report_if_changed(var, &touched);
                reaches_others |= self.store.lua.is_shared(self.store.cell(var));
            }
        }
        if reaches_others {
            self.report_reached(&touched);
        }
        self.changes.touched = touched;
        self.changes.touched.clear();
    }

    /// What blocks changed that don't name it: through a function or a table that another variable holds as well.
    fn report_reached(&mut self, touched: &[BlockId]) {
        let uses = touched.iter().filter_map(|&block| self.program[block].uses.first().copied());
        let mut reached = std::mem::take(&mut self.changes.reached);
        self.changes.reach.groups_of(uses, &mut reached);
        for group in reached.drain(..) {
            for index in 0..self.changes.reach.vars(group).len() {
                self.report_if_changed(self.changes.reach.vars(group)[index], touched);
            }
        }
        self.changes.reached = reached;
    }

    fn report_if_changed(&mut self, var: VarId, touched: &[BlockId]) {
        if self.store.lua.changed(self.store.cell(var)) && self.is_alive(var) {
            self.report(var, self.changed_by(var, touched));
        }
    }

    /// The last block that ran and assigns a variable; else the last that uses it; else the last of all.
    fn changed_by(&self, var: VarId, touched: &[BlockId]) -> Arc<str> {
        let cell = self.store.cell(var);
        let assigns =
            |block: BlockId| self.store.block(block).lua.is_some_and(|lua| self.store.lua.writes(lua).contains(&cell));
        let newest = || touched.iter().rev().copied();
        let block = newest().find(|&block| assigns(block));
        let block = block.or_else(|| newest().find(|&block| self.program[block].uses.contains(&var)));
        block.or_else(|| newest().next()).map(|block| self.program.owner_path(block)).unwrap_or_default()
    }

    pub(super) fn report(&mut self, var: VarId, by: Arc<str>) {
        let value = self.store.lua.get(self.store.cell(var));
        self.rare(What::Set { var: self.program[var].path.clone(), value, by });
    }
}
