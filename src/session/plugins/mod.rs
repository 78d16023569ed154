//! Bridges that are no part of lrp: where they lie, the processes they run in, and how those are kept alive. What a bridge
//! does can't hold up anybody else.

mod ask;
mod copy;
mod folders;
mod host;
mod incoming;
mod keeper;
mod life;
mod line;
mod process;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use serde_json::Value;

use super::watch::stamp::Stamp;

pub use ask::{Answer, ask};
pub use folders::{Folders, Plugin};
pub use host::host;
pub use incoming::{Incoming, Said};
pub use keeper::Keeper;
pub use line::Line;

/// What it takes to run plugins.
#[derive(Clone, Debug, Default)]
pub struct Plugins {
    pub folders: Folders,
    /// The program that library bridges run in: lrp itself.
    pub host: PathBuf,
    /// What kinds said of configurations.
    answers: Arc<Mutex<HashMap<Question, Result<Answer, String>>>>,
}

/// Which file was asked about which configuration; another file may answer otherwise.
type Question = (PathBuf, Option<Stamp>, String);

/// Answers that are kept: edits ask about a new configuration each time.
const ANSWERS: usize = 64;

impl Plugins {
    pub fn new(folders: Folders, host: PathBuf) -> Plugins {
        Plugins { folders, host, answers: Arc::default() }
    }

    /// Those that this program finds. `chosen`: folders from the command line, before all others.
    pub fn here(chosen: &[PathBuf]) -> Plugins {
        let host = std::env::current_exe().unwrap_or_else(|_| "lrp".into());
        Plugins::new(Folders::here(chosen, &host), host)
    }

    /// What a kind offers under a configuration; nothing where there is no such plugin. May wait for it to start.
    pub fn ask(&self, kind: &str, config: &Value) -> Option<Result<Answer, String>> {
        let plugin = self.folders.find(kind)?;
        let question = question(&plugin, config);
        if let Some(known) = self.recall(&question) {
            return Some(known);
        }
        let answer = ask(&plugin, &self.host, config);
        let mut answers = self.answers.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if answers.len() >= ANSWERS {
            answers.clear();
        }
        answers.insert(question, answer.clone());
        Some(answer)
    }

    /// The same, if it was asked before.
    pub fn known(&self, kind: &str, config: &Value) -> Option<Result<Answer, String>> {
        self.recall(&question(&self.folders.find(kind)?, config))
    }

    fn recall(&self, question: &Question) -> Option<Result<Answer, String>> {
        self.answers.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).get(question).cloned()
    }
}

fn question(plugin: &Plugin, config: &Value) -> Question {
    (plugin.path.clone(), Stamp::of(&plugin.path), config.to_string())
}
