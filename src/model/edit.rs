//! A program to be taken over, with how it differs from the one that runs: found out beside the engine's thread.

use std::sync::Arc;

use super::breakpoints;
use super::change::Change;
use super::diff::diff;
use super::matching::Matching;
use super::program::Program;

#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    pub program: Arc<Program>,
    prepared: Option<Arc<Comparison>>,
}

/// How a program differs from the one before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    before: Arc<Program>,
    pub matching: Matching,
    /// None where there was no program before: then there is nothing to compare with.
    pub changes: Vec<Change>,
}

impl Edit {
    /// Compared with `before`, which is thought to be what runs.
    pub fn of(before: &Arc<Program>, program: Program) -> Edit {
        let comparison = Comparison::between(before, &program);
        Edit { program: Arc::new(program), prepared: Some(Arc::new(comparison)) }
    }

    /// How it differs from what runs: as prepared, or found out now where another program runs than was thought.
    pub fn comparison(&self, running: &Arc<Program>) -> Arc<Comparison> {
        match &self.prepared {
            Some(prepared) if Arc::ptr_eq(&prepared.before, running) => Arc::clone(prepared),
            _ => Arc::new(Comparison::between(running, &self.program)),
        }
    }
}

/// Not compared with anything yet.
impl From<Arc<Program>> for Edit {
    fn from(program: Arc<Program>) -> Edit {
        Edit { program, prepared: None }
    }
}

impl From<Program> for Edit {
    fn from(program: Program) -> Edit {
        Arc::new(program).into()
    }
}

impl Comparison {
    fn between(before: &Arc<Program>, program: &Program) -> Comparison {
        let matching = Matching::of(before, program);
        let mut changes = Vec::new();
        if !before.sources.is_empty() {
            changes.extend(diff(before, program, &matching));
            changes.extend(breakpoints::changes(before, program, &matching));
        }
        Comparison { before: Arc::clone(before), matching, changes }
    }
}
