//! The engine with its robots: samples what they say, steps, hands over what they are told. Has no clock and no thread:
//! whoever owns one says when a step is due.

mod robot;
mod sent;
mod told;

use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use lrp_bridge::{Call, Item, Order, Output, Scope};
use serde_json::Value;

use self::robot::{Robot, hear, messages};
use self::sent::{Delivery, Sent, cancel, send};
use self::told::Told;
use super::findings::of_rejected;
use super::modules;
use super::plugins::Said;
use super::robots::{Bridge, Concern, Problems, Stopper, Workshop};
use crate::model::literal::written;
use crate::model::{self, Description, Edit, Program};
use crate::runtime::record::{BridgeState, Health};
use crate::runtime::{Command, Engine, Input, Options, Record, Refused, Reply, Time, What};

pub struct Driver {
    engine: Engine,
    workshop: Workshop,
    robots: Vec<Robot>,
    /// Said by a test instead of a robot, for the next step.
    injected: Vec<Input>,
    /// What robots said of calls, for the next step.
    replies: Vec<Reply>,
    /// What an edit or a forced state sent while paused, or the step that a breakpoint ended: it leaves with the next step.
    held: Vec<Sent>,
    told: Told,
    /// Robots that are let go.
    parting: Vec<JoinHandle<()>>,
    /// A robot's file was saved with mistakes: it goes by what it read before.
    world_is_broken: bool,
}

/// Takes records as they come.
pub type Sink<'a> = &'a mut dyn FnMut(Record);

impl Driver {
    pub fn new(options: Options, workshop: Workshop) -> Driver {
        Driver {
            engine: Engine::new(options),
            workshop,
            robots: Vec::new(),
            injected: Vec::new(),
            replies: Vec::new(),
            held: Vec::new(),
            told: Told::default(),
            parting: Vec::new(),
            world_is_broken: false,
        }
    }

    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    pub fn engine_mut(&mut self) -> &mut Engine {
        &mut self.engine
    }

    /// How to halt each robot from another thread; to be asked anew after each load.
    pub fn stoppers(&self) -> Vec<Stopper> {
        self.bridges().map(|bridge| bridge.stopper()).collect()
    }

    fn bridges(&self) -> impl Iterator<Item = &dyn Bridge> {
        self.robots.iter().filter_map(|robot| robot.bridge.as_deref())
    }

    /// A message as if a robot had sent it.
    pub fn inject(&mut self, input: Input) {
        self.injected.push(input);
    }

    /// What became of a call, as if a robot had said it.
    pub fn reply(&mut self, reply: Reply) {
        self.replies.push(reply);
    }

    /// What a robot offers.
    pub fn offer(&self, robot: &str) -> Option<Description> {
        let robot = self.robots.iter().find(|known| &*known.form.name == robot)?;
        robot.bridge.as_ref().map(|bridge| bridge.description())
    }

    /// Whether every robot is there. Without one that isn't, the program may begin all the same.
    pub fn is_ready(&self) -> bool {
        self.robots.iter().all(|robot| robot.bridge.as_ref().is_none_or(|bridge| bridge.is_ready()))
    }

    /// The clock of a robot that tells one.
    pub fn robots_time(&self) -> Option<Duration> {
        self.bridges().find_map(|bridge| bridge.time())
    }

    /// Connects the robots of a program that is to be loaded once they are there.
    pub fn prepare(&mut self, edit: &Edit, sink: Sink) {
        let mut program = Arc::clone(&edit.program);
        for state in self.connect(&mut program) {
            self.engine.say(What::Bridge(state));
        }
        self.hand_over(Delivery::Now, sink);
    }

    /// Hears what robots have to say beside messages: also while nothing steps.
    pub fn attend(&mut self, sink: Sink) {
        let Driver { engine, robots, replies, .. } = self;
        let mut sets = Vec::new();
        for robot in robots {
            let Some(bridge) = &mut robot.bridge else { continue };
            for said in bridge.listen() {
                // A bridge that was started anew is told all again.
                robot.uninformed |= matches!(said, Said::State { state: Health::Up, .. });
                match said {
                    Said::Set { id, variable, value } => sets.push((robot.form.name.clone(), id, variable, value)),
                    said => hear(engine, replies, &robot.form, &**bridge, said),
                }
            }
        }
        for (robot, id, variable, value) in sets {
            self.set_for(&robot, id, variable, &value);
        }
        self.hand_over(Delivery::Now, sink);
    }

