//! From the texts of a program's files to a program that can be run, or to what keeps it from being one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::files::{Disk, Files};
use super::gather::{Gathered, Gathering};
use super::live::folder;
use super::modules;
use super::plugins::Plugins;
use super::robots::{Offered, offered};
use super::watch::Watched;
use crate::lua::{Access, Checker};
use crate::model::blocks::syntax_diagnostic;
use crate::model::checks::check;
use crate::model::modules::collect;
use crate::model::{Description, File, Program, Robot, alias, resolve_files};
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

pub struct Compiler {
    checker: Checker,
    robots: Vec<Robot>,
    /// What bridges that are no part of lrp offer is asked of them.
    plugins: Plugins,
    files: Box<dyn Files>,
    /// What was read for the last program.
    gathered: Vec<Gathered>,
    reached: Vec<Watched>,
    /// The last good texts of required Lua files: one that can't be read goes on with that.
    lua: BTreeMap<PathBuf, Source>,
}

/// A text that isn't a program; what runs goes on.
pub struct Rejected {
    pub sources: Vec<Source>,
    pub diagnostics: Vec<Diagnostic>,
}

impl Compiler {
    /// For programs on the disk. `robots`: those chosen on the command line.
    pub fn new(robots: Vec<Robot>) -> Compiler {
        Compiler {
            checker: Checker::default(),
            robots,
            plugins: Plugins::default(),
            files: Box::new(Disk),
            gathered: Vec::new(),
            reached: Vec::new(),
            lua: BTreeMap::new(),
        }
    }

    /// For blocks that will have this access.
    pub fn with_access(self, access: Access) -> Compiler {
        Compiler { checker: Checker::new(access), ..self }
    }

    /// For programs whose robots may be plugins.
    pub fn with_plugins(self, plugins: Plugins) -> Compiler {
        Compiler { plugins, ..self }
    }

    /// For programs whose other files come from elsewhere.
    pub fn with_files(self, files: impl Files + 'static) -> Compiler {
        Compiler { files: Box::new(files), ..self }
    }

    /// What keeps the text of a Lua file from being read.
    pub fn check_lua(&mut self, source: &Source, file: FileId) -> Option<Diagnostic> {
        let all = Span::new(file, 0, source.text.len());
        let error = self.checker.check(&source.text).err()?;
        Some(syntax_diagnostic(source, all, &error))
    }

    /// The files besides the program's own that the last text led to, also those that couldn't be read, and their texts
    /// as they were taken.
    pub fn reached(&self) -> &[Watched] {
        &self.reached
    }

    /// A program whose text is named by its path, with the files it imports and requires.
    pub fn compile(&mut self, source: Source) -> Result<Program, Rejected> {
        self.compile_after(source, &Program::default())
    }

    /// A text that is to follow on a program that runs: names may still mean what they did there.
    pub fn compile_after(&mut self, source: Source, running: &Program) -> Result<Program, Rejected> {
        let path = PathBuf::from(&*source.name);
        let Gathering { gathered, reached, diagnostics, .. } = Gathering::of(source, &*self.files, &self.gathered);
        (self.gathered, self.reached) = (gathered, reached);
        let mut found = diagnostics;
        for (index, file) in self.gathered.iter().enumerate() {
            found.extend(file.parsed.diagnostics.iter().cloned());
            if file.parsed.tree.forms.is_empty() && !file.parsed.diagnostics.iter().any(Diagnostic::is_error) {
                found.push(empty(FileId(index as u16)));
            }
        }
        let unread = found.iter().any(Diagnostic::is_error);
        let mut program = self.resolve(running);
        self.collect(&mut program, &folder(&path));
        let is_lua = |finding: &Diagnostic| matches!(finding.code, Code::LuaSyntax | Code::Smalltalk);
        if unread {
            // What can't be read is missing from the tree: what refers to it is not to blame.
            program.findings.retain(is_lua);
        }
        let broken = unread || program.findings.iter().any(is_lua);
        program.findings.splice(0..0, found);
        match broken {
            true => Err(Rejected { sources: program.sources, diagnostics: program.findings }),
            false => {
                let offered = self.offered(&mut program);
                check(&mut program, &offered, &self.checker);
                Ok(program)
            }
        }
    }

    /// What each robot offers, as far as it can be known beforehand.
    fn offered(&self, program: &mut Program) -> Vec<Option<Description>> {
        let mut all = Vec::new();
        for bridge in &program.bridges {
            let span = bridge.span;
            let text = &program.sources[span.file.0 as usize].text[span.start as usize..span.end as usize];
            let Offered { description, findings } = offered(bridge, text, &self.plugins);
            program.findings.extend(findings);
            all.push(description);
        }
        all
    }

    fn resolve(&mut self, running: &Program) -> Program {
        let files: Vec<File> = self.gathered.iter().map(Gathered::file).collect();
        let program = resolve_files(&files, &self.robots, &mut self.checker, None);
        let mut with = |alias| resolve_files(&files, &self.robots, &mut self.checker, Some(alias));
        let carried = alias::carry(running, &program).map(&mut with);
        if let Some(carried) = carried.filter(|carried| alias::serves(running, carried, &program)) {
            return carried;
        }
        let proposed = alias::propose(running, &program).map(with);
        proposed.filter(|proposed| alias::holds(running, proposed)).unwrap_or(program)
    }

    /// The Lua files that the program's blocks require.
    fn collect(&mut self, program: &mut Program, folder: &Path) {
        let mut shelf = Shelf { files: &*self.files, folder, known: &self.lua, reached: &mut self.reached };
        collect(program, |name| shelf.module(name));
        self.lua.retain(|path, _| self.reached.iter().any(|reached| reached.path == *path));
        for index in 0..program.modules.len() {
            let file = program.modules[index].file;
            let source = program.sources[file.0 as usize].clone();
            match self.check_lua(&source, file) {
                Some(mistake) => program.findings.push(mistake),
                None => drop(self.lua.insert(PathBuf::from(&*source.name), source)),
            }
        }
    }
}

/// The Lua files of a program's folder.
struct Shelf<'a> {
    files: &'a dyn Files,
    folder: &'a Path,
    /// The last good texts.
    known: &'a BTreeMap<PathBuf, Source>,
    reached: &'a mut Vec<Watched>,
}

impl Shelf<'_> {
    fn module(&mut self, name: &str) -> Result<Source, String> {
        let path = modules::path(self.folder, name)?;
        let read = match (self.files.read(&path), self.known.get(&path)) {
            (Err(_), Some(known)) => Ok(known.clone()),
            (read, _) => read.map_err(|why| format!("`{name}` can't be required: {why}")),
        };
        let text = read.as_ref().ok().map(|source| source.text.clone());
        if self.reached.iter().all(|reached| reached.path != path) {
            self.reached.push(Watched { path, text });
        }
        read
    }
}

fn empty(file: FileId) -> Diagnostic {
    Diagnostic::error(Code::EmptyProgram, Span::new(file, 0, 0), "there is no program in this file")
        .help("begin with `(machine m (state s)) (spawn m s)`, or make a first program with `lrp new NAME`")
}
