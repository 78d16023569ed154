//! The picture of the running program, folded from records alone: a replay gives the same picture as the run.
//! Knows nothing of keys, panes or the terminal.

mod apply;
mod breakpoints;
mod bridge;
mod edit;
mod evidence;
mod history;
mod journal;
mod machine;
mod mode;
mod problem;
mod renames;
mod saves;
mod trail;
mod tuned;
mod variable;
mod world;

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use serde_json::Value;

pub use bridge::{Bridge, Call, Message};
pub use edit::{Edit, Outcome, describe, describe_shortly};
pub use history::{History, PERIOD_MS};
pub use journal::{Cause, Entry, Journal, Kind};
pub use machine::{Machine, State, Timeout};
pub use mode::{Choices, Mode, is_own_doing};
pub use problem::{Gravity, Origin, Problem, ProblemKey};
pub use renames::Renames;
pub use trail::{Trace, Which};
pub use variable::Variable;
pub use world::World;

use crate::model::{Program, TransitionId};
use crate::runtime::record::{Breakpoint, Finding, Held, Setter, Taken, Way};
use crate::runtime::time::Time;
use crate::syntax::Source;
use crate::ui::format::file_name;

pub type Path = Arc<str>;

/// How many of the latest transitions are kept.
pub const TAKEN_KEPT: usize = 200;

#[derive(Clone, Debug, PartialEq)]
pub struct View {
    pub mode: Mode,
    pub choices: Choices,
    /// Steps a second, as asked for; 0: as fast as possible.
    pub rate: f64,
    /// Steps a second as they are, evened out over some seconds.
    pub actual: Option<f64>,
    /// How late the last step was, ms.
    pub late: f64,
    /// Steps that were not made in time.
    pub skipped: u64,
    pub step: u64,
    pub t: Time,
    pub program: Option<Arc<Program>>,
    /// By path; those that are, or were, running.
    pub machines: BTreeMap<Path, Machine>,
    pub states: BTreeMap<Path, State>,
    pub variables: BTreeMap<Path, Variable>,
    /// Values set by hand that initial values replaced since.
    pub tuned: BTreeMap<Path, Value>,
    /// What a person set each variable to last, as long as nothing else but its initialiser set it since.
    pub by_hand: BTreeMap<Path, Value>,
    pub bridges: BTreeMap<Path, Bridge>,
    /// The latest transitions, oldest first.
    pub taken: VecDeque<(Time, Taken)>,
    /// What the guards of active states came to, in the order of `ways_out`; only while that is asked for.
    pub guards: BTreeMap<Path, Vec<Way>>,
    pub journal: Journal,
    /// What is wrong, in the order found.
    pub problems: Vec<Problem>,
    /// The outcome of the last save.
    pub edit: Option<Edit>,
    /// Texts that were saved and not taken over, as far as errors were found in them.
    pub refused: Vec<Source>,
    /// The edit that waits, with what it would do.
    pub held: Option<Held>,
    /// All there are.
    pub breakpoints: Vec<Breakpoint>,
    /// Those among them that are at transitions of the program.
    transition_breaks: BTreeMap<TransitionId, Setter>,
    pub world: Option<World>,
    /// How many times a program was taken over.
    pub loads: u64,
}

impl View {
    /// Before the first record. `rate`: steps a second; 0: as fast as possible.
    pub fn new(rate: f64) -> View {
        View {
            mode: Mode::Running,
            choices: Choices::default(),
            rate,
            actual: None,
            late: 0.0,
            skipped: 0,
            step: 0,
            t: Time::ZERO,
            program: None,
            machines: BTreeMap::new(),
            states: BTreeMap::new(),
            variables: BTreeMap::new(),
            tuned: BTreeMap::new(),
            by_hand: BTreeMap::new(),
            bridges: BTreeMap::new(),
            taken: VecDeque::new(),
            guards: BTreeMap::new(),
            journal: Journal::default(),
            problems: Vec::new(),
            edit: None,
            refused: Vec::new(),
            held: None,
            breakpoints: Vec::new(),
            transition_breaks: BTreeMap::new(),
            world: None,
            loads: 0,
        }
    }

    pub fn is_running(&self, machine: &str) -> bool {
        self.machines.get(machine).is_some_and(|machine| machine.running)
    }

    /// The path of the state a running machine is in.
    pub fn active(&self, machine: &str) -> Option<&Path> {
        let machine = self.machines.get(machine)?;
        machine.active.as_ref().filter(|_| machine.running)
    }

    pub fn is_active(&self, state: &str) -> bool {
        owner(state).and_then(|machine| self.active(machine)).is_some_and(|active| **active == *state)
    }

    /// How many errors there are now.
    pub fn errors(&self) -> usize {
        self.problems.iter().filter(|problem| problem.gravity == Gravity::Error).count()
    }

    /// The first finding of a program that was never good enough to run.
    pub fn broken(&self) -> Option<&Finding> {
        match &self.edit {
            Some(Edit::Rejected { first, .. }) if self.program.is_none() => Some(first),
            _ => None,
        }
    }

    /// `49: message`; in another file than the program's `curve.world:4: message`; of a whole file `curve.world: message`.
    pub fn headline(&self, finding: &Finding) -> String {
        format!("{}{}", self.place_words(&finding.file, finding.line), finding.message)
    }

    /// What stands before a message to say where it belongs: `49: `, `curve.world:4: `, `curve.world: `.
    fn place_words(&self, file: &str, line: usize) -> String {
        match (self.is_program(file), line) {
            (true, 0) => String::new(),
            (true, line) => format!("{line}: "),
            (false, 0) => format!("{}: ", file_name(file)),
            (false, line) => format!("{}:{line}: ", file_name(file)),
        }
    }

    /// Whether a file is the program itself and not one it requires or a world.
    pub fn is_program(&self, file: &str) -> bool {
        match self.program.as_ref().and_then(|program| program.sources.first()) {
            Some(source) => *source.name == *file,
            None => file.ends_with(".lrp"),
        }
    }

    /// The worst that is wrong with an element or anything inside it.
    pub fn gravity(&self, path: &str) -> Option<Gravity> {
        self.problems.iter().filter(|problem| problem.concerns(path)).map(|problem| problem.gravity).max()
    }
}

/// The path that holds a path: the machine of a state, the state of a nested machine, the machine of a variable.
pub fn owner(path: &str) -> Option<&str> {
    path.rsplit_once('/').map(|(owner, _)| owner)
}

/// The last name of a path.
pub fn name(path: &str) -> &str {
    path.rsplit_once('/').map_or(path, |(_, name)| name)
}

/// Whether `path` is `outer` or lies inside it.
pub fn within(path: &str, outer: &str) -> bool {
    path.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}