    /// One step at a program time not before that of the last one.
    pub fn step(&mut self, now: Time, sink: Sink) {
        self.deliver_held();
        self.attend(sink);
        self.engine.answer(std::mem::take(&mut self.replies));
        let mut inputs = Vec::new();
        for robot in &mut self.robots {
            let Some(bridge) = &mut robot.bridge else { continue };
            bridge.advance(now);
            inputs.extend(messages(&robot.form.name, &mut **bridge));
        }
        inputs.append(&mut self.injected);
        self.engine.step(now, &inputs);
        self.hand_over(Delivery::Now, sink);
    }

    pub fn command(&mut self, command: Command, sink: Sink) -> Result<(), Refused> {
        let held = matches!(
            command,
            Command::Load(_)
                | Command::ApplyHeld
                | Command::Restart
                | Command::TransitionTo { .. }
                | Command::JumpTo { .. }
        );
        let delivery = if held && self.engine.is_paused() { Delivery::Held } else { Delivery::Now };
        let result = match command {
            Command::Load(edit) if !self.engine.holds_saves() => self.load(edit),
            Command::ApplyHeld => self.apply_held(),
            Command::PutAtStart { ref bridge } => {
                self.put_at_start(bridge);
                self.engine.command(command)
            }
            Command::FileChanged { ref file } => {
                self.file_changed(Path::new(file));
                self.engine.command(command)
            }
            Command::Runstop => {
                let result = self.engine.command(command);
                self.engine.say(What::Stop { reason: "runstop".to_string() });
                result
            }
            Command::Resume => {
                self.deliver_held();
                self.engine.command(command)
            }
            command => self.engine.command(command),
        };
        self.hand_over(delivery, sink);
        result
    }

    /// Somebody on a robot's side changes a variable, as a person at the screen would.
    fn set_for(&mut self, robot: &str, id: u64, var: String, value: &Value) {
        let result = match written(value, "") {
            Some(value) => self.engine.command(Command::Set { var, value }),
            None => Err(Refused(format!("`{value}` can't be the value of a variable"))),
        };
        let answer = Order::Answer { id, error: result.err().map(|refused| refused.0) };
        let robot = self.robots.iter_mut().find(|known| &*known.form.name == robot);
        if let Some(bridge) = robot.and_then(|robot| robot.bridge.as_mut()) {
            bridge.tell(answer);
        }
    }

    /// Brings every robot to a halt, and says so.
    pub fn stop(&mut self, reason: &str, sink: Sink) {
        self.say(What::Stop { reason: reason.to_string() }, sink);
    }

    /// Something only the session knows, as a record among the engine's; a stop halts the robots.
    pub fn say(&mut self, what: What, sink: Sink) {
        self.engine.say(what);
        self.hand_over(Delivery::Now, sink);
    }

    fn file_changed(&mut self, file: &Path) {
        for bridge in self.robots.iter_mut().filter_map(|robot| robot.bridge.as_mut()) {
            match bridge.file_changed(file) {
                Ok(Concern::None) => {}
                Ok(Concern::TakenOver) => {
                    if std::mem::take(&mut self.world_is_broken) {
                        self.engine.say(What::Reject { findings: Vec::new(), files: Vec::new() });
                    }
                    self.engine.say(What::Bridge(bridge.state()));
                }
                Err(Problems { sources, diagnostics }) => {
                    let sources = if sources.is_empty() { self.engine.program().sources.clone() } else { sources };
                    let (findings, files) = of_rejected(&diagnostics, &sources);
                    self.engine.say(What::Reject { findings, files });
                    self.world_is_broken = true;
                }
            }
        }
        if let Some(module) = modules::name(&self.workshop.folder, file) {
            self.engine.forget(&module);
        }
    }

    fn put_at_start(&mut self, name: &str) {
        let robots = self.robots.iter_mut().filter(|robot| name.is_empty() || &*robot.form.name == name);
        for robot in robots {
            let Some(bridge) = &mut robot.bridge else { continue };
            bridge.put_at_start();
            self.engine.receive(&messages(&robot.form.name, &mut **bridge));
        }
    }

    fn load(&mut self, mut edit: Edit) -> Result<(), Refused> {
        let states = self.connect(&mut edit.program);
        self.take_over(Command::Load(edit), states)
    }

    /// The robots of an edit are not touched before it is taken over.
    fn apply_held(&mut self) -> Result<(), Refused> {
        let Some(mut program) = self.engine.held_program().cloned() else {
            return self.engine.command(Command::ApplyHeld);
        };
        let states = self.connect(&mut program);
        self.engine.amend_held(program);
        self.take_over(Command::ApplyHeld, states)
    }

