//! The fold: what each record changes in the picture.

use crate::ui::glyphs::RIGHT;
use serde_json::Value;

use super::mode::is_own_doing;
use super::problem::{Origin, Problem, ProblemKey};
use super::{Cause, Edit, Kind, Message, Mode, Path, TAKEN_KEPT, View, Which, World, name, owner};
use crate::model::TransitionId;
use crate::model::ways::guard_block;
use crate::runtime::command::Command;
use crate::runtime::record::{BridgeState, Fault, Forced, Health, Log, Mended, Record, Taken, What};
use crate::ui::format;

impl View {
    pub fn apply(&mut self, record: &Record) {
        self.step = record.step;
        self.t = record.t;
        match &record.what {
            What::Load(load) => self.load(load),
            What::Reject { findings, files } => self.reject(findings, files),
            What::Held(held) => self.hold(held),
            What::Breakpoints { all } => {
                self.breakpoints.clone_from(all);
                self.find_transitions();
            }
            What::Command { command } => self.command(command),
            What::Spawn { machine, by } => self.spawn(machine, by),
            What::Enter { state } => self.enter(state),
            What::Exit { state } => self.exit(state),
            What::Transition(taken) => self.take(taken),
            What::Guards { state, ways } => _ = self.guards.insert(state.clone(), ways.clone()),
            What::Discard { machine } => self.discard(machine),
            What::Set { var, value, by } => self.set(var, value, by),
            What::Input { bridge, name, value } => self.input(bridge, name, value),
            What::Output { bridge, name, value } => self.output(bridge, name, value),
            What::Call { bridge, name, id, arguments } => {
                self.bridges.entry(bridge.clone()).or_default().call(record.t, *id, name, arguments);
            }
            What::Reply { bridge, id, done: false, value, .. } => {
                self.bridges.entry(bridge.clone()).or_default().feedback(*id, value);
            }
            What::Reply { bridge, id, value, error, .. } => {
                let result = error.clone().map_or_else(|| Ok(value.clone()), Err);
                self.bridges.entry(bridge.clone()).or_default().end_call(record.t, *id, result);
            }
            What::Cancel { .. } => {}
            What::Offer { bridge, description } => {
                self.bridges.entry(bridge.clone()).or_default().offer = Some((**description).clone());
            }
            What::Found { bridge, found } => {
                self.bridges.entry(bridge.clone()).or_default().found.clone_from(found);
            }
            What::Log(log) => self.log(log),
            What::Error(fault) => self.fault(fault),
            What::Mended(mended) => self.mended(mended),
            What::Pause { reason, .. } => self.pause(reason),
            What::Resume => self.resume(),
            What::Force { state, how } => self.force(state, *how),
            What::Restart { reason } => self.restart(reason),
            What::Stop { reason } => self.stop(reason),
            What::Skip { steps } => self.skipped += steps,
            What::Status { rate, late } => self.status(*rate, *late),
            What::Bridge(state) => self.bridge(state),
        }
    }

    fn command(&mut self, command: &Command) {
        match command {
            Command::Rate { hz } => (self.rate, self.actual) = (*hz, None),
            Command::Runstop => self.mode = Mode::Stopped,
            Command::OnEdit { mode } => self.choices.on_edit = *mode,
            Command::Saves { mode } => self.choices.saves = *mode,
            Command::OnError { mode } => self.choices.on_error = *mode,
            Command::Explain { .. } => self.guards.clear(),
            Command::DropHeld => self.drop_held(),
            Command::Reset { var } => self.reset(var),
            Command::PutAtStart { bridge } => {
                self.journal.note(self.t, format!("{bridge} put at its start"));
                if let Some(world) = self.world.as_mut().filter(|world| *world.bridge == **bridge) {
                    world.trail.clear();
                }
            }
            _ => (),
        }
    }

    fn spawn(&mut self, path: &Path, by: &Option<Path>) {
        let t = self.t;
        let machine = self.machines.entry(path.clone()).or_default();
        machine.running = true;
        machine.active = None;
        machine.entered = t;
        machine.spawned_by = by.clone();
    }

    fn enter(&mut self, state: &Path) {
        self.states.entry(state.clone()).or_default().visits += 1;
        let Some(owner) = owner(state) else { return };
        let t = self.t;
        let machine = self.machines.entry(owner.into()).or_default();
        machine.running = true;
        machine.active = Some(state.clone());
        machine.entered = t;
    }

