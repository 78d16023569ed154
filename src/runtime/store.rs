//! The Lua side of a program: its variables as cells and its blocks as compiled functions. Both outlive an edit that
//! doesn't concern them.

use std::ops::Range;

use super::reuse::{self, Key};
use crate::lua::{self, Cell, Lua, SyntaxError};
use crate::model::renamed::code_now;
use crate::model::{Block, BlockId, MachineId, Matching, Program, VarId};

pub struct Store {
    pub lua: Lua,
    cells: Vec<Cell>,
    blocks: Vec<Compiled>,
    keys: Vec<Key>,
    /// Blocks that are not run again until something about them changes.
    stopped: usize,
}

#[derive(Clone, Copy, Default)]
pub struct Compiled {
    pub lua: Option<lua::Block>,
    pub machine: Option<MachineId>,
    /// Whether it reads or writes any variable.
    pub uses_variables: bool,
    stopped: bool,
}

pub struct Uncompiled {
    pub block: BlockId,
    pub error: SyntaxError,
}

impl Store {
    pub fn new(lua: Lua) -> Store {
        Store { lua, cells: Vec::new(), blocks: Vec::new(), keys: Vec::new(), stopped: 0 }
    }

    pub fn cell(&self, var: VarId) -> Cell {
        self.cells[var.index()]
    }

    pub fn block(&self, block: BlockId) -> &Compiled {
        &self.blocks[block.index()]
    }

    /// The block that a function was compiled from.
    pub fn find(&self, function: lua::Block) -> Option<BlockId> {
        let index = self.blocks.iter().position(|compiled| compiled.lua == Some(function))?;
        Some(BlockId(index as u32))
    }

    /// The block to run, unless it can't be compiled or was stopped.
    pub fn ready(&self, block: BlockId) -> Option<lua::Block> {
        let compiled = &self.blocks[block.index()];
        compiled.lua.filter(|_| !compiled.stopped)
    }

    /// From `from` on, the next of the blocks to be run: all that are left, or one at a time while any block is stopped.
    #[inline]
    pub fn ready_part(&self, blocks: &[BlockId], from: usize) -> Range<usize> {
        if self.any_stopped() { self.ready_one(blocks, from) } else { from..blocks.len() }
    }

    #[cold]
    fn ready_one(&self, blocks: &[BlockId], from: usize) -> Range<usize> {
        let next = (from..blocks.len()).find(|&index| self.ready(blocks[index]).is_some());
        next.map_or(blocks.len()..blocks.len(), |index| index..index + 1)
    }

    pub fn stop(&mut self, block: BlockId) {
        let compiled = &mut self.blocks[block.index()];
        self.stopped += usize::from(!compiled.stopped);
        compiled.stopped = true;
    }

    pub fn any_stopped(&self) -> bool {
        self.stopped > 0
    }

    pub fn allow_again(&mut self, block: BlockId) {
        let compiled = &mut self.blocks[block.index()];
        self.stopped -= usize::from(compiled.stopped);
        compiled.stopped = false;
    }

    /// Takes over a program: variables that are still there keep their cells, blocks that read the same and see the same
    /// variables keep their functions.
    pub fn take_over(&mut self, old: &Program, new: &Program, matching: &Matching) -> Vec<Uncompiled> {
        self.take_over_cells(old, new, matching);
        let stopped = self.stopped_and_renamed(old, new, matching);
        self.take_over_blocks(new, &stopped)
    }

    /// Blocks that are not run again, as they read with renamed variables.
    fn stopped_and_renamed(&self, old: &Program, new: &Program, matching: &Matching) -> Vec<Key> {
        if !self.any_stopped() {
            return Vec::new();
        }
        let stopped = (0..self.blocks.len()).filter(|&index| self.blocks[index].stopped);
        let codes =
            stopped.filter_map(|index| Some((index, code_now(old, BlockId(index as u32), new, matching).ok()?)));
        let renamed = codes.filter(|(index, code)| old.blocks[*index].code != *code);
        renamed.map(|(index, code)| self.keys[index].reading(code)).collect()
    }

    fn take_over_cells(&mut self, old: &Program, new: &Program, matching: &Matching) {
        let mut kept: Vec<Option<Cell>> = vec![None; new.vars.len()];
        let mut gone = Vec::new();
        for (index, &cell) in self.cells.iter().enumerate().take(old.vars.len()) {
            match matching.var(VarId(index as u32)) {
                Some(now) => kept[now.index()] = Some(cell),
                None => gone.push(cell),
            }
        }
        self.cells = kept.into_iter().map(|cell| cell.unwrap_or_else(|| self.lua.cell())).collect();
        // Only now, so that no new variable gets the cell of one that is gone: blocks are known by their cells.
        gone.into_iter().for_each(|cell| self.lua.free_cell(cell));
    }

    fn take_over_blocks(&mut self, new: &Program, renamed: &[Key]) -> Vec<Uncompiled> {
        let pairs = reuse::pairs(&self.keys, new, &self.cells);
        let mut keys: Vec<Option<Key>> = self.keys.drain(..).map(Some).collect();
        let old: Vec<Compiled> = std::mem::take(&mut self.blocks);
        self.stopped = 0;
        let mut uncompiled = Vec::new();
        for ((index, block), pair) in new.blocks.iter().enumerate().zip(pairs) {
            let kept = pair.and_then(|pair| Some((keys[pair].take()?, old[pair])));
            let (key, mut compiled) = kept.unwrap_or_else(|| {
                let key = Key::of(new, block, &self.cells);
                let mut compiled = self.compile(new, block).unwrap_or_else(|error| {
                    uncompiled.push(Uncompiled { block: BlockId(index as u32), error });
                    Compiled::default()
                });
                compiled.stopped = renamed.iter().any(|stopped| stopped.is_renamed(&key));
                (key, compiled)
            });
            compiled.machine = block.machine;
            compiled.uses_variables = !block.uses.is_empty();
            if let Some(function) = compiled.lua {
                let source = new.source(block.span);
                self.lua.set_place(function, &source.name, source.line(block.span.start as usize) as u32);
            }
            self.stopped += usize::from(compiled.stopped);
            self.blocks.push(compiled);
            self.keys.push(key);
        }
        let gone = keys.iter().zip(&old).filter(|(key, _)| key.is_some());
        gone.filter_map(|(_, compiled)| compiled.lua).for_each(|function| self.lua.free_block(function));
        uncompiled
    }

    fn compile(&mut self, program: &Program, block: &Block) -> Result<Compiled, SyntaxError> {
        let renamed = program.alias.iter().filter_map(|alias| {
            let var = block.uses.iter().find(|&&var| alias.means == var.into())?;
            Some((&*alias.name, self.cell(*var)))
        });
        let own = block.uses.iter().map(|&var| (&*program[var].name, self.cell(var)));
        // What is really called so counts before what was.
        let bound: Vec<(&str, Cell)> = renamed.chain(own).collect();
        let function = match &block.precompiled {
            Some(precompiled) => self.lua.load(precompiled, &bound)?,
            None => self.lua.compile(&block.code, &bound)?,
        };
        Ok(Compiled { lua: Some(function), ..Compiled::default() })
    }
}
