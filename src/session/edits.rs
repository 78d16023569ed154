//! Every save of a program's files becomes a command: its text is compiled here, beside the engine's thread, which only
//! takes finished programs over. Worlds and required Lua files are watched like the program.

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
use crate::syntax::Source;

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
            let desk = Desk { file, watch, commands, beside: BTreeSet::new(), required: BTreeMap::new() };
            desk.work(first, compiler(), &inbox);
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
    watch: Watch,
    commands: Commands,
    /// Files that the robots read.
    beside: BTreeSet<PathBuf>,
    required: BTreeMap<PathBuf, Watched>,
}

impl Desk {
    fn work(mut self, first: Source, mut compiler: Compiler, inbox: &Receiver<Note>) {
        self.load(&mut compiler, first);
        for note in inbox {
            match note {
                Note::Saved(Saved::Text { path, text }) if path == self.file => {
                    self.load(&mut compiler, Source::new(path.display().to_string(), text));
                }
                Note::Saved(saved) => self.commands.send(self.told(saved, &mut compiler)),
                Note::Required(known) => {
                    self.required.insert(known.path.clone(), known);
                    self.watch_all();
                }
                Note::End => return,
            }
        }
    }

    fn load(&mut self, compiler: &mut Compiler, source: Source) {
        let running = self.commands.running();
        let command = match compiler.compile_after(source, &running) {
            Ok(program) => {
                self.beside = self.files_of_robots(&program);
                self.watch_all();
                Command::Load(Edit::of(&running, program))
            }
            Err(Rejected { sources, diagnostics }) => {
                Command::Reject { findings: findings::errors_first(&diagnostics, &sources) }
            }
        };
        self.commands.send(command);
    }

    fn files_of_robots(&self, program: &Program) -> BTreeSet<PathBuf> {
        let folder = super::live::folder(&self.file);
        program.bridges.iter().flat_map(|bridge| robots::files(bridge, &folder)).collect()
    }

    fn watch_all(&self) {
        let watched = |path: &PathBuf| {
            // Without a text to compare with, the next one counts as new: at worst it is taken over again.
            let text = loader::read(path).ok().map(|source| source.text);
            Watched { path: path.clone(), text }
        };
        let read = std::iter::once(&self.file).chain(&self.beside).map(watched);
        self.watch.set_paths(read.chain(self.required.values().cloned()));
    }

    fn told(&self, saved: Saved, compiler: &mut Compiler) -> Command {
        match saved {
            Saved::Text { path, text } => self.beside_changed(&path, text, compiler),
            Saved::Back { .. } => Command::Reject { findings: Vec::new() },
            Saved::Missing { path } => rejected(of_file(&path, "the file is gone; the program goes on".to_string())),
            Saved::Unreadable { path, why } => rejected(unreadable(&path, &why)),
        }
    }

    /// A required file that isn't Lua any more is not taken over, just as a program that can't be read isn't.
    fn beside_changed(&self, path: &Path, text: Arc<str>, compiler: &mut Compiler) -> Command {
        let source = Source::new(path.display().to_string(), text);
        let mistake = if self.required.contains_key(path) { compiler.check_lua(&source) } else { None };
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