    fn exit(&mut self, state: &Path) {
        let t = self.t;
        self.states.entry(state.clone()).or_default().last_left = Some(t);
        let machine = owner(state).and_then(|machine| self.machines.get_mut(machine));
        if let Some(machine) = machine.filter(|machine| machine.active.as_ref() == Some(state)) {
            machine.active = None;
        }
    }

    fn take(&mut self, taken: &Taken) {
        let t = self.t;
        let which = if taken.via.is_some() { Which::Exit } else { Which::Own(taken.index) };
        let machine = self.machines.entry(taken.machine.clone()).or_default();
        machine.took(which, taken.from.clone());
        if self.taken.len() == TAKEN_KEPT {
            self.taken.pop_front();
        }
        self.taken.push_back((t, taken.clone()));
        let text = format!("{} {RIGHT} {}  {}", name(&taken.from), name(&taken.to), taken.trigger);
        let state = format!("{}/{}", taken.machine, name(&taken.to));
        let cause = self.transition(taken);
        let place = cause.and_then(|cause| self.place_of(cause));
        let evidence = cause.map_or_else(Vec::new, |cause| self.evidence_for(cause));
        let transition = cause.map(|id| (self.loads, id));
        let cause = Cause { trigger: taken.trigger.clone(), name: taken.name.clone(), transition, evidence };
        self.journal.add(t, Kind::Change(cause), text, state.into(), place);
    }

    /// The transition of the program that was taken. An exit is written in the machine it leaves.
    pub fn transition(&self, taken: &Taken) -> Option<TransitionId> {
        let program = self.program.as_ref()?;
        let written_in = taken.via.as_ref().and_then(|via| owner(via)).unwrap_or(&taken.machine);
        let machine = &program[program.machine(written_in)?];
        machine.transitions.get(taken.index as usize).copied()
    }

    /// A transition's record comes before what its actions change.
    fn evidence_for(&self, transition: TransitionId) -> Vec<String> {
        match &self.program {
            Some(program) if guard_block(program, transition).is_some() => self.evidence(program, transition),
            _ => Vec::new(),
        }
    }

    fn place_of(&self, transition: TransitionId) -> Option<(Path, usize)> {
        let program = self.program.as_ref()?;
        let span = program[transition].span;
        let source = program.source(span);
        Some((source.name.clone(), source.line(span.start as usize)))
    }

    /// Machines inside it that are gone as well have records of their own; one that was forced may run on by itself.
    pub(super) fn discard(&mut self, path: &Path) {
        if let Some(machine) = self.machines.get_mut(path) {
            machine.running = false;
            machine.active = None;
        }
        for (_, variable) in self.variables.iter_mut().filter(|(var, _)| owner(var) == Some(path)) {
            variable.forget();
        }
    }

    fn set(&mut self, var: &Path, value: &Value, by: &Path) {
        let t = self.t;
        self.watch_tuned(var, value, by);
        let variable = self.variables.entry(var.clone()).or_default();
        variable.set(value, by, t);
        if **by == *"command" {
            let before = variable.previous.as_ref().map_or_else(|| "nil".into(), format::value);
            self.journal.set_by_hand(t, var, &before, &format::value(value));
        }
    }

    fn input(&mut self, bridge: &Path, name: &Path, value: &Value) {
        let inputs = &mut self.bridges.entry(bridge.clone()).or_default().inputs;
        let message = Message::new(value.clone(), self.t, inputs.get(name));
        inputs.insert(name.clone(), message);
        let world = self.world.as_mut().filter(|world| world.bridge == *bridge && world.pose_input == *name);
        if let Some(world) = world {
            world.moved(value);
        }
    }

    fn output(&mut self, bridge: &Path, name: &Path, value: &Value) {
        let outputs = &mut self.bridges.entry(bridge.clone()).or_default().outputs;
        let message = Message::new(value.clone(), self.t, outputs.get(name));
        outputs.insert(name.clone(), message);
    }

    fn log(&mut self, log: &Log) {
        self.journal.log(self.t, log);
    }

    fn fault(&mut self, fault: &Fault) {
        let fault = Problem::from_fault(fault, self.t);
        match self.problems.iter_mut().find(|known| known.key == fault.key && known.origin == Origin::Run) {
            Some(known) => *known = fault,
            None => self.problems.push(fault),
        }
    }

    fn mended(&mut self, Mended { code, file, line, column }: &Mended) {
        let key = ProblemKey { code: code.clone(), file: file.clone(), line: *line, column: *column };
        self.problems.retain(|problem| problem.key != key || problem.origin != Origin::Run);
    }

