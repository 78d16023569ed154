//! A program file that runs: its engine's thread, and a watch on the file whose every save becomes a command.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use super::compile::{Compiler, Rejected};
use super::engine_thread::{Commands, EngineThread, News, Pacing};
use super::loader::{self, Unreadable};
use super::robots::{Robots, Workshop};
use super::trace::Conditions;
use super::watch::{Saved, Watch, Watched};
use super::{findings, modules};
use crate::model::Robot;
use crate::runtime::record::Finding;
use crate::runtime::{Command, Options};
use crate::syntax::Source;

/// Why a session can't begin, as one line.
#[derive(Debug)]
pub enum NotStarted {
    Unreadable(Unreadable),
    /// The system gives no more threads.
    System(io::Error),
}

impl fmt::Display for NotStarted {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            NotStarted::Unreadable(why) => why.fmt(f),
            NotStarted::System(error) => write!(f, "the system is short of something: {error}"),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Setup {
    pub file: PathBuf,
    pub options: Options,
    pub pacing: Pacing,
    /// Chosen on the command line.
    pub robots: Vec<Robot>,
}

impl Setup {
    pub fn conditions(&self) -> Conditions {
        Conditions { rate: self.pacing.rate.hz(), seed: self.options.seed, clock: self.pacing.clock }
    }
}

/// Dropping it stops the robots and ends its threads.
pub struct Session {
    _watch: Watch,
    engine: EngineThread,
}

impl Session {
    /// Starts the program of a file, whether it can be read as one or not: a save can mend it. Fails only where there is
    /// no text to be had.
    pub fn start(setup: Setup, news: impl Fn(News) + Clone + Send + 'static) -> Result<Session, NotStarted> {
        let source = match loader::read(&setup.file) {
            Err(Unreadable::Empty { .. }) => Source::new(setup.file.display().to_string(), ""),
            read => read.map_err(NotStarted::Unreadable)?,
        };
        let folder = folder(&setup.file);
        let workshop = Workshop { folder: folder.clone(), seed: setup.options.seed, robots: Robots::AsProgrammed };
        let library = modules::library(folder);
        let engine = EngineThread::start(setup.options, workshop, library, setup.pacing, news);
        let (saves, inbox) = channel();
        let known = Watched { path: setup.file, text: Some(Arc::clone(&source.text)) };
        let watch = Watch::new([known], move |saved| {
            // The receiver ends with the session.
            let _ = saves.send(saved);
        });
        let commands = engine.commands().clone();
        let edits = move || edit(source, &inbox, Compiler::new(setup.robots), &commands);
        std::thread::Builder::new().name("edits".to_string()).spawn(edits).map_err(NotStarted::System)?;
        Ok(Session { _watch: watch.map_err(NotStarted::System)?, engine })
    }

    pub fn commands(&self) -> &Commands {
        self.engine.commands()
    }
}

pub fn folder(file: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).to_path_buf()
}

/// Compiles beside the engine's thread, which only takes finished programs over.
fn edit(first: Source, saves: &Receiver<Saved>, mut compiler: Compiler, commands: &Commands) {
    commands.send(load(&mut compiler, first));
    while let Ok(saved) = saves.recv() {
        let command = match saved {
            Saved::Text { path, text } => load(&mut compiler, Source::new(path.display().to_string(), text)),
            Saved::Back { path } => trouble("file-back", &path, "the file is back, unchanged".to_string()),
            Saved::Missing { path } => trouble("file-missing", &path, "the file is gone; the program goes on".to_string()),
            Saved::Unreadable { path, why } => trouble("file-unreadable", &path, format!("{why}; the program goes on")),
        };
        commands.send(command);
    }
}

fn load(compiler: &mut Compiler, source: Source) -> Command {
    match compiler.compile(source) {
        Ok(program) => Command::Load(Arc::new(program)),
        Err(Rejected { sources, diagnostics }) => Command::Reject { findings: findings::errors_first(&diagnostics, &sources) },
    }
}

fn trouble(code: &str, path: &Path, message: String) -> Command {
    let finding = Finding {
        severity: "warning".to_string(),
        code: code.to_string(),
        message,
        help: None,
        file: path.display().to_string().into(),
        line: 0,
        column: 0,
    };
    Command::Reject { findings: vec![finding] }
}
