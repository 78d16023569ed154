//! The facts of blocks that were looked at before, and their bytecode, by their text, so that an edit costs no more than
//! what it changes. Knows nothing of how these are found.

use std::collections::HashMap;
use std::sync::Arc;

use super::{Facts, Precompiled};

/// Programs that a text is remembered for after the last one it was in: a save with a mistake in it, and one that takes
/// it back.
const REMEMBERED: u64 = 2;

#[derive(Default)]
pub(super) struct Known {
    blocks: HashMap<Arc<str>, Block>,
    programs: u64,
}

struct Block {
    facts: Arc<Facts>,
    /// The number of the last program it was in.
    program: u64,
    /// For each choice of the names that are variables.
    precompiled: Vec<Arc<Precompiled>>,
}

impl Known {
    pub fn get(&mut self, code: &str) -> Option<Arc<Facts>> {
        let block = self.blocks.get_mut(code)?;
        block.program = self.programs;
        Some(block.facts.clone())
    }

    pub fn insert(&mut self, code: Arc<str>, facts: Arc<Facts>) {
        self.blocks.insert(code, Block { facts, program: self.programs, precompiled: Vec::new() });
    }

    pub fn precompiled(&self, code: &str, variables: &[&str]) -> Option<Arc<Precompiled>> {
        self.blocks.get(code)?.precompiled.iter().find(|known| known.variables().eq(variables.iter().copied())).cloned()
    }

    /// Of a block that is known.
    pub fn insert_precompiled(&mut self, code: &str, precompiled: Arc<Precompiled>) {
        if let Some(block) = self.blocks.get_mut(code) {
            block.precompiled.push(precompiled);
        }
    }

    /// What comes now is of another program.
    pub fn next_program(&mut self) {
        self.programs += 1;
        let oldest = self.programs.saturating_sub(REMEMBERED);
        self.blocks.retain(|_, block| block.program >= oldest);
    }
}
