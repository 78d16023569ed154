//! Blocks: compiled, placed, freed. Knows nothing of calling them.

use std::sync::Arc;

use super::desk::Chunk;
use super::{Block, Cell, Lua, NameUse, Precompiled, Slot, SyntaxError, source};

impl Lua {
    /// Makes a block of a text: an expression, or statements. `scope`: the variables it can use, inner last.
    ///
    /// # Errors
    /// The text is neither, or assigns something built in, or uses more than 200 variables.
    pub fn compile(&mut self, code: &str, scope: &[(&str, Cell)]) -> Result<Block, SyntaxError> {
        let facts = Arc::new(self.facts(code)?);
        let mut variables: Vec<&str> = Vec::new();
        for NameUse { name, .. } in facts.reads.iter().chain(&facts.writes) {
            if find(scope, name).is_some() && !variables.contains(&&**name) {
                variables.push(name);
            }
        }
        let precompiled = self.precompile(code, &facts, &variables)?;
        let block = self.load(&precompiled, scope)?;
        let names = scope.iter().map(|&(name, _)| name.into()).collect();
        self.with_chunk(block, |chunk| chunk.scope = names);
        Ok(block)
    }

    /// Makes a block of one that was compiled before. `scope`: the variables, inner last.
    ///
    /// # Errors
    /// It assigns something built in.
    pub fn load(&mut self, precompiled: &Precompiled, scope: &[(&str, Cell)]) -> Result<Block, SyntaxError> {
        precompiled.other_writes().try_for_each(|found| self.check_builtin(found))?;
        let chunk = self.desk.chunks.borrow().len() as u32;
        self.unlimited(|lua| {
            // SAFETY: nothing runs, there is no memory limit, and the bytecode is what was made of the block's text.
            unsafe { source::load_built(lua.stack.state(), &precompiled.named(chunk)) }
        })?;
        self.stack.join(|name| find(scope, name).map(|cell| cell.0));
        let block = Block(self.stack.keep());
        let mut writes = Vec::new();
        for name in precompiled.variables() {
            let Some(cell) = find(scope, name) else { continue };
            self.call_variable(cell, name);
            writes.extend(precompiled.writes(name).then_some(cell));
        }
        self.note_slot(block.0, Slot::Block { chunk, writes: writes.into() });
        let scope = precompiled.scope();
        self.desk.chunks.borrow_mut().push(Chunk { block: Some(block), place: None, scope });
        Ok(block)
    }

    /// The newest name counts, as a variable can be renamed.
    fn call_variable(&mut self, cell: Cell, name: &str) {
        if let Slot::Variable { name: known, .. } = &mut self.slots[cell.0 as usize]
            && known.as_deref() != Some(name)
        {
            *known = Some(name.into());
        }
    }

    /// What is built in is there for all blocks, so none may replace it.
    fn check_builtin(&self, found: &NameUse) -> Result<(), SyntaxError> {
        if !self.desk.known.borrow().contains(&found.name) {
            return Ok(());
        }
        let message = format!("'{}' is built in and can't be assigned to; use another name", found.name);
        Err(SyntaxError { message, line: found.line, token: Some(found.name.clone()) })
    }

    /// Gives a block up; its number may be used again.
    pub fn free_block(&mut self, block: Block) {
        self.with_chunk(block, |chunk| {
            chunk.block = None;
            chunk.scope = Arc::default();
        });
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
        self.with_chunk(block, |chunk| chunk.place = Some((Arc::clone(file), first_line)));
    }

    fn with_chunk(&self, block: Block, change: impl FnOnce(&mut Chunk)) {
        if let Some(chunk) = self.chunk(block) {
            change(&mut self.desk.chunks.borrow_mut()[chunk as usize]);
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

fn find(scope: &[(&str, Cell)], name: &str) -> Option<Cell> {
    scope.iter().rev().find(|(known, _)| *known == name).map(|&(_, cell)| cell)
}
