//! Random programs, random steps, inputs, commands and edits. Whatever happens: no panic, the picture folded from the
//! records is the engine's, an edit leaves alone what it doesn't concern, and a trace read back tells the same.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use lrp::model::Program;
use lrp::runtime::record::{Element, Held, Load, Op};
use lrp::runtime::{BreakAt, Breaking, Command, Engine, Input, OnEdit, Record, Saves, Time, What};
use lrp::session::compile::Compiler;
use lrp::syntax::Source;
use lrp::ui::view::View;
use lrp::ui::view::owner;
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::plot::{Choices, Plot};
use crate::stage::{Event, Stage, lines};

/// What an edit that doesn't concern them leaves alone.
#[derive(PartialEq)]
struct Kept {
    /// Active states, and when they were entered.
    active: BTreeMap<String, Option<Time>>,
    values: BTreeMap<String, Value>,
}

impl Kept {
    fn of(engine: &Engine) -> Kept {
        let active = engine.active().into_iter();
        let entered = |state: &str| owner(state).and_then(|machine| engine.entered(machine));
        Kept {
            active: active.map(|state| (state.clone(), entered(&state))).collect(),
            values: engine.values().into_iter().collect(),
        }
    }

    /// After an edit, with what it said.
    fn check(&self, after: &Kept, load: &Load, mode: OnEdit, set: &[&str]) -> Result<(), String> {
        let ended: Vec<&str> = load.again.iter().chain(&load.discarded).map(|path| &**path).collect();
        match mode {
            OnEdit::Restart if !ended.is_empty() => return Err(format!("{ended:?} started again: {load:?}")),
            OnEdit::Restart if load.restarted && !self.active.keys().any(|state| concerns(load, state)) => {
                return Err(format!("restarted for no reason: {load:?}"));
            }
            OnEdit::Restart if load.restarted => return Ok(()),
            OnEdit::Restart => {}
            OnEdit::Keep if load.restarted => return Err("restarted, though it keeps".into()),
            OnEdit::Keep => {
                let for_no_reason = |machine: &&&str| {
                    let states = self.active.keys();
                    !states.filter(|state| owner(state) == Some(machine)).any(|state| concerns(load, state))
                };
                if let Some(machine) = ended.iter().find(for_no_reason) {
                    return Err(format!("{machine} ended for no reason: {load:?}"));
                }
            }
        }
        let undisturbed = |path: &str| !ended.iter().any(|machine| is_inside(path, machine));
        for (state, entered) in self.active.iter().filter(|(state, _)| undisturbed(state)) {
            if after.active.get(state) != Some(entered) {
                return Err(format!("{state} is disturbed"));
            }
        }
        for (var, value) in self.values.iter().filter(|(var, _)| !set.contains(&var.as_str())) {
            if after.values.get(var).is_some_and(|now| now != value) {
                return Err(format!("{var} has changed"));
            }
        }
        Ok(())
    }
}

/// Whether an edit has anything to do with an active state.
fn concerns(load: &Load, state: &str) -> bool {
    load.changes.iter().any(|change| match (change.op, change.kind) {
        (Op::Removed, Element::Machine) => owner(state) == Some(&*change.path),
        (Op::Removed | Op::Changed, Element::State) => *change.path == *state,
        _ => false,
    })
}

fn is_inside(path: &str, machine: &str) -> bool {
    path.strip_prefix(machine).is_some_and(|rest| rest.starts_with('/'))
}

struct Walk {
    stage: Stage,
    mode: OnEdit,
    /// What taking the held save over would do, as last told.
    held: Option<Held>,
}

pub fn walk(numbers: &[u32]) -> Result<(), String> {
    let choices = &mut Choices::new(numbers);
    let mut plot = Plot::draw(choices);
    let mut walk = Walk { stage: Stage::new(1, Duration::from_secs(5), Vec::new()), mode: OnEdit::Restart, held: None };
    walk.stage.event(Event::Save(plot.text()));
    while !choices.is_empty() {
        match choices.below(3) {
            0 => walk.tick(1 + choices.below(4))?,
            1 => {
                plot.change(choices);
                walk.happens(Event::Save(plot.text()))?;
            }
            _ => walk.happens(event(choices, walk.stage.engine()))?,
        }
    }
    reads_back(&walk.stage.records, &walk.stage.view)
}

impl Walk {
    fn tick(&mut self, times: usize) -> Result<(), String> {
        let known = self.stage.records.len();
        (0..times).for_each(|_| self.stage.tick());
        self.follow_held(known)
    }

