//! Which variables changed in a step: only those that a block which ran may have changed are compared.

use std::sync::Arc;

use super::engine::Engine;
use super::record::What;
use crate::model::{BlockId, Owner, Program, VarId};

#[derive(Default)]
pub(super) struct Changes {
    touched: Vec<BlockId>,
    /// Groups that what was touched belongs to; kept for its memory.
    reached: Vec<usize>,
    reach: Reach,
}

impl Changes {
    /// A block that uses variables has run.
    pub fn touched(&mut self, block: BlockId) {
        self.touched.push(block);
    }

    pub fn follow(&mut self, program: &Program) {
        self.reach = Reach::of(program);
    }
}

/// Variables that meet in some block may share a table or hold a function that changes the others, so what changes one
/// may change them all: they are one group.
#[derive(Default)]
struct Reach {
    /// By variable: which group.
    group: Vec<usize>,
    groups: Vec<Vec<VarId>>,
}

impl Reach {
    fn of(program: &Program) -> Reach {
        let mut group: Vec<usize> = (0..program.vars.len()).collect();
        let mut groups: Vec<Vec<VarId>> = (0..program.vars.len()).map(|index| vec![VarId(index as u32)]).collect();
        for block in &program.blocks {
            let given = match block.owner {
                Owner::Var(var) => Some(var),
                _ => None,
            };
            let mut met = given.iter().chain(&block.uses);
            let Some(first) = met.next() else { continue };
            for other in met {
                let (into, from) = (group[first.index()], group[other.index()]);
                if into != from {
                    let joined = std::mem::take(&mut groups[from]);
                    joined.iter().for_each(|var| group[var.index()] = into);
                    groups[into].extend(joined);
                }
            }
        }
        Reach { group, groups }
    }
}

impl Engine {
    #[inline]
    pub(super) fn report_changes(&mut self) {
        if !self.changes.touched.is_empty() {
            self.compare();
        }
    }

    fn compare(&mut self) {
        let touched = std::mem::take(&mut self.changes.touched);
        for &block in &touched {
            for index in 0..self.program[block].uses.len() {
                let var = self.program[block].uses[index];
                self.report_if_changed(var, &touched);
            }
        }
        self.report_reached(&touched);
        self.changes.touched = touched;
        self.changes.touched.clear();
    }

    /// What blocks changed that don't name it: through a function or a table that another variable holds as well.
    fn report_reached(&mut self, touched: &[BlockId]) {
        let uses = touched.iter().filter_map(|&block| self.program[block].uses.first());
        let mut reached = std::mem::take(&mut self.changes.reached);
        reached.extend(uses.map(|var| self.changes.reach.group[var.index()]));
        reached.sort_unstable();
        reached.dedup();
        for group in reached.drain(..) {
            for index in 0..self.changes.reach.groups[group].len() {
                let var = self.changes.reach.groups[group][index];
                self.report_if_changed(var, touched);
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
