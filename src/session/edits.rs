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
    Required(Watched),
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
            let known = Watched { path: path.to_path_buf(), text: Some(text.into()) };
            drop(notes.send(Note::Required(known)));
        })
    }

    /// Loads the first text of `file`, then every save of it; the compiler is made on the thread that uses it. Fails only where no thread can be started.
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
            let compiler = compiler();
            let (beside, required) = (BTreeSet::new(), BTreeMap::new());
            let desk =
                Desk { file, source: first, compiler, watch, commands, running: Arc::default(), beside, required };
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
    watch: Watch,
    commands: Commands,
    /// What ran at the last save: held until the next one, so that it is dropped here and not on the engine's thread.
    running: Arc<Program>,
    /// Files that the robots read.
    beside: BTreeSet<PathBuf>,
    /// Lua files that blocks have read while they ran.
    required: BTreeMap<PathBuf, Watched>,
}

impl Desk {
    fn work(mut self, inbox: &Receiver<Note>) {
        self.load();
        for note in inbox {
            match note {
                Note::Saved(saved) => self.saved(saved),
                Note::Required(known) => {
                    self.required.insert(known.path.clone(), known);
                    self.watch_all();
                }
                Note::End => return,
            }
        }
    }

    fn saved(&mut self, saved: Saved) {
        match saved {
            Saved::Text { path, text } if path == self.file => {
                self.source = Source::new(path.display().to_string(), text);
                self.load();
            }
            // Another file's save has brought it in already.
            Saved::Text { path, text } if self.taken(&path).is_some_and(|taken| taken.as_ref() == Some(&text)) => {}
            Saved::Text { path, .. } if self.taken(&path).is_some() => self.load(),
            Saved::Back { path } if self.taken(&path) == Some(None) => self.load(),
            saved => {
                let told = self.told(saved);
                self.commands.send(told);
            }
        }
    }

    /// The text with which a file is part of the program, none while it can't be read; nothing for other files.
    fn taken(&self, path: &Path) -> Option<Option<Arc<str>>> {
        let reached = self.compiler.reached().iter().find(|reached| reached.path == path)?;
        Some(reached.text.clone())
    }

    fn load(&mut self) {
        self.running = self.commands.running();
        let command = match self.compiler.compile_after(self.source.clone(), &self.running) {
            Ok(program) => {
                self.beside = self.files_of_robots(&program);
                Command::Load(Edit::of(&self.running, program))
            }
            Err(Rejected { sources, diagnostics }) => {
                Command::Reject { findings: findings::errors_first(&diagnostics, &sources) }
            }
        };
        self.watch_all();
        self.commands.send(command);
    }

    fn files_of_robots(&self, program: &Program) -> BTreeSet<PathBuf> {
        let folder = super::live::folder(&self.file);
        program.bridges.iter().flat_map(|bridge| robots::files(bridge, &folder)).collect()
    }

    fn watch_all(&self) {
        let watched = |path: &PathBuf| {
            // Without a text to compare with, the next one counts as new: at worst it is taken over again.
            let text = loader::read_file(path).ok().map(|source| source.text);
            Watched { path: path.clone(), text }
        };
        let read = std::iter::once(&self.file).chain(&self.beside).map(watched);
        let reached = self.compiler.reached().iter().cloned();
        let mut all: BTreeMap<PathBuf, Watched> = BTreeMap::new();
        for file in read.chain(reached).chain(self.required.values().cloned()) {
            all.entry(file.path.clone()).or_insert(file);
        }
        // Of one that couldn't be read any text is news, also the one known from before.
        let unread = |path: &PathBuf| self.taken(path) == Some(None);
        if all.keys().any(unread) {
            self.watch.set_paths(all.values().filter(|file| !unread(&file.path)).cloned());
        }
        self.watch.set_paths(all.into_values());
    }

    fn told(&mut self, saved: Saved) -> Command {
        match saved {
            Saved::Text { path, text } => self.beside_changed(&path, text),
            Saved::Back { .. } => Command::Reject { findings: Vec::new() },
            Saved::Missing { path } => rejected(of_file(&path, "the file is gone; the program goes on".to_string())),
            Saved::Unreadable { path, why } => rejected(unreadable(&path, &why)),
        }
    }

    /// A required file that isn't Lua any more is not taken over, just as a program that can't be read isn't.
    fn beside_changed(&mut self, path: &Path, text: Arc<str>) -> Command {
        let source = Source::new(path.display().to_string(), text);
        let required = self.required.contains_key(path);
        let mistake = if required { self.compiler.check_lua(&source, FileId(0)) } else { None };
        match mistake {
            Some(mistake) => Command::Reject { findings: findings::errors_first(&[mistake], &[source]) },
            None => Command::FileChanged { file: path.display().to_string() },
        }
    }
}

fn rejected(finding: Finding) -> Command {
    Command::Reject { findings: vec![finding] }
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