    fn happens(&mut self, event: Event) -> Result<(), String> {
        let before = Kept::of(self.stage.engine());
        let known = self.stage.records.len();
        self.stage.event(event.clone());
        let after = Kept::of(self.stage.engine());
        let fresh = &self.stage.records[known..];
        let wrong = |wrong: String| format!("{wrong} by {event:?}\n{}", lines(fresh));
        let load = fresh.iter().find_map(|record| match &record.what {
            What::Load(load) => Some(load),
            _ => None,
        });
        if let Some(load) = load {
            let set = fresh.iter().filter_map(|record| match &record.what {
                What::Set { var, .. } => Some(&**var),
                _ => None,
            });
            before.check(&after, load, self.mode, &set.collect::<Vec<_>>()).map_err(wrong)?;
        } else if let Event::Save(_) = event
            && (before != after || self.stage.engine().held().is_none())
        {
            return Err(wrong("neither taken over nor held".into()));
        }
        match (&event, load, &self.held) {
            (Event::Command(Command::ApplyHeld), Some(load), Some(held)) => {
                let would = (&held.restarts, &held.again, &held.discarded, &held.changes);
                if would != (&load.reason, &load.again, &load.discarded, &load.changes) {
                    return Err(wrong(format!("otherwise than was told: {held:?}")));
                }
            }
            (Event::Command(Command::ApplyHeld), _, Some(_)) => return Err(wrong("not applied".into())),
            (Event::Command(Command::OnEdit { mode }), ..) => self.mode = *mode,
            _ => {}
        }
        self.follow_held(known)
    }

    /// The records say what is held.
    fn follow_held(&mut self, known: usize) -> Result<(), String> {
        for record in &self.stage.records[known..] {
            match &record.what {
                What::Held(held) => self.held = Some(held.clone()),
                What::Load(_) | What::Command { command: Command::DropHeld } => self.held = None,
                _ => {}
            }
        }
        match self.stage.engine().held() == self.held.as_ref() {
            true => Ok(()),
            false => Err(format!("held is {:?}, told was {:?}", self.stage.engine().held(), self.held)),
        }
    }
}

fn event(choices: &mut Choices, engine: &Engine) -> Event {
    let states = &engine.program().states;
    let vars = &engine.program().vars;
    let state = choices.of(states).map(|state| state.path.to_string()).unwrap_or_default();
    let var = choices.of(vars).map(|var| var.path.to_string()).unwrap_or_default();
    Event::Command(match choices.below(21) {
        0 => Command::Pause,
        1 | 2 => Command::Resume,
        3 => Command::TransitionTo { state },
        4 => Command::JumpTo { state },
        5 => Command::Set { var, value: "now() / 7".into() },
        6 => Command::Restart,
        7 => Command::Runstop,
        8 if engine.is_paused() => Command::Step,
        9 | 10 => Command::OnEdit { mode: OnEdit::Keep },
        11 => Command::OnEdit { mode: OnEdit::Restart },
        12 => Command::Saves { mode: Saves::Hold },
        13 => Command::Saves { mode: Saves::Apply },
        14 | 15 => Command::ApplyHeld,
        16 => Command::DropHeld,
        17 => Command::Break { at: BreakAt::State { state: state.into() }, mode: Breaking::Set },
        18 => Command::Break { at: BreakAt::State { state: state.into() }, mode: Breaking::Clear },
        19 => {
            let at = BreakAt::Condition { condition: "now() % 300 == 0".into(), machine: "".into() };
            Command::Break { at, mode: Breaking::Set }
        }
        _ => {
            let value = json!({ "data": choices.below(4) });
            return Event::Input(Input { bridge: "robot".into(), name: "light".into(), value });
        }
    })
}

/// The trace as lines of JSON gives the same records, and the same picture.
fn reads_back(records: &[Record], view: &View) -> Result<(), String> {
    let mut again = View::new(10.0);
    let mut compiler = Compiler::new(Vec::new());
    // What names mean can depend on the program before.
    let mut running: Arc<Program> = Arc::default();
    for record in records {
        let line = serde_json::to_string(record).map_err(|error| error.to_string())?;
        let mut read: Record = serde_json::from_str(&line).map_err(|error| format!("{error}: {line}"))?;
        if let (What::Load(read), What::Load(load)) = (&mut read.what, &record.what) {
            let file = &read.files[0];
            let program = compiler.compile_after(Source::new(file.name.clone(), file.text.clone()), &running);
            read.program = program.ok().map(Arc::new);
            if read.program != load.program {
                return Err(format!("the program differs: {line}"));
            }
            running = read.program.clone().unwrap_or_default();
        }
        if read != *record {
            return Err(format!("read back as {read:?}: {line}"));
        }
        again.apply(&read);
    }
    match again == *view {
        true => Ok(()),
        false => Err(format!("the picture differs\n{again:?}\n{view:?}")),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_happens_it_holds(numbers in prop::collection::vec(any::<u32>(), 60..500)) {
        if let Err(wrong) = walk(&numbers) {
            return Err(TestCaseError::fail(wrong));
        }
    }
}
