//! The engine and the model beside each other: whatever happens to one happens to the other, and both must look alike.

use std::fmt::Debug;
use std::sync::Arc;
use std::time::Duration;

use lrp::model::Program;
use lrp::runtime::{Command, OnEdit, Time, What};
use lrp::session::compile::Compiler;
use lrp::syntax::Source;
use serde_json::{Value, json};

use super::edit::Verdict;
use super::outline::Outline;
use super::running::Running;
use super::tree::*;
use crate::stage::{Event, Stage};

/// Between two steps, ms.
pub const PERIOD: i64 = 200;

pub struct Pair {
    engine: Stage,
    model: Running,
    mode: OnEdit,
}

/// A machine's state, when it was entered, ms; each variable's value, each state's visits: by path.
#[derive(PartialEq, Debug)]
struct Picture {
    active: Vec<(String, f64)>,
    values: Vec<(String, Value)>,
    visits: Vec<(String, u64)>,
}

/// A tree is always a program.
pub fn compiled(tree: &Tree) -> Arc<Program> {
    let program = Compiler::new(Vec::new()).compile(Source::new("case.lrp", tree.to_string()));
    Arc::new(program.unwrap_or_else(|rejected| panic!("{tree}\n{:?}", rejected.diagnostics)))
}

impl Verdict {
    fn unlike(&self, seen: &Verdict) -> String {
        let lists = [
            unlike("changes", &self.changes, &seen.changes),
            unlike("reason", self.reason.as_slice(), seen.reason.as_slice()),
            unlike("again", &self.again, &seen.again),
            unlike("discarded", &self.discarded, &seen.discarded),
        ];
        lists.concat()
    }
}

impl Picture {
    fn unlike(&self, seen: &Picture) -> String {
        let lists = [
            unlike("active", &self.active, &seen.active),
            unlike("values", &self.values, &seen.values),
            unlike("visits", &self.visits, &seen.visits),
        ];
        lists.concat()
    }
}

fn unlike<T: PartialEq + Debug>(what: &str, expected: &[T], seen: &[T]) -> String {
    let missing: Vec<&T> = expected.iter().filter(|it| !seen.contains(it)).collect();
    let extra: Vec<&T> = seen.iter().filter(|it| !expected.contains(it)).collect();
    match expected == seen {
        true => String::new(),
        false if missing.is_empty() && extra.is_empty() => format!("\n  order of {what}: {expected:?}, seen {seen:?}"),
        false => format!("\n  {what}: expected {missing:?}, seen {extra:?}"),
    }
}

impl Pair {
    /// `program`: the tree, compiled.
    pub fn new(tree: Tree, program: &Arc<Program>, mode: OnEdit) -> Result<Pair, String> {
        let mut engine = Stage::new(1, Duration::from_secs(5), Vec::new());
        engine.event(Event::Command(Command::Rate { hz: 1000.0 / PERIOD as f64 }));
        engine.command(Command::OnEdit { mode });
        engine.command(Command::Load(Arc::clone(program).into()));
        let pair = Pair { engine, model: Running::new(tree), mode };
        if let Some(fault) = pair.engine.engine().faults().next() {
            return Err(format!("{}\n{fault:?}", pair.model.tree));
        }
        pair.alike("at the start")?;
        Ok(pair)
    }

    pub fn until(&mut self, ms: i64) -> Result<(), String> {
        while self.model.now < ms {
            self.engine.tick();
            self.model.step(self.model.now + PERIOD);
            self.alike("after a step")?;
        }
        Ok(())
    }

    /// A transition by hand, to a state of a machine at top level that runs.
    pub fn go(&mut self, path: &str) -> Result<(), String> {
        self.engine.event(Event::Command(Command::TransitionTo { state: path.into() }));
        let tree = self.model.tree.clone();
        let outline = Outline::of(&tree);
        let (&to, at) = outline.states.iter().find(|(_, at)| at.path == path).expect("it is there");
        self.model.go(&outline, at.of, to);
        self.alike("after a transition by hand")
    }

