//! Every save of a program's files becomes a command: its text is compiled here, beside the engine's thread, which only
//! takes finished programs over. Imported and required files are part of the program; worlds, and Lua files whose names
//! blocks make up while they run, are watched like it.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, JoinHandle};

use super::compile::{Compiler, Rejected};
use super::engine_thread::{Commands, Library};
use super::loader::Unreadable;
use super::settled::Settled;
use super::watch::{Saved, Watch, Watched};
use super::{findings, loader, modules, robots};
use crate::model::{Edit, Program};
use crate::runtime::Command;
use crate::runtime::record::Finding;
use crate::syntax::{FileId, Source};

/// Ends when dropped.
pub struct Edits {
    notes: Sender<Note>,
    thread: Option<JoinHandle<()>>,
}

enum Note {
    Saved(Saved),
    /// A block has read this Lua file, with this text: another one is news, however soon it comes.
    Required(PathBuf, Arc<str>),
    End,
}

/// What is heard before there is an engine to tell: files that blocks require.
pub struct Heard {
    notes: Sender<Note>,
    inbox: Receiver<Note>,
}

impl Heard {
    pub fn listen() -> Heard {
        let (notes, inbox) = channel();
        Heard { notes, inbox }
    }

    /// The Lua files of a folder, each reported when it is read.
    pub fn library(&self, folder: PathBuf) -> Library {
        let notes = self.notes.clone();
        modules::library(folder, move |path, text| {
            drop(notes.send(Note::Required(path.to_path_buf(), text.into())));
        })
    }

    /// Loads the first text of `file`, then every save of it; the compiler is made on the thread that uses it, and reads
    /// files as they last settled. Fails only where no thread can be started.
    pub fn watch(
        self,
        file: PathBuf,
        first: Source,
        compiler: impl FnOnce() -> Compiler + Send + 'static,
        commands: Commands,
    ) -> io::Result<Edits> {
        let saves = self.notes.clone();
        let known = Watched { path: file.clone(), text: Some(Arc::clone(&first.text)) };
        let watch = Watch::new([known], move |saved| drop(saves.send(Note::Saved(saved))))?;
        let inbox = self.inbox;
        let thread = Builder::new().name("edits".to_string()).spawn(move || {
            let settled = Settled::default();
            let compiler = compiler().with_files(settled.clone());
            let (running, beside, required) = Default::default();
            let desk = Desk { file, source: first, compiler, settled, watch, commands, running, beside, required };
            desk.work(&inbox);
        })?;
        Ok(Edits { notes: self.notes, thread: Some(thread) })
    }
}

