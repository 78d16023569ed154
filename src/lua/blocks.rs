//! Blocks: compiled, placed, freed. Knows nothing of calling them.

use std::sync::Arc;

use super::bytecode::{self, Kind};
use super::desk::Chunk;
use super::{Block, Cell, Lua, Slot, SyntaxError, source};

impl Lua {
    /// Makes a block of a text: an expression, or statements. `scope`: the variables it can use, inner last.
    ///
    /// # Errors
    /// The text is neither, or assigns something built in, or uses more than 200 variables.
    pub fn compile(&mut self, code: &str, scope: &[(&str, Cell)]) -> Result<Block, SyntaxError> {
        self.unlimited(|lua| lua.compile_unlimited(code, scope))
    }

    fn compile_unlimited(&mut self, code: &str, scope: &[(&str, Cell)]) -> Result<Block, SyntaxError> {
        // SAFETY: nothing runs, and there is no memory limit.
        let (form, bytecode::Read { uses, .. }) = unsafe { source::analyse(self.stack.state(), code)? };
        let bound = self.bind(&uses, scope)?;
        let names: Vec<_> = bound.iter().map(|&(name, _)| name).collect();
        self.chunks += 1;
        let chunk = self.chunks;
        // SAFETY: as before.
        unsafe { source::build(self.stack.state(), code, form, &names, chunk)? };
        self.stack.join(|name| bound.iter().find(|(found, _)| *found == name).map(|(_, cell)| cell.0));
        let block = Block(self.stack.keep());
        let is_written = |name: &str| uses.iter().any(|found| found.kind == Kind::Write && found.name == name);
        let writes = bound.iter().filter(|(name, _)| is_written(name)).map(|&(_, cell)| cell).collect();
        self.note_slot(block.0, Slot::Block { chunk, writes });
        let scope = scope.iter().map(|&(name, _)| name.into()).collect();
        self.desk.chunks.borrow_mut().insert(chunk, Chunk { block: Some(block), place: None, scope });
        Ok(block)
    }

    /// The variables among the free names of a text, each once.
    fn bind<'a>(
        &mut self,
        uses: &[bytecode::Use],
        scope: &[(&'a str, Cell)],
    ) -> Result<Vec<(&'a str, Cell)>, SyntaxError> {
        let mut bound: Vec<(&str, Cell)> = Vec::new();
        for found in uses {
            let Some(&(name, cell)) = scope.iter().rev().find(|(name, _)| *name == found.name) else {
                self.check_builtin(found)?;
                continue;
            };
            if bound.iter().any(|(other, _)| *other == name) {
                continue;
            }
            bound.push((name, cell));
            if bound.len() > source::NAMES {
                let message = format!("more than {} variables in one block: move some into a table", source::NAMES);
                return Err(SyntaxError { message, line: found.line, token: Some(name.to_owned()) });
            }
            // The newest, as a variable can be renamed.
            if let Slot::Variable { name: known, .. } = &mut self.slots[cell.0 as usize]
                && known.as_deref() != Some(name)
            {
                *known = Some(name.into());
            }
        }
        Ok(bound)
    }

    /// What is built in is there for all blocks, so none may replace it.
    fn check_builtin(&self, found: &bytecode::Use) -> Result<(), SyntaxError> {
        let builtin = found.kind == Kind::Write && self.desk.known.borrow().contains(&found.name);
        if !builtin {
            return Ok(());
        }
        let message = format!("'{}' is built in and can't be assigned to; use another name", found.name);
        Err(SyntaxError { message, line: found.line, token: Some(found.name.clone()) })
    }

    /// Gives a block up; its number may be used again.
    pub fn free_block(&mut self, block: Block) {
        if let Some(chunk) = self.chunk(block)
            && let Some(chunk) = self.desk.chunks.borrow_mut().get_mut(&chunk)
        {
            chunk.block = None;
            chunk.scope = Box::default();
        }
        self.note_slot(block.0, Slot::Empty);
        self.stack.release(block.0);
    }

    pub(super) fn chunk(&self, block: Block) -> Option<u32> {
        match self.slots.get(block.0 as usize)? {
            Slot::Block { chunk, .. } => Some(*chunk),
            _ => None,
        }
    }

    /// Where a block is: its first line is line `first_line` (from 1) of `file`. To be called again when an edit moved it.
    pub fn set_place(&mut self, block: Block, file: &Arc<str>, first_line: u32) {
        if let Some(chunk) = self.chunk(block)
            && let Some(chunk) = self.desk.chunks.borrow_mut().get_mut(&chunk)
        {
            chunk.place = Some((Arc::clone(file), first_line));
        }
    }

    /// The variables a block can assign. What it does to a table in a variable isn't among that.
    pub fn writes(&self, block: Block) -> &[Cell] {
        match self.slots.get(block.0 as usize) {
            Some(Slot::Block { writes, .. }) => writes,
            _ => &[],
        }
    }
}