    /// Gives a variable another value, if it has one.
    pub fn tune(&mut self, name: &str, value: i64) {
        let tree = self.model.tree.clone();
        let outline = Outline::of(&tree);
        let at = outline.vars.iter().find(|at| at.var.name == name).expect("it is there");
        if let Some(known) = self.model.values.get_mut(&at.var.id) {
            *known = Some(value);
            let set = Command::Set { var: at.path.clone(), value: value.to_string() };
            self.engine.event(Event::Command(set));
        }
    }

    /// And on again.
    pub fn pause(&mut self) -> Result<(), String> {
        self.engine.event(Event::Command(Command::Pause));
        self.engine.tick();
        self.engine.event(Event::Command(Command::Resume));
        let tree = self.model.tree.clone();
        for action in tree.onpause.iter().chain(&tree.onresume) {
            self.model.do_one(&Outline::of(&tree), action, None);
        }
        self.alike("after a pause")
    }

    pub fn now(&self) -> i64 {
        self.model.now
    }

    pub fn save(&mut self, tree: Tree) -> Result<(), String> {
        let (before, known) = (self.model.tree.clone(), self.engine.records.len());
        self.engine.event(Event::Save(tree.to_string()));
        let expected = self.model.edit(tree, self.mode);
        let texts = || format!("before:\n{before}\nafter:\n{}", self.model.tree);
        let records = &self.engine.records[known..];
        let load = records.iter().find_map(|record| match &record.what {
            What::Load(load) => Some(load),
            _ => None,
        });
        let load = load.ok_or_else(|| format!("refused: {records:?}\n{}", texts()))?;
        let paths = |list: &[Arc<str>]| list.iter().map(|path| path.to_string()).collect();
        let mut changes = load.changes.clone();
        changes.sort();
        let (again, discarded) = (paths(&load.again), paths(&load.discarded));
        let seen = Verdict { changes, reason: load.reason.clone(), again, discarded };
        if seen != expected {
            return Err(format!("{}\n{}", expected.unlike(&seen), texts()));
        }
        self.alike("after the edit").map_err(|wrong| format!("{wrong}\n{}", texts()))
    }

    fn alike(&self, when: &str) -> Result<(), String> {
        let (seen, expected) = (self.seen(), self.expected());
        match seen == expected {
            true => Ok(()),
            false => Err(format!("at {} {when}: {}", self.model.now, expected.unlike(&seen))),
        }
    }

    fn seen(&self) -> Picture {
        let engine = self.engine.engine();
        let entered = |state: &str| {
            let machine = &state[..state.rfind('/').unwrap_or(0)];
            engine.entered(machine).map_or(-1.0, Time::ms)
        };
        let active = engine.active().into_iter().map(|state| (state.clone(), entered(&state))).collect();
        let mut values = engine.values();
        values.sort_by(|a, b| a.0.cmp(&b.0));
        let paths = engine.program().states.iter().map(|state| state.path.to_string());
        let mut visits: Vec<(String, u64)> =
            paths.map(|path| (path.clone(), engine.visits(&path).unwrap_or(0))).collect();
        visits.sort();
        Picture { active, values, visits }
    }

    fn expected(&self) -> Picture {
        let outline = Outline::of(&self.model.tree);
        let mut active = Vec::new();
        self.model.tops.iter().for_each(|&top| self.collect(&outline, top, &mut active));
        let value = |id| self.model.values.get(&id);
        let values = outline.vars.iter().filter_map(|at| Some((at.path.clone(), json!(value(at.var.id)?))));
        let mut values: Vec<(String, Value)> = values.collect();
        values.sort_by(|a, b| a.0.cmp(&b.0));
        let visits = |id| self.model.visits.get(id).copied().unwrap_or(0);
        let mut visits: Vec<(String, u64)> =
            outline.states.iter().map(|(id, at)| (at.path.clone(), visits(id))).collect();
        visits.sort();
        Picture { active, values, visits }
    }

    fn collect(&self, outline: &Outline, machine: Id, active: &mut Vec<(String, f64)>) {
        let at = &self.model.machines[&machine];
        active.push((outline.states[&at.state].path.clone(), at.entered as f64));
        at.nested.iter().for_each(|&nested| self.collect(outline, nested, active));
    }
}