impl Drop for Edits {
    fn drop(&mut self) {
        // A thread that has ended already was heard of when it did.
        let _ = self.notes.send(Note::End);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Desk {
    /// The program.
    file: PathBuf,
    /// Its text as last saved.
    source: Source,
    compiler: Compiler,
    /// What the compiler reads.
    settled: Settled,
    watch: Watch,
    commands: Commands,
    /// What ran at the last save: held until the next one, so that it is dropped here and not on the engine's thread.
    running: Arc<Program>,
    /// Files that the robots read, and what was in them when they were last looked at.
    beside: BTreeMap<PathBuf, Option<Arc<str>>>,
    /// Lua files that blocks have read while they ran, as they were read or saved last.
    required: BTreeMap<PathBuf, Arc<str>>,
}

impl Desk {
    fn work(mut self, inbox: &Receiver<Note>) {
        self.load();
        for note in inbox {
            match note {
                Note::Saved(saved) => self.saved(saved),
                Note::Required(path, text) => {
                    self.required.insert(path, text);
                    self.watch_all();
                }
                Note::End => return,
            }
        }
    }

    fn saved(&mut self, saved: Saved) {
        match saved {
            // The watch may have heard of a text after it told of the next one, and tells that again.
            Saved::Text { path, text } if self.known(&path) == Some(Some(&text)) => self.settled.put(path, text),
            Saved::Text { path, text } if path == self.file => {
                self.source = Source::new(path.display().to_string(), text);
                self.load();
            }
            Saved::Text { path, text } if self.taken(&path).is_some() => {
                self.settled.put(path, text);
                self.load();
            }
            saved => {
                let told = self.told(saved);
                self.commands.send(told);
            }
        }
    }

    /// The text with which a file is part of the program, none while it can't be read; nothing for other files.
    fn taken(&self, path: &Path) -> Option<Option<&Arc<str>>> {
        let reached = self.compiler.reached().iter().find(|reached| reached.path == path)?;
        Some(reached.text.as_ref())
    }

    /// The text of a watched file that all that was done so far goes by.
    fn known(&self, path: &Path) -> Option<Option<&Arc<str>>> {
        let own = (path == self.file).then_some(Some(&self.source.text));
        let beside = || self.beside.get(path).map(Option::as_ref);
        own.or_else(|| self.taken(path)).or_else(beside).or_else(|| self.required.get(path).map(Some))
    }

    fn load(&mut self) {
        self.running = self.commands.running();
        let command = match self.compiler.compile_after(self.source.clone(), &self.running) {
            Ok(program) => {
                self.beside = self.files_of_robots(&program);
                Command::Load(Edit::of(&self.running, program))
            }
            Err(Rejected { sources, diagnostics }) => {
                let (findings, files) = findings::of_rejected(&diagnostics, &sources);
                Command::Reject { findings, files }
            }
        };
        self.settled.take(self.compiler.reached());
        self.watch_all();
        self.commands.send(command);
    }

    fn files_of_robots(&self, program: &Program) -> BTreeMap<PathBuf, Option<Arc<str>>> {
        let folder = super::live::folder(&self.file);
        let text = |path: &PathBuf| match self.beside.get(path) {
            Some(known) => known.clone(),
            // Without a text to compare with, the next one counts as new: at worst it is taken over again.
            None => loader::read_file(path).ok().map(|source| source.text),
        };
        let files = program.bridges.iter().flat_map(|bridge| robots::files(bridge, &folder));
        files.map(|path| (path.clone(), text(&path))).collect()
    }

    fn watch_all(&self) {
        let reached = self.compiler.reached().iter().map(|file| &file.path);
        let paths = std::iter::once(&self.file).chain(reached).chain(self.beside.keys()).chain(self.required.keys());
        let all: BTreeSet<&PathBuf> = paths.collect();
        let known = |path: &PathBuf| self.known(path).flatten().cloned();
        self.watch.set_paths(all.into_iter().map(|path| Watched { path: path.clone(), text: known(path) }));
    }

    fn told(&mut self, saved: Saved) -> Command {
        match saved {
            Saved::Text { path, text } => self.beside_changed(&path, text),
            Saved::Back { path } => {
                if let Some(text) = self.taken(&path).flatten().cloned() {
                    self.settled.put(path, text);
                }
                Command::Reject { findings: Vec::new(), files: Vec::new() }
            }
            Saved::Missing { path } => {
                self.settled.forget(&path);
                rejected(of_file(&path, "the file is gone; the program goes on".to_string()))
            }
            Saved::Unreadable { path, why } => {
                self.settled.forget(&path);
                rejected(unreadable(&path, &why))
            }
        }
    }

    /// A required file that isn't Lua any more is not taken over, just as a program that can't be read isn't.
    fn beside_changed(&mut self, path: &Path, text: Arc<str>) -> Command {
        if let Some(known) = self.beside.get_mut(path) {
            *known = Some(text.clone());
        }
        let required = self.required.get_mut(path).map(|known| *known = text.clone()).is_some();
        let source = Source::new(path.display().to_string(), text);
        let mistake = if required { self.compiler.check_lua(&source, FileId(0)) } else { None };
        match mistake {
            Some(mistake) => {
                let (findings, files) = findings::of_rejected(&[mistake], &[source]);
                Command::Reject { findings, files }
            }
            None => Command::FileChanged { file: path.display().to_string() },
        }
    }
}

fn rejected(finding: Finding) -> Command {
    Command::Reject { findings: vec![finding], files: Vec::new() }
}

fn unreadable(path: &Path, why: &Unreadable) -> Finding {
    let said = why.to_string();
    // It begins with the path, which a finding has of its own.
    let said = said.strip_prefix(&format!("{}:", path.display())).unwrap_or(&said).trim_start();
    let finding = of_file(path, format!("{said}; the program goes on"));
    match *why {
        Unreadable::NotUtf8 { line, column, .. } => Finding { line, column, ..finding },
        _ => finding,
    }
}

/// A finding that concerns a file as a whole: it has no line.
fn of_file(path: &Path, message: String) -> Finding {
    Finding {
        severity: "warning".to_string(),
        code: "file".to_string(),
        message,
        help: None,
        file: path.display().to_string().into(),
        line: 0,
        column: 0,
    }
}
