//! The Lua side of a program: its variables as cells and its blocks as compiled functions. Both outlive an edit that
//! doesn't concern them.

use std::collections::{HashMap, VecDeque};
use std::ops::Range;
use std::sync::Arc;

use crate::lua::{self, Cell, Lua, SyntaxError};
use crate::model::{Block, BlockId, MachineId, Matching, Program, VarId};

pub struct Store {
    pub lua: Lua,
    cells: Vec<Cell>,
    blocks: Vec<Compiled>,
    keys: Vec<Key>,
    /// Blocks that are not run again until something about them changes.
    stopped: usize,
}

/// What makes two blocks the same function: their text, the cells of the variables they use, the texts they require.
type Key = (Arc<str>, Box<[Cell]>, Box<[Arc<str>]>);

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
        self.take_over_blocks(new)
    }

    fn take_over_cells(&mut self, old: &Program, new: &Program, matching: &Matching) {
        let mut kept: Vec<Option<Cell>> = vec![None; new.vars.len()];
        for (index, &cell) in self.cells.iter().enumerate().take(old.vars.len()) {
            match matching.var(VarId(index as u32)) {
                Some(now) => kept[now.index()] = Some(cell),
                None => self.lua.free_cell(cell),
            }
        }
        self.cells = kept.into_iter().map(|cell| cell.unwrap_or_else(|| self.lua.cell())).collect();
    }

    fn take_over_blocks(&mut self, new: &Program) -> Vec<Uncompiled> {
        let mut kept: HashMap<Key, VecDeque<Compiled>> = HashMap::new();
        for (key, compiled) in self.keys.drain(..).zip(self.blocks.drain(..)) {
            kept.entry(key).or_default().push_back(compiled);
        }
        self.stopped = 0;
        let mut uncompiled = Vec::new();
        for (index, block) in new.blocks.iter().enumerate() {
            let cells = block.uses.iter().map(|&var| self.cell(var)).collect();
            let texts = block.requires.iter().map(|&module| new.module_text(module).clone()).collect();
            let key = (block.code.clone(), cells, texts);
            let mut compiled = match kept.get_mut(&key).and_then(VecDeque::pop_front) {
                Some(compiled) => compiled,
                None => self.compile(new, block).unwrap_or_else(|error| {
                    uncompiled.push(Uncompiled { block: BlockId(index as u32), error });
                    Compiled::default()
                }),
            };
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
        for function in kept.into_values().flatten().filter_map(|compiled| compiled.lua) {
            self.lua.free_block(function);
        }
        uncompiled
    }

    fn compile(&mut self, program: &Program, block: &Block) -> Result<Compiled, SyntaxError> {
        let bound: Vec<(&str, Cell)> = block.uses.iter().map(|&var| (&*program[var].name, self.cell(var))).collect();
        let function = self.lua.compile(&block.code, &bound)?;
        Ok(Compiled { lua: Some(function), ..Compiled::default() })
    }
}