    fn pause(&mut self, reason: &str) {
        match reason {
            // The stop itself is told.
            "runstop" => (),
            _ if is_own_doing(reason) => self.journal.note(self.t, "paused"),
            _ => {
                let reason = reason.strip_prefix("breakpoint: ").unwrap_or(reason);
                self.journal.note(self.t, format!("paused: {reason}"));
            }
        }
        if self.mode != Mode::Stopped {
            self.mode = Mode::Paused { reason: reason.into() };
        }
    }

    fn resume(&mut self) {
        (self.mode, self.actual) = (Mode::Running, None);
        self.journal.note(self.t, "goes on");
    }

    /// The entering itself has records of its own.
    fn force(&mut self, state: &Path, how: Forced) {
        let verb = match how {
            Forced::Transition => "sent to",
            Forced::Jump => "jumped to",
        };
        for state in self.way_to(state) {
            let machine = owner(&state).unwrap_or("");
            let verb = if self.is_running(machine) { verb } else { "spawned in" };
            self.journal.note(self.t, format!("{} {verb} {}", name(machine), name(&state)));
        }
    }

    /// The states to be in for a state, from the nearest machine that runs inwards; with none, it alone.
    fn way_to(&self, state: &Path) -> Vec<Path> {
        let mut way = vec![state.clone()];
        let mut inner: &str = state;
        while let Some(machine) = owner(inner).filter(|machine| !self.is_running(machine)) {
            let Some(outer) = owner(machine) else { return vec![state.clone()] };
            way.push(outer.into());
            inner = outer;
        }
        way.reverse();
        way
    }

    /// One because of an edit was told with the edit. What is wrong with the text is told again.
    fn restart(&mut self, reason: &str) {
        let told = matches!(&self.edit, Some(Edit::Taken(outcome)) if outcome.restarted.as_deref() == Some(reason));
        if is_own_doing(reason) && !matches!(self.edit, Some(Edit::Rejected { .. } | Edit::Held { .. })) {
            self.edit = Some(Edit::Restarted);
        }
        self.problems.retain(|problem| problem.origin != Origin::Run);
        self.begin_again();
        match told {
            true => (),
            false if is_own_doing(reason) => self.journal.note(self.t, "restarted"),
            false => self.journal.note(self.t, format!("restarted: {reason}")),
        }
    }

    /// The robot is stopped at every restart, which is told by itself.
    fn stop(&mut self, reason: &str) {
        if reason != "restart" {
            self.journal.note(self.t, format!("robot stopped: {reason}"));
        }
    }

    pub(super) fn begin_again(&mut self) {
        self.remember_tuned(|_| true);
        self.machines.clear();
        self.states.clear();
        self.variables.values_mut().for_each(super::Variable::forget);
    }

    /// Half a second holds few steps, so the rate is evened out.
    fn status(&mut self, rate: f64, late: f64) {
        let before = self.actual.filter(|before| before.is_finite());
        self.actual = Some(before.map_or(rate, |before| before * 0.75 + rate * 0.25));
        self.late = late;
    }

    fn bridge(&mut self, state: &BridgeState) {
        let t = self.t;
        let bridge = self.bridges.entry(state.bridge.clone()).or_default();
        if bridge.health != Some(state.state) {
            bridge.since = t;
            self.journal.note(t, note_of_bridge(state));
        }
        bridge.kind = state.kind.clone();
        bridge.health = Some(state.state);
        bridge.message = state.message.clone();
        if self.program.is_none() {
            self.wait_for_robots();
        }
        if let Some(text) = &state.world {
            let known = self.world.as_ref().is_some_and(|world| world.text == text.text);
            if !known {
                self.world = Some(World::new(&state.bridge, text));
            }
        }
    }
}

impl View {
    /// The program begins when all robots are there.
    fn wait_for_robots(&mut self) {
        let missing = self.bridges.iter().find(|(_, bridge)| bridge.health != Some(Health::Up));
        self.mode = match missing {
            None => Mode::Running,
            Some((robot, bridge)) => {
                let state = if bridge.health == Some(Health::Lost) { "lost" } else { "connecting" };
                let why = bridge.message.as_ref().map_or(state.to_string(), |message| format!("{state}: {message}"));
                Mode::Waiting { robot: robot.clone(), why }
            }
        };
    }
}

fn note_of_bridge(state: &BridgeState) -> String {
    let health = match state.state {
        Health::Connecting => "connecting",
        Health::Up => "up",
        Health::Lost => "lost",
    };
    match &state.message {
        Some(message) => format!("{} {health}: {message}", state.bridge),
        None => format!("{} {health}", state.bridge),
    }
}
