//! Which of the compiled blocks of one program the next one goes on with: those that read the same and use the same
//! variables and Lua files. Knows nothing of compiling.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use crate::lua::Cell;
use crate::model::{Block, Program};

/// What makes two blocks the same function: their text, the cells of the variables they use, the texts they require.
#[derive(PartialEq, Eq, Hash)]
pub struct Key {
    code: Arc<str>,
    cells: Box<[Cell]>,
    required: Box<[Arc<str>]>,
}

/// How far a block is looked for beyond its place in the old order. Most are right there, so hardly any is looked for
/// among all.
const NEAR: usize = 16;

impl Key {
    pub fn of(program: &Program, block: &Block, cells: &[Cell]) -> Key {
        Key {
            code: block.code.clone(),
            cells: block.uses.iter().map(|var| cells[var.index()]).collect(),
            required: required(program, block).cloned().collect(),
        }
    }

    /// The same with another text.
    pub fn reading(&self, code: Arc<str>) -> Key {
        Key { code, cells: self.cells.clone(), required: self.required.clone() }
    }

    /// Whether it is the same text of the same variables, though under other names they come in another order.
    pub fn is_renamed(&self, other: &Key) -> bool {
        let all = |a: &Key, b: &Key| a.cells.iter().all(|cell| b.cells.contains(cell));
        self.code == other.code && self.required == other.required && all(self, other) && all(other, self)
    }

    fn is_of(&self, program: &Program, block: &Block, cells: &[Cell]) -> bool {
        self.code == block.code
            && self.cells.iter().copied().eq(block.uses.iter().map(|var| cells[var.index()]))
            && self.required.iter().eq(required(program, block))
    }
}

fn required<'p>(program: &'p Program, block: &'p Block) -> impl Iterator<Item = &'p Arc<str>> {
    block.requires.iter().map(|&module| program.module_text(module))
}

/// For each block the old one that is the same, each old one once. `cells`: of the variables, by their ids.
pub fn pairs(old: &[Key], program: &Program, cells: &[Cell]) -> Vec<Option<usize>> {
    let mut pairs = in_order(old, program, cells);
    if pairs.contains(&None) {
        let mut left = left_over(old, &pairs);
        for (pair, block) in pairs.iter_mut().zip(&program.blocks).filter(|(pair, _)| pair.is_none()) {
            *pair = left.get_mut(&Key::of(program, block, cells)).and_then(VecDeque::pop_front);
        }
    }
    pairs
}

fn in_order(old: &[Key], program: &Program, cells: &[Cell]) -> Vec<Option<usize>> {
    let mut next = 0;
    let find = |block: &Block| {
        let found = (next..old.len().min(next + NEAR)).find(|&index| old[index].is_of(program, block, cells))?;
        next = found + 1;
        Some(found)
    };
    program.blocks.iter().map(find).collect()
}

fn left_over<'k>(old: &'k [Key], pairs: &[Option<usize>]) -> HashMap<&'k Key, VecDeque<usize>> {
    let mut free = vec![true; old.len()];
    pairs.iter().flatten().for_each(|&index| free[index] = false);
    let mut left: HashMap<&Key, VecDeque<usize>> = HashMap::new();
    for (index, key) in old.iter().enumerate().filter(|&(index, _)| free[index]) {
        left.entry(key).or_default().push_back(index);
    }
    left
}
