//! Which variables changed in a step: only those that a block which ran may have changed are compared.

use super::engine::Engine;
use super::record::What;
use crate::model::{BlockId, VarId};

#[derive(Default)]
pub(super) struct Changes {
    touched: Vec<BlockId>,
}

impl Changes {
    /// A block that uses variables has run.
    pub fn touched(&mut self, block: BlockId) {
        self.touched.push(block);
    }
}

impl Engine {
    pub(super) fn report_changes(&mut self) {
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

    pub(super) fn report(&mut self, var: VarId, by: std::sync::Arc<str>) {
        let value = self.store.lua.get(self.store.cell(var));
        self.rare(What::Set { var: self.program[var].path.clone(), value, by });
    }
}
