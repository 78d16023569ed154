//! The files of a program: whose declarations count, and which machines are known where. Knows nothing of disks.

use std::sync::Arc;

use super::element::Alias;
use super::ids::MachineId;
use super::resolve::Resolver;
use crate::syntax::ast::{self, Form, Tree};
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

/// How many files a program may have, and how many Lua files its blocks may require by literal names.
pub const MOST: usize = 1000;

/// A file that was read.
pub struct File<'t> {
    pub source: Source,
    pub tree: &'t Tree,
    /// Where each import form leads, in the order written; nowhere where there is nothing to be read.
    pub imports: Vec<Option<FileId>>,
    /// What begins the paths of machines that only this file knows; of no other file, and without `/`.
    pub qualifier: String,
}

impl<'t> File<'t> {
    fn machines(&self) -> impl Iterator<Item = &'t Arc<str>> {
        self.tree.forms.iter().filter_map(|form| match form {
            Form::Machine(machine) => Some(&machine.name.text),
            _ => None,
        })
    }

    pub(super) fn exports(&self) -> impl Iterator<Item = &'t ast::Name> {
        self.tree.forms.iter().filter_map(|form| match form {
            Form::Export(export) => Some(&export.machine),
            _ => None,
        })
    }

    fn imports(&self) -> impl DoubleEndedIterator<Item = (&'t ast::Name, FileId)> {
        let forms = self.tree.forms.iter().filter_map(|form| match form {
            Form::Import(import) => Some(&import.file),
            _ => None,
        });
        let led = forms.zip(&self.imports).filter_map(|(name, file)| Some((name, (*file)?)));
        led.collect::<Vec<_>>().into_iter()
    }
}

/// All files: each before those it imports, else in the order in which they are first imported, depth first.
pub fn precedence(files: &[File]) -> Vec<FileId> {
    let mut order = Vec::new();
    visit(files, FileId(0), &mut vec![false; files.len()], &mut order);
    order.reverse();
    order
}

/// From the last file to the first.
fn visit(files: &[File], file: FileId, seen: &mut [bool], order: &mut Vec<FileId>) {
    if std::mem::replace(&mut seen[file.0 as usize], true) {
        return;
    }
    for (_, imported) in files[file.0 as usize].imports().rev() {
        visit(files, imported, seen, order);
    }
    order.push(file);
}

/// An import of a file that is being imported.
struct Cycle {
    /// At the import that closes it.
    span: Span,
    /// The names of the files, from the one that is imported again to itself.
    chain: String,
}

fn cycles(files: &[File]) -> Vec<Cycle> {
    let mut found = Vec::new();
    close(files, FileId(0), &mut Vec::new(), &mut vec![false; files.len()], &mut found);
    found
}

fn close(files: &[File], file: FileId, open: &mut Vec<FileId>, seen: &mut [bool], found: &mut Vec<Cycle>) {
    seen[file.0 as usize] = true;
    open.push(file);
    for (name, imported) in files[file.0 as usize].imports() {
        if let Some(from) = open.iter().position(|&it| it == imported) {
            let names = open[from..].iter().chain([&imported]).map(|it| &*files[it.0 as usize].source.name);
            found.push(Cycle { span: name.span, chain: names.collect::<Vec<_>>().join(" -> ") });
        } else if !seen[imported.0 as usize] {
            close(files, imported, open, seen, found);
        }
    }
    open.pop();
}

