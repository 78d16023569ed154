//! A test's program and its files, as the functions of `t` handle them. Knows no program until the test loads one.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use mlua::Table;

use super::bench::{Bench, Setting};
use super::deadline::Deadline;
use super::failure::Complaint;
use super::options::Options;
use super::written::Written;
use crate::runtime::Command;
use crate::session::files::Files;
use crate::syntax::Source;

pub struct Api {
    folder: PathBuf,
    deadline: Deadline,
    bench: RefCell<Option<Bench>>,
    /// The loaded program's file.
    program: RefCell<Option<PathBuf>>,
    /// Texts that the test put in the place of files.
    written: Written,
    /// The program's records by kind, as the test sees them: each becomes a table only once.
    pub told: RefCell<Vec<(String, mlua::Value)>>,
}

impl Api {
    /// `folder`: the test file's, from which it names files.
    pub fn new(folder: &Path, deadline: Deadline) -> Api {
        Api {
            folder: folder.to_path_buf(),
            deadline,
            bench: RefCell::default(),
            program: RefCell::default(),
            written: Written::default(),
            told: RefCell::default(),
        }
    }

    /// The program under test, if there is one.
    pub fn look<R>(&self, f: impl FnOnce(&Bench) -> R) -> Option<R> {
        self.bench.borrow().as_ref().map(f)
    }

    pub fn with<R>(&self, f: impl FnOnce(&mut Bench) -> Result<R, Complaint>) -> Result<R, Complaint> {
        let mut bench = self.bench.borrow_mut();
        let none = || Complaint::new("there is no program yet: begin with `t:load(FILE)` or `t:source(TEXT)`");
        f(bench.as_mut().ok_or_else(none)?)
    }

    pub fn command(&self, command: Command) -> Result<(), Complaint> {
        self.with(|bench| bench.command(command))
    }

    /// Begins anew with the program of a file.
    pub fn load(&self, file: &str, options: Option<&Table>) -> Result<(), Complaint> {
        let path = self.folder.join(file);
        let files = self.written.clone();
        let source = files.read(&path).map_err(|why| Complaint::new(why.to_string()))?;
        let folder = path.parent().unwrap_or(&self.folder).to_path_buf();
        self.start(source, files, folder, options)?;
        *self.program.borrow_mut() = Some(path);
        Ok(())
    }

    /// Begins anew with a program's text, as if it were a file beside the test.
    pub fn source(&self, text: String, options: Option<&Table>) -> Result<(), Complaint> {
        self.program.take();
        let files = self.written.seen_from(&self.folder);
        self.start(Source::new("program.lrp", text), files, self.folder.clone(), options)
    }

    fn start(&self, file: Source, files: Written, folder: PathBuf, options: Option<&Table>) -> Result<(), Complaint> {
        self.bench.take();
        self.told.take();
        let options = Options::read(options)?;
        let library = self.written.library(folder.clone());
        let setting = Setting { file, files, folder, test_folder: self.folder.clone(), library };
        *self.bench.borrow_mut() = Some(Bench::start(setting, &options, self.deadline.clone())?);
        Ok(())
    }

    /// Puts a text in the place of a file. Of the program, or of a file that it imports or requires, that is an edit.
    pub fn write(&self, file: &str, text: String) -> Result<(), Complaint> {
        let path = self.folder.join(file);
        self.written.put(&path, &text);
        let same = |other: &Path| self.written.canonical(other) == self.written.canonical(&path);
        if self.program.borrow().as_deref().is_some_and(same) {
            return self.with(|bench| bench.edit(text));
        }
        match self.bench.borrow_mut().as_mut() {
            Some(bench) => bench.file_changed(&path),
            None => Ok(()),
        }
    }
}
