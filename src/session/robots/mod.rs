//! The robots a program can be connected to: the simulator in this process, plugins in their own, and for tests a stand-in
//! that only listens.

mod fake;
mod plugin;
mod sim;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use lrp_bridge::{About, Item, Order, Want};
use serde_json::Value;

use super::plugins::{Plugins, Said};
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
    /// What it said beside messages since the last call.
    fn listen(&mut self) -> Vec<Said> {
        Vec::new()
    }
    /// What a step, or a command, sends, in order.
    fn send(&mut self, items: Vec<Item>);
    /// A call is no longer wanted.
    fn cancel(&mut self, _id: u64) {}
    /// Brings the robot to a halt.
    fn stop(&mut self);
    /// How to bring it to a halt from another thread.
    fn stopper(&self) -> Stopper;
    /// The program pauses: whether the form asks for a halt then.
    fn stops_on_pause(&self) -> bool {
        false
    }
    /// A file was saved. Whether that concerned this robot, which then goes by the new text unless that is broken.
    fn file_changed(&mut self, _file: &Path) -> Result<Concern, Problems> {
        Ok(Concern::None)
    }
    /// Puts a simulated robot back where it started; nothing for a real one.
    fn put_at_start(&mut self) {}
    /// Its form was edited. Whether it goes on under the new one; else it is to be made anew.
    fn configure(&mut self, _form: &model::Bridge) -> Fit {
        Fit::Anew
    }
    /// The robot's own clock, where program time is to follow it.
    fn time(&self) -> Option<Duration> {
        None
    }
    /// Whether it may have said something before the program began.
    fn is_heard_early(&self) -> bool {
        false
    }
    /// Whether the program may begin.
    fn is_ready(&self) -> bool {
        true
    }
    /// What it wants to be told of the program.
    fn wants(&self) -> &[Want] {
        &[]
    }
    /// Something else than outputs and calls, for a robot that wants it.
    fn tell(&mut self, _order: Order) {}
    /// Lets the robot go, stopped; gives what to wait for before this process ends.
    fn part(self: Box<Self>) -> Option<JoinHandle<()>> {
        None
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Concern {
    None,
    TakenOver,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    Kept,
    Anew,
}

/// Brings a robot to a halt without asking the engine, from any thread.
pub type Stopper = Arc<dyn Halt>;

pub trait Halt: Send + Sync {
    fn halt(&self);
    /// Halts it, and keeps it so until it is released, whatever it is sent.
    fn hold(&self) {
        self.halt();
    }
    /// Until it has heard of every halt, or that time.
    fn wait(&self, _until: Instant) {}
    fn release(&self) {}
}

/// A robot in this process, which moves no more than this process does.
impl<F: Fn() + Send + Sync> Halt for F {
    fn halt(&self) {
        self();
    }
}

/// How the robots of a program are to be made.
#[derive(Clone, Debug)]
pub struct Workshop {
    /// The program's folder: worlds are found from there.
    pub folder: PathBuf,
    pub seed: u64,
    pub robots: Robots,
    pub plugins: Plugins,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Robots {
    /// As the program or the command line says.
    AsProgrammed,
    /// The same, but only what can follow virtual time.
    Simulated,
    /// Stand-ins: what they are told is only recorded, what they say comes from a test.
    Fake,
}

/// Texts that robots read beside the program, and what is wrong with them.
#[derive(Default)]
pub struct Problems {
    pub sources: Vec<Source>,
    pub diagnostics: Vec<Diagnostic>,
}

/// What is part of lrp.
pub const BUILT_IN: &[&str] = &["sim"];

impl Workshop {
    /// Makes a robot, or says why it can't; `next_file` is the id the first extra source will get.
    pub fn make(&self, bridge: &model::Bridge, next_file: u16) -> Result<Box<dyn Bridge>, Problems> {
        match (self.robots, &*bridge.kind) {
            (Robots::Fake, _) => Ok(Box::new(fake::Fake::new(bridge, &self.plugins))),
            (_, "sim") => Ok(Box::new(sim::Simulated::new(bridge, &self.folder, self.seed, FileId(next_file))?)),
            (_, kind) if self.plugins.folders.find(kind).is_none() => Err(self.unknown_kind(bridge, kind)),
            (Robots::Simulated, kind) => Err(not_virtual(bridge, kind)),
            (Robots::AsProgrammed, _) => Ok(Box::new(plugin::Connected::new(bridge, &self.folder, &self.plugins)?)),
        }
    }

    /// What keeps a robot from being made. Connects to none.
    pub fn check(&self, bridge: &model::Bridge, next_file: u16) -> Result<(), Problems> {
        match &*bridge.kind {
            kind if BUILT_IN.contains(&kind) => self.make(bridge, next_file).map(drop),
            kind if self.plugins.folders.find(kind).is_none() => Err(self.unknown_kind(bridge, kind)),
            _ => Ok(()),
        }
    }

    fn unknown_kind(&self, bridge: &model::Bridge, kind: &str) -> Problems {
        let plugins = self.plugins.folders.all();
        let known: Vec<&str> = BUILT_IN.iter().copied().chain(plugins.iter().map(|plugin| &*plugin.kind)).collect();
        let help = match crate::syntax::nearest::nearest(kind, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "there is: {}; `lrp bridges` tells where bridges are looked for; `--bridge {}=sim` runs the program in \
                 the simulator",
                known.join(", "),
                bridge.name
            ),
        };
        let message = format!("there is no bridge of kind `{kind}`");
        Problems {
            sources: Vec::new(),
            diagnostics: vec![Diagnostic::error(Code::UnknownBridge, bridge.span, message).help(help)],
        }
    }
}

fn not_virtual(bridge: &model::Bridge, kind: &str) -> Problems {
    let mut problems = problem(bridge.span, format!("`{kind}` is a real robot: it can't follow virtual time"));
    let help = format!("leave `--virtual` out, or run in the simulator: `--bridge {}=sim`", bridge.name);
    problems.diagnostics[0].help = Some(help);
    problems
}

/// What is known of a form before anything is connected, and what is wrong with it.
#[derive(Default)]
pub struct Offered {
    pub description: Option<Description>,
    pub findings: Vec<Diagnostic>,
}

/// What a kind of bridge offers under a form. May take the time that a plugin needs to start, unless it was asked before.
pub fn offered(bridge: &model::Bridge, text: &str, plugins: &Plugins) -> Offered {
    match built_in(bridge) {
        Some(description) => Offered { description: Some(description), findings: Vec::new() },
        None => plugin::offered(bridge, text, plugins),
    }
}

/// The same, as far as it is known at once.
pub fn description(bridge: &model::Bridge, plugins: &Plugins) -> Option<Description> {
    built_in(bridge).or_else(|| plugin::known(bridge, plugins).map(|answer| answer.description))
}

fn built_in(bridge: &model::Bridge) -> Option<Description> {
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

/// What the simulator is, as plugins say it of themselves.
pub fn about_built_in(kind: &str) -> Option<(About, Description)> {
    let about = || About {
        kind: "sim".to_string(),
        version: env!("CARGO_PKG_VERSION").to_string(),
        summary: "a robot with two driven wheels in a small world read from a text file".to_string(),
        settings: sim::settings(),
        wants: Vec::new(),
    };
    (kind == "sim").then(|| (about(), sim::description(&sim::Names::of(&Value::Null))))
}
