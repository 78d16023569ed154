//! The engine: one program as it runs. A step goes in with what the robot said; records come out.

use std::rc::Rc;
use std::sync::Arc;

use serde_json::Value;

use super::breakpoints::Breakpoints;
use super::command::{OnEdit, OnError, Saves};
use super::faults::Faults;
use super::message::shown;
use super::note::Note;
use super::patch::Pending;
use super::plan::Plan;
use super::record::{Record, What};
use super::robot::Robots;
use super::store::Store;
use super::time::Time;
use crate::lua::{Access, Emergency, Limits, Lua};
use crate::model::*;

#[derive(Clone, Debug)]
pub struct Options {
    pub limits: Limits,
    pub access: Access,
    /// For `math.random`.
    pub seed: u64,
    pub on_edit: OnEdit,
    pub saves: Saves,
    pub on_error: OnError,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            limits: Limits::default(),
            access: Access::Sandboxed,
            seed: 1,
            on_edit: OnEdit::default(),
            saves: Saves::default(),
            on_error: OnError::default(),
        }
    }
}

/// What a bridge received since the last step.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    pub bridge: Arc<str>,
    pub name: Arc<str>,
    pub value: Value,
}

/// What a bridge said of a call since the last step.
#[derive(Clone, Debug, PartialEq)]
pub struct Reply {
    pub bridge: Arc<str>,
    /// Which call it was.
    pub name: Arc<str>,
    pub id: u64,
    /// Whether the call is over; else the value is how far it has come.
    pub done: bool,
    pub value: Value,
    /// Why it failed.
    pub error: Option<String>,
}

pub struct Engine {
    pub(super) program: Arc<Program>,
    pub(super) plan: Rc<Plan>,
    pub(super) store: Store,
    pub(super) modules: super::modules::Texts,
    pub(super) robots: Robots,
    /// By machine.
    pub(super) running: Vec<Option<Running>>,
    /// Running machines that no state spawned, in the order of the spawn statements.
    pub(super) tops: Vec<MachineId>,
    /// How often each state was entered since the program started.
    pub(super) visits: Vec<u64>,
    pub(super) step: u64,
    pub(super) now: Time,
    pub(super) paused: bool,
    pub(super) on_edit: OnEdit,
    pub(super) saves: Saves,
    pub(super) on_error: OnError,
    /// An edit that is not taken over yet.
    pub(super) held: Option<Pending>,
    pub(super) notes: Vec<Note>,
    pub(super) faults: Faults,
    pub(super) changes: super::changes::Changes,
    pub(super) breakpoints: Breakpoints,
    pub(super) why: super::why::Why,
}

/// A machine that runs: where it is and what it has spawned there.
pub(super) struct Running {
    pub state: StateId,
    pub entered: Time,
    /// The step from which on its guards have been looked at.
    pub tested: u64,
    /// The name of the state that it was started in.
    pub start: Arc<str>,
    pub nested: Vec<MachineId>,
    /// Found to hold right after entry: taken in the next step, unless an edit comes between.
    pub decided: Option<super::machine::Fired>,
}

impl Running {
    pub fn new(state: StateId, entered: Time, start: Arc<str>) -> Running {
        Running { state, entered, tested: u64::MAX, start, nested: Vec::new(), decided: None }
    }
}

impl Engine {
    pub fn new(options: Options) -> Engine {
        let mut engine = Engine {
            program: Arc::default(),
            plan: Rc::default(),
            store: Store::new(Lua::new(options.limits, options.access, options.seed)),
            modules: super::modules::Texts::default(),
            robots: Robots::default(),
            running: Vec::new(),
            tops: Vec::new(),
            visits: Vec::new(),
            step: 0,
            now: Time::ZERO,
            paused: false,
            on_edit: options.on_edit,
            saves: options.saves,
            on_error: options.on_error,
            held: None,
            notes: Vec::new(),
            faults: Faults::default(),
            changes: super::changes::Changes::default(),
            breakpoints: Breakpoints::default(),
            why: super::why::Why::default(),
        };
        engine.library(|name| Err(format!("module '{name}' is not found")));
        engine
    }

    /// Makes a robot known to all blocks under its name, or changes what it offers.
    pub fn describe(&mut self, bridge: &str, description: &Description, stale: Option<Time>) {
        self.robots.describe(&mut self.store.lua, bridge, description, stale);
    }

    /// For another thread, to learn of a block that nothing stops.
    pub fn emergency(&self) -> Emergency {
        self.store.lua.emergency()
    }

    /// One step of every machine, at a program time not before that of the last one.
    pub fn step(&mut self, now: Time, inputs: &[Input]) {
        self.step += 1;
        self.now = now;
        self.store.lua.now(now.0);
        self.receive(inputs);
        let plan = Rc::clone(&self.plan);
        for index in 0..self.tops.len() {
            self.step_machine(&plan, self.tops[index]);
        }
        self.test_conditions();
        self.finish();
        self.pause_if_met();
    }

    /// What robots said; blocks see it from now on.
    pub fn receive(&mut self, inputs: &[Input]) {
        for input in inputs {
            self.robots.receive(&self.store.lua, input, self.now);
            let Input { bridge, name, value } = input.clone();
            self.rare(What::Input { bridge, name, value: shown(value) });
        }
    }

    /// What robots said of calls; blocks see it in the step to come.
    pub fn answer(&mut self, replies: Vec<Reply>) {
        for reply in replies {
            self.robots.answer(&self.store.lua, &reply);
            self.changes.answered(&reply.bridge);
            let Reply { bridge, name, id, done, value, error } = reply;
            self.rare(What::Reply { bridge, name, id, done, value: shown(value), error });
        }
    }

    /// What a step or a command leaves to be said at its end: changed variables, outputs, faults that went on.
    pub(super) fn finish(&mut self) {
        self.report_changes();
        if !self.robots.is_empty() {
            self.report_sent();
        }
        if self.faults.any_unreported() {
            self.report_faults();
        }
        if self.held.is_some() {
            self.tell_held_again();
        }
        if self.why.is_asked() {
            self.tell_guards();
        }
    }

    fn report_sent(&mut self) {
        for sent in self.robots.take_sent() {
            self.rare(sent);
        }
    }

    fn report_faults(&mut self) {
        for fault in self.faults.due(self.now) {
            self.rare(What::Error(fault));
        }
    }

    #[inline]
    pub(super) fn note(&mut self, note: Note) {
        self.notes.push(note);
    }

    pub(super) fn rare(&mut self, what: What) {
        self.notes.push(Note::Rare(Box::new(what)));
    }

    /// Puts something that only the session knows among the records.
    pub fn say(&mut self, what: What) {
        self.rare(what);
    }

    /// Hands over what happened since the last call, in order.
    pub fn drain(&mut self, mut sink: impl FnMut(Record)) {
        let (step, t) = (self.step, self.now);
        self.breakpoints.paused = false;
        for note in self.notes.drain(..) {
            sink(Record { step, t, what: note.spell_out(&self.program) });
        }
    }

    /// Forgets what happened since the last `drain`: for those who only want the machines to run.
    pub fn discard_records(&mut self) {
        self.breakpoints.paused = false;
        self.notes.clear();
    }
}