impl Resolver<'_> {
    fn file(&self, file: FileId) -> &File<'_> {
        &self.files[file.0 as usize]
    }

    /// The machine that is declared next: the bare name of one of the program's own machines or of an exported one; other files' own begin with the file.
    pub(super) fn top_path(&self, machine: &ast::Machine) -> Arc<str> {
        let (name, file) = (&machine.name.text, machine.span.file);
        let id = MachineId(self.program.machines.len() as u32);
        let exported = || self.file(file).exports().any(|export| export.text == *name || self.was_called(id, export));
        let taken = || self.program.tops.iter().any(|&top| self.program[top].path == *name);
        match file == FileId(0) || exported() && !taken() {
            true => name.clone(),
            false => format!("{}:{name}", self.file(file).qualifier).into(),
        }
    }

    /// What files export becomes known in those that import them.
    pub(super) fn share_machines(&mut self) {
        let exported = self.exported();
        self.check_exports(&exported);
        let cycles = cycles(self.files);
        for file in self.files {
            for (name, imported) in file.imports() {
                if !cycles.iter().any(|cycle| cycle.span == name.span) {
                    self.check_import(name, imported, &exported[imported.0 as usize]);
                }
                for &machine in &exported[imported.0 as usize] {
                    self.import(name, machine);
                }
            }
        }
        for Cycle { span, chain } in cycles {
            let message = format!("this import closes a circle: {chain}");
            let help = "it works, as each file is read once; move what both need into a file of its own";
            self.diagnostics.push(Diagnostic::warning(Code::ImportCycle, span, message).help(help));
        }
        for machine in exported.into_iter().flatten() {
            if !self.program.exported.contains(&machine) {
                self.program.exported.push(machine);
            }
        }
        self.check_spawns();
    }

    /// By file. An export may hand on what is imported from a file that is itself still to be looked at.
    fn exported(&self) -> Vec<Vec<MachineId>> {
        let mut exported: Vec<Vec<MachineId>> = vec![Vec::new(); self.files.len()];
        let mut grown = true;
        while std::mem::take(&mut grown) {
            for (index, file) in self.files.iter().enumerate() {
                for export in file.exports() {
                    let own = self.program.spawnable[index].iter();
                    let others = file.imports().map(|(_, imported)| exported[imported.0 as usize].clone());
                    let known: Vec<MachineId> = own.copied().chain(others.flatten()).collect();
                    let named = known.iter().find(|&&it| self.program[it].name == export.text);
                    let found = named.or_else(|| known.iter().find(|&&it| self.was_called(it, export))).copied();
                    if let Some(machine) = found.filter(|it| !exported[index].contains(it)) {
                        exported[index].push(machine);
                        grown = true;
                    }
                }
            }
        }
        exported
    }

    /// Whether an export still names a machine as it was called before it was renamed.
    fn was_called(&self, machine: MachineId, export: &ast::Name) -> bool {
        let named = |alias: &Alias| alias.means == machine.into() && alias.name == export.text;
        self.alias.as_ref().is_some_and(named)
    }

    fn check_exports(&mut self, exported: &[Vec<MachineId>]) {
        for (index, file) in self.files.iter().enumerate() {
            for export in file.exports() {
                if exported[index].iter().any(|&it| self.program[it].name == export.text) {
                    continue;
                }
                let others = file.imports().flat_map(|(_, imported)| &exported[imported.0 as usize]);
                let own = self.program.spawnable[index].iter();
                let known: Vec<Arc<str>> = own.chain(others).map(|&it| self.program[it].name.clone()).collect();
                self.unknown(Code::UnknownMachine, "machine", export, known.iter().map(|name| &**name));
            }
        }
    }

    /// An import that brings nothing; one of variables only is fine.
    fn check_import(&mut self, import: &ast::Name, imported: FileId, exported: &[MachineId]) {
        let file = self.file(imported);
        let machines: Vec<&str> = file.machines().map(|name| &**name).collect();
        let any_var = file.tree.forms.iter().any(|form| matches!(form, Form::Var(_)));
        if !exported.is_empty() || machines.is_empty() && any_var {
            return;
        }
        let name = &file.source.name;
        let help = match &*machines {
            [] => format!("`{name}` declares no machine and no variable of its own"),
            [first, ..] => {
                let listed: Vec<String> = machines.iter().map(|machine| format!("`{machine}`")).collect();
                format!("it declares {}: add `(export {first})` to `{name}`", listed.join(", "))
            }
        };
        let message = format!("`{}` exports no machine", import.text);
        self.diagnostics.push(Diagnostic::warning(Code::NothingExported, import.span, message).help(help));
    }

    fn import(&mut self, import: &ast::Name, machine: MachineId) {
        let into = import.span.file;
        let known = &self.program.spawnable[into.0 as usize];
        let Some(&twin) = known.iter().find(|&&it| self.program[it].name == self.program[machine].name) else {
            return self.program.spawnable[into.0 as usize].push(machine);
        };
        if twin == machine {
            return;
        }
        let name = &self.program[machine].name;
        let message =
            format!("`{}` exports a machine `{name}`, but there is one already; it is not imported", import.text);
        self.diagnostics.push(
            Diagnostic::error(Code::Duplicate, import.span, message)
                .also(self.program[twin].name_span, "this one is used")
                .also(self.program[machine].name_span, "this one is not imported")
                .help("rename one of them"),
        );
    }
}
