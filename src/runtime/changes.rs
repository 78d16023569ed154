//! Which variables changed in a step: only those that a block which ran may have changed are compared.

use super::engine::Engine;
use super::record::What;
use crate::model::{BlockId, VarId};

#[derive(Default)]
pub(super) struct Changes {
    initialised: Vec<VarId>,
    touched: Vec<BlockId>,
}

impl Changes {
    pub fn initialised(&mut self, var: VarId) {
        self.initialised.push(var);
    }

    /// A block that uses variables has run.
    pub fn touched(&mut self, block: BlockId) {
        self.touched.push(block);
    }
}

impl Engine {
    pub(super) fn report_changes(&mut self) {
        self.report_initialised();
        let touched = std::mem::take(&mut self.changes.touched);
        for &block in &touched {
            for index in 0..self.program[block].uses.len() {
                let var = self.program[block].uses[index];
                if self.store.lua.changed(self.store.cell(var)) && self.is_alive(var) {
                    self.report(var, self.program.owner_path(block));
                }
            }
        }
        self.changes.touched = touched;
        self.changes.touched.clear();
    }

    fn report_initialised(&mut self) {
        let initialised = std::mem::take(&mut self.changes.initialised);
        for &var in &initialised {
            if self.is_alive(var) {
                self.store.lua.changed(self.store.cell(var));
                self.report(var, "init".into());
            }
        }
        self.changes.initialised = initialised;
        self.changes.initialised.clear();
    }

    pub(super) fn report(&mut self, var: VarId, by: std::sync::Arc<str>) {
        let value = self.store.lua.get(self.store.cell(var));
        self.rare(What::Set { var: self.program[var].path.clone(), value, by });
    }
}
