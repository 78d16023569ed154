//! Random programs, random steps, inputs, commands and edits. Whatever happens: no panic, the picture folded from the
//! records is the engine's, an edit leaves alone what it doesn't concern, and a trace read back tells the same.

mod breaks;
mod kept;

use std::sync::Arc;
use std::time::Duration;

use lrp::model::Program;
use lrp::runtime::record::{Change, Held, Load, Op};
use lrp::runtime::{BreakAt, Breaking, Command, Engine, Input, OnEdit, OnError, Record, Saves, What};
use lrp::session::compile::Compiler;
use lrp::syntax::Source;
use lrp::ui::view::View;
use proptest::prelude::*;
use serde_json::json;

use breaks::{AtTransitions, Watched};
use kept::Kept;

use crate::plot::{Choices, Plot};
use crate::stage::{Event, Stage, lines};

struct Walk {
    stage: Stage,
    mode: OnEdit,
    /// What taking the held save over would do, as last told.
    held: Option<Held>,
    /// Conditions to pause on.
    watched: Vec<Watched>,
}

/// A byte is choice enough.
pub fn walk_by_bytes(bytes: &[u8]) -> Result<(), String> {
    walk(&bytes.iter().map(|&byte| u32::from(byte)).collect::<Vec<u32>>())
}

fn walk(numbers: &[u32]) -> Result<(), String> {
    let choices = &mut Choices::new(numbers);
    let (mut plot, mut other) = (Plot::draw(choices), Plot::draw(choices));
    let stage = Stage::new(1, Duration::from_secs(5), Vec::new());
    let mut walk = Walk { stage, mode: OnEdit::Restart, held: None, watched: Vec::new() };
    walk.stage.event(Event::Save(plot.text()));
    while !choices.is_empty() {
        match choices.below(4) {
            0 => walk.tick(1 + choices.below(4))?,
            1 => walk.edit(&mut plot, &mut other, choices)?,
            2 => walk.set_break(choices)?,
            _ => walk.happens(event(choices, walk.stage.engine()))?,
        }
    }
    reads_back(&walk.stage.records, &walk.stage.view)
}

impl Walk {
    fn edit(&mut self, plot: &mut Plot, other: &mut Plot, choices: &mut Choices) -> Result<(), String> {
        match choices.below(14) {
            0 | 1 => {
                let before = plot.text();
                return match plot.rename(choices) {
                    Some(names) => self.rename(&before, plot.text(), names),
                    None => Ok(()),
                };
            }
            2 | 3 => plot.rename_half(choices),
            4 => {
                let text = plot.text();
                return self.spoil(text.chars().take(choices.below(text.len())).collect());
            }
            5 => return self.spoil(String::new()),
            6 => std::mem::swap(plot, other),
            _ => plot.change(choices),
        }
        self.happens(Event::Save(plot.text()))
    }

    /// Everything that is renamed along makes it a rename, which disturbs nothing.
    fn rename(&mut self, before: &str, text: String, (old, new): (String, String)) -> Result<(), String> {
        let runs = self.stage.engine().program().sources.first().is_some_and(|source| *source.text == *before);
        let known = self.stage.records.len();
        self.happens(Event::Save(text))?;
        let fresh = &self.stage.records[known..];
        let is_it = |change: &Change| {
            let ends = |path: &str, name: &str| path.rsplit('/').next() == Some(name);
            change.op == Op::Renamed && ends(&change.path, &old) && change.to.as_ref().is_some_and(|to| ends(to, &new))
        };
        // A name that meant nothing where it stood may have been changed with it.
        let renamed = |load: &Load| {
            let alone = load.changes.len() == 1;
            load.changes.iter().any(is_it) && !(alone && (load.restarted || !load.again.is_empty()))
        };
        match loaded(fresh) {
            Some(load) if runs && !renamed(load) => {
                Err(format!("{old} was renamed to {new}: {}\nbefore\n{before}", lines(fresh)))
            }
            _ => Ok(()),
        }
    }

