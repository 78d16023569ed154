//! The robots a program can be connected to from inside this process: the simulator, and a stand-in that only listens.

mod fake;
mod sim;

use std::path::Path;
use std::sync::Arc;

use serde_json::Value;

use crate::model::{self, Description};
use crate::runtime::Time;
use crate::runtime::record::BridgeState;
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

/// One connected robot. Never waits: what it is told is handed over, what it says is what has come so far.
pub trait Bridge {
    fn description(&self) -> Description;
    /// How it is, and what a screen needs to draw it.
    fn state(&self) -> BridgeState;
    /// After how long an input counts as old; none: never.
    fn stale(&self) -> Option<Time>;
    /// Program time has come to this point.
    fn advance(&mut self, now: Time);
    /// Messages since the last call, by input.
    fn sample(&mut self) -> Vec<(Arc<str>, Value)>;
    fn send(&mut self, output: &str, message: &Value);
    /// Brings the robot to a halt.
    fn stop(&mut self);
    /// How to bring it to a halt from another thread.
    fn stopper(&self) -> Stopper;
    /// A file was saved. Whether that concerned this robot, which then goes by the new text unless that is broken.
    fn file_changed(&mut self, file: &Path) -> Result<Concern, Problems>;
    /// Puts a simulated robot back where it started; nothing for a real one.
    fn put_at_start(&mut self);
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Concern {
    None,
    TakenOver,
}

/// Brings a robot to a halt without asking the engine.
pub type Stopper = Arc<dyn Fn() + Send + Sync>;

/// How the robots of a program are to be made.
#[derive(Clone, Debug)]
pub struct Workshop {
    /// The program's folder: worlds are found from there.
    pub folder: std::path::PathBuf,
    pub seed: u64,
    pub robots: Robots,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Robots {
    /// As the program or the command line says.
    AsProgrammed,
    /// Stand-ins: what they are told is only recorded, what they say comes from a test.
    Fake,
}

/// Texts that robots read beside the program, and what is wrong with them.
#[derive(Default)]
pub struct Problems {
    pub sources: Vec<Source>,
    pub diagnostics: Vec<Diagnostic>,
}

pub const KINDS: &[&str] = &["sim"];

impl Workshop {
    /// Makes a robot, or says why it can't; `next_file` is the id the first extra source will get.
    pub fn make(&self, bridge: &model::Bridge, next_file: u16) -> Result<Box<dyn Bridge>, Problems> {
        match (self.robots, &*bridge.kind) {
            (Robots::Fake, _) => Ok(Box::new(fake::Fake::new(bridge))),
            (Robots::AsProgrammed, "sim") => {
                Ok(Box::new(sim::Simulated::new(bridge, &self.folder, self.seed, FileId(next_file))?))
            }
            (Robots::AsProgrammed, kind) => Err(unknown_kind(bridge, kind)),
        }
    }
}

fn unknown_kind(bridge: &model::Bridge, kind: &str) -> Problems {
    let near = crate::syntax::nearest::nearest(kind, KINDS.iter().copied());
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => {
            format!("there is: {}; `--bridge {}=sim` runs the program in the simulator", KINDS.join(", "), bridge.name)
        }
    };
    let message = format!("there is no bridge of kind `{kind}`");
    Problems {
        sources: Vec::new(),
        diagnostics: vec![Diagnostic::error(Code::UnknownBridge, bridge.span, message).help(help)],
    }
}

/// What a kind of bridge offers under the names that its form gives.
pub fn description(bridge: &model::Bridge) -> Option<Description> {
    (&*bridge.kind == "sim").then(|| sim::description(&sim::Names::of(&bridge.config)))
}

fn problem(span: Span, message: String) -> Problems {
    Problems { sources: Vec::new(), diagnostics: vec![Diagnostic::error(Code::BadBridge, span, message)] }
}

/// The files that a robot reads.
pub fn files(bridge: &model::Bridge, folder: &Path) -> Vec<std::path::PathBuf> {
    match &*bridge.kind {
        "sim" => sim::world_file(bridge, folder).into_iter().collect(),
        _ => Vec::new(),
    }
}

/// What a kind offers under its own names.
pub fn offer(kind: &str) -> Option<Description> {
    (kind == "sim").then(|| sim::description(&sim::Names::of(&Value::Null)))
}

/// What a kind of robot is, in a line.
pub fn summary(kind: &str) -> &'static str {
    match kind {
        "sim" => "a robot with two driven wheels in a small world read from a text file",
        _ => "",
    }
}
