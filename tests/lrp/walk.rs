//! Random programs, random steps, inputs, commands and edits. Whatever happens: no panic, the picture folded from the
//! records is the engine's, an edit leaves alone what it doesn't concern, and a trace read back tells the same.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use lrp::runtime::record::{Element, Load, Op};
use lrp::runtime::{Command, Engine, Input, Record, Time, What};
use lrp::session::compile::Compiler;
use lrp::syntax::Source;
use lrp::ui::view::View;
use lrp::ui::view::owner;
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::plot::{Choices, Plot};
use crate::stage::{Event, Stage, lines};

/// What an edit that doesn't concern them leaves alone.
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
    fn check(&self, after: &Kept, load: &Load, set: &[&str]) -> Result<(), String> {
        if load.restarted {
            let concerns = |state: &str| {
                load.changes.iter().any(|change| match (change.op, change.kind) {
                    (Op::Removed, Element::Machine) => owner(state) == Some(&*change.path),
                    (Op::Removed | Op::Changed, Element::State) => *change.path == *state,
                    _ => false,
                })
            };
            return match self.active.keys().any(|state| concerns(state)) {
                true => Ok(()),
                false => Err(format!("restarted for no reason: {load:?}")),
            };
        }
        for (state, entered) in &self.active {
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

pub fn walk(numbers: &[u32]) -> Result<(), String> {
    let choices = &mut Choices::new(numbers);
    let mut plot = Plot::draw(choices);
    let mut stage = Stage::new(1, Duration::from_secs(5), Vec::new());
    stage.event(Event::Save(plot.text()));
    while !choices.is_empty() {
        match choices.below(3) {
            0 => (0..1 + choices.below(4)).for_each(|_| stage.tick()),
            1 => {
                plot.change(choices);
                edit(&mut stage, plot.text())?;
            }
            _ => {
                let event = event(choices, stage.engine());
                stage.event(event);
            }
        }
    }
    reads_back(&stage.records, &stage.view)
}

fn edit(stage: &mut Stage, text: String) -> Result<(), String> {
    let before = Kept::of(stage.engine());
    let known = stage.records.len();
    stage.event(Event::Save(text.clone()));
    let after = Kept::of(stage.engine());
    let fresh = &stage.records[known..];
    let load = fresh.iter().find_map(|record| match &record.what {
        What::Load(load) => Some(load),
        _ => None,
    });
    let load = load.ok_or_else(|| format!("refused:\n{}\n{text}", lines(fresh)))?;
    let set = fresh.iter().filter_map(|record| match &record.what {
        What::Set { var, .. } => Some(&**var),
        _ => None,
    });
    before
        .check(&after, load, &set.collect::<Vec<_>>())
        .map_err(|wrong| format!("{wrong} by\n{}\n{text}", lines(fresh)))
}

fn event(choices: &mut Choices, engine: &Engine) -> Event {
    let states = &engine.program().states;
    let vars = &engine.program().vars;
    let state = choices.of(states).map(|state| state.path.to_string()).unwrap_or_default();
    let var = choices.of(vars).map(|var| var.path.to_string()).unwrap_or_default();
    Event::Command(match choices.below(10) {
        0 => Command::Pause,
        1 | 2 => Command::Resume,
        3 => Command::TransitionTo { state },
        4 => Command::JumpTo { state },
        5 => Command::Set { var, value: "now() / 7".into() },
        6 => Command::Restart,
        7 => Command::Runstop,
        8 if engine.is_paused() => Command::Step,
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
    for record in records {
        let line = serde_json::to_string(record).map_err(|error| error.to_string())?;
        let mut read: Record = serde_json::from_str(&line).map_err(|error| format!("{error}: {line}"))?;
        if let (What::Load(read), What::Load(load)) = (&mut read.what, &record.what) {
            let file = &read.files[0];
            let program = compiler.compile(Source::new(file.name.clone(), file.text.clone()));
            read.program = program.ok().map(Arc::new);
            if read.program != load.program {
                return Err(format!("the program differs: {line}"));
            }
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