    /// A text that may not be a program: then nothing is disturbed.
    fn spoil(&mut self, text: String) -> Result<(), String> {
        let before = Kept::of(&self.stage);
        let known = self.stage.records.len();
        self.stage.event(Event::Save(text.clone()));
        let rejected = self.stage.records[known..].iter().any(|record| matches!(record.what, What::Reject { .. }));
        match rejected && before != Kept::of(&self.stage) {
            true => Err(format!("disturbed by a text that is none:\n{text}")),
            false => self.follow(known),
        }
    }

    /// On a condition with a variable, or at a transition.
    fn set_break(&mut self, choices: &mut Choices) -> Result<(), String> {
        let program = Arc::clone(self.stage.engine().program());
        if choices.below(2) == 0 {
            let command = breaks::set_at_transition(choices, &program);
            return command.map_or(Ok(()), |command| self.happens(Event::Command(command)));
        }
        let Some(watched) = Watched::draw(choices, &program) else { return Ok(()) };
        self.happens(Event::Command(watched.set()))?;
        self.watched.push(watched);
        Ok(())
    }

    /// Conditions that were set have their variables' names of now, whatever else is called so in them.
    fn follow_conditions(&mut self, load: &Load) -> Result<(), String> {
        let engine = self.stage.engine();
        let program = engine.program();
        self.watched = self.watched.iter().filter_map(|watched| watched.follow(load, program)).collect();
        match self.watched.iter().find(|watched| !watched.is_set(engine)) {
            Some(lost) => Err(format!("lost {lost:?} of {:?}", engine.breakpoints())),
            None => Ok(()),
        }
    }

    fn tick(&mut self, times: usize) -> Result<(), String> {
        let known = self.stage.records.len();
        (0..times).for_each(|_| self.stage.tick());
        self.follow(known)
    }

    fn happens(&mut self, event: Event) -> Result<(), String> {
        let before = Kept::of(&self.stage);
        let at_transitions = AtTransitions::of(self.stage.engine());
        self.watched.retain(|watched| watched.is_set(self.stage.engine()));
        let known = self.stage.records.len();
        self.stage.event(event.clone());
        let after = Kept::of(&self.stage);
        let told = self.stage.records[known..].to_vec();
        if let Some(load) = loaded(&told) {
            let wrong = |wrong: String| format!("{wrong} by {event:?}\n{}", lines(&told));
            at_transitions.check(&AtTransitions::of(self.stage.engine()), load).map_err(wrong)?;
            self.follow_conditions(load).map_err(wrong)?;
        }
        let fresh = &self.stage.records[known..];
        let wrong = |wrong: String| format!("{wrong} by {event:?}\n{}", lines(fresh));
        let load = loaded(fresh);
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
        self.follow(known)
    }

    /// The records say what is held and in which mode, and so does the picture.
    fn follow(&mut self, known: usize) -> Result<(), String> {
        for record in &self.stage.records[known..] {
            match &record.what {
                What::Held(held) => self.held = Some(held.clone()),
                What::Load(_) | What::Command { command: Command::DropHeld } => self.held = None,
                _ => {}
            }
        }
        let view = &self.stage.view;
        if (&view.held, view.choices.on_edit) != (&self.held, self.mode) {
            return Err(format!(
                "pictured: {:?}, {:?}; told: {:?}, {:?}",
                view.held, view.choices, self.held, self.mode
            ));
        }
        match self.stage.engine().held() == self.held.as_ref() {
            true => Ok(()),
            false => Err(format!("held is {:?}, told was {:?}", self.stage.engine().held(), self.held)),
        }
    }
}

fn loaded(records: &[Record]) -> Option<&Load> {
    records.iter().find_map(|record| match &record.what {
        What::Load(load) => Some(load),
        _ => None,
    })
}

fn event(choices: &mut Choices, engine: &Engine) -> Event {
    let states = &engine.program().states;
    let vars = &engine.program().vars;
    let state = choices.of(states).map(|state| state.path.to_string()).unwrap_or_default();
    let var = choices.of(vars).map(|var| var.path.to_string()).unwrap_or_default();
    Event::Command(match choices.below(24) {
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
        20 => match engine.breakpoints().first() {
            Some(first) => Command::Break { at: first.at.clone(), mode: Breaking::Clear },
            None => Command::OnError { mode: OnError::Continue },
        },
        21 => Command::OnError { mode: OnError::Pause },
        22 => Command::Reset { var },
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
