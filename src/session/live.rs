//! A program file that runs: its engine's thread, and a watch on the file whose every save becomes a command.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::compile::Compiler;
use super::edits::{Edits, Heard};
use super::engine_thread::{Commands, EngineThread, News, Pacing};
use super::loader::{self, Unreadable};
use super::plugins::Plugins;
use super::robots::{Robots, Workshop};
use super::trace::{Clock, Conditions};
use crate::model::Robot;
use crate::runtime::Options;
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
    pub plugins: Plugins,
}

impl Setup {
    pub fn conditions(&self) -> Conditions {
        Conditions { rate: self.pacing.rate.hz(), seed: self.options.seed, clock: self.pacing.clock }
    }
}

/// Dropping it stops the robots and ends its threads.
pub struct Session {
    _edits: Edits,
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
        let access = setup.options.access;
        let heard = Heard::listen();
        let library = heard.library(folder.clone());
        let robots = match setup.pacing.clock {
            Clock::Real => Robots::AsProgrammed,
            Clock::Virtual => Robots::Simulated,
        };
        let workshop = Workshop { folder, seed: setup.options.seed, robots, plugins: setup.plugins.clone() };
        let engine = EngineThread::start(setup.options, workshop, library, setup.pacing, news);
        let compiler = move || Compiler::new(setup.robots).with_access(access).with_plugins(setup.plugins);
        let edits = heard.watch(setup.file, source, compiler, engine.commands().clone());
        Ok(Session { _edits: edits.map_err(NotStarted::System)?, engine })
    }

    pub fn commands(&self) -> &Commands {
        self.engine.commands()
    }
}

/// The folder that a program's other files are found from.
pub fn folder(file: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).to_path_buf()
}
