//! The variables outside all machines: one name space over all files, in which the importer's initial value counts.

use std::collections::HashMap;

use super::ids::VarId;
use super::names::Names;
use super::program::Program;
use super::resolve::Resolver;
use crate::syntax::ast::Form;
use crate::syntax::{Code, FileId, Span};

impl Resolver<'_> {
    /// Those that no file before this one declares.
    pub(super) fn declare_globals(&mut self, file: FileId) {
        let mut here: HashMap<&str, Span> = HashMap::new();
        for form in &self.files[file.0 as usize].tree.forms {
            let Form::Var(var) = form else { continue };
            if let Some(&first) = here.get(&*var.name.text) {
                self.redeclared(Code::Duplicate, var, first);
                continue;
            }
            here.insert(&var.name.text, var.name.span);
            if Names::of(&self.program).var(None, &var.name.text).is_some() {
                self.ignored.push(&var.init);
            } else if let Some(id) = self.declare_var(var, None) {
                self.program.globals.push(id);
            }
        }
    }
}

/// Those of imported files before those of their importers, in the order written; but first what an initial value of
/// another file reads. `files`: importers first.
pub fn initialisation_order(program: &Program, files: &[FileId]) -> Vec<VarId> {
    let place = |file: FileId| files.iter().position(|&it| it == file);
    let mut globals = program.globals.clone();
    globals.sort_by_key(|&var| (std::cmp::Reverse(place(program[var].span.file)), program[var].span.start));
    let mut order = Vec::with_capacity(globals.len());
    let mut seen = vec![false; program.vars.len()];
    globals.into_iter().for_each(|var| put(program, var, &mut seen, &mut order));
    order
}

fn put(program: &Program, var: VarId, seen: &mut [bool], order: &mut Vec<VarId>) {
    if std::mem::replace(&mut seen[var.index()], true) {
        return;
    }
    let place = |var: VarId| program[var].span;
    for &read in &program[program[var].init].uses {
        // Of one file, the order written counts.
        if place(read).file != place(var).file || place(read).start < place(var).start {
            put(program, read, seen, order);
        }
    }
    order.push(var);
}