    /// A program whose robots are connected.
    fn take_over(&mut self, command: Command, states: Vec<BridgeState>) -> Result<(), Refused> {
        for robot in &self.robots {
            let (description, stale) = match &robot.bridge {
                Some(bridge) => (bridge.description(), bridge.stale()),
                None => {
                    let known = super::robots::description(&robot.form, &self.workshop.plugins);
                    (known.unwrap_or_else(open), None)
                }
            };
            self.engine.describe(&robot.form.name, &description, stale);
        }
        if self.engine.steps() == 0 {
            // What robots said while the program waited for them: what it begins with may need it.
            for robot in &mut self.robots {
                if let Some(bridge) = robot.bridge.as_mut().filter(|bridge| bridge.is_heard_early()) {
                    self.engine.receive(&messages(&robot.form.name, &mut **bridge));
                }
            }
        }
        let result = self.engine.command(command);
        for state in states {
            self.engine.say(What::Bridge(state));
        }
        result
    }

    /// Makes the robots whose form is new or changed; the others stay as they are.
    fn connect(&mut self, program: &mut Arc<Program>) -> Vec<BridgeState> {
        let mut old = std::mem::take(&mut self.robots);
        let mut states = Vec::new();
        for form in program.bridges.clone() {
            let known = old.iter_mut().position(|robot| robot.goes_on_as(&form));
            let robot = match known {
                Some(index) => Robot { form, ..old.swap_remove(index) },
                None => {
                    let (robot, state) = self.make(form, program);
                    states.push(state);
                    robot
                }
            };
            self.robots.push(robot);
        }
        self.part(old);
        states
    }

    fn make(&self, form: model::Bridge, program: &mut Arc<Program>) -> (Robot, BridgeState) {
        match self.workshop.make(&form, program.sources.len() as u16) {
            Ok(bridge) => {
                let state = bridge.state();
                (Robot { uninformed: true, form, bridge: Some(bridge) }, state)
            }
            Err(Problems { sources, diagnostics }) => {
                let message = diagnostics.first().map(|first| first.message.clone());
                let program = Arc::make_mut(program);
                program.sources.extend(sources);
                program.findings.extend(diagnostics);
                let (bridge, kind) = (form.name.clone(), form.kind.clone());
                let state = BridgeState { bridge, kind, state: Health::Lost, message, world: None };
                (Robot { uninformed: false, form, bridge: None }, state)
            }
        }
    }

    fn part(&mut self, robots: Vec<Robot>) {
        for mut bridge in robots.into_iter().filter_map(|robot| robot.bridge) {
            bridge.stop();
            self.parting.extend(bridge.part());
        }
        self.parting.retain(|parting| !parting.is_finished());
    }

    fn hand_over(&mut self, delivery: Delivery, sink: Sink) {
        let Driver { engine, robots, held, told, .. } = self;
        let mut timing = if engine.has_paused() { Delivery::Held } else { delivery };
        let mut now: Vec<Sent> = Vec::new();
        engine.drain(|record| {
            match &record.what {
                What::Pause { .. } => {
                    // What pausing itself sends, to bring a robot to rest, is not to wait.
                    timing = delivery;
                    robots.iter_mut().filter_map(Robot::halting_on_pause).for_each(|bridge| bridge.stop());
                }
                What::Output { bridge, name, value } => {
                    let output = Output { output: name.to_string(), value: value.clone() };
                    timing.of(&mut now, held).push((bridge.clone(), Item::Output(output)));
                }
                What::Call { bridge, name, id, arguments } => {
                    let arguments = arguments.as_array().cloned().unwrap_or_default();
                    let call = Call { call: name.to_string(), id: *id, arguments };
                    timing.of(&mut now, held).push((bridge.clone(), Item::Call(call)));
                }
                What::Cancel { bridge, id } => cancel(robots, &mut [&mut now, held], bridge, *id),
                What::Stop { .. } => {
                    held.clear();
                    now.clear();
                    for bridge in robots.iter_mut().filter_map(|robot| robot.bridge.as_mut()) {
                        bridge.stop();
                    }
                }
                _ => {}
            }
            told.see(&record);
            sink(record);
        });
        told.tell(engine, robots);
        send(robots, now);
    }

    fn deliver_held(&mut self) {
        send(&mut self.robots, std::mem::take(&mut self.held));
    }
}

impl Drop for Driver {
    /// Robots in other processes are given the time to come to rest.
    fn drop(&mut self) {
        let robots = std::mem::take(&mut self.robots);
        self.part(robots);
        for parting in self.parting.drain(..) {
            // A keeper that failed has let go of its process.
            let _ = parting.join();
        }
    }
}

fn open() -> Description {
    Description { scope: Scope::Open, ..Description::default() }
}
