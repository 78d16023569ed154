//! What an edit leaves alone where it doesn't concern it: active states, the times they were entered, values, visits.

use std::collections::BTreeMap;

use lrp::runtime::record::{Element, Load, Op};
use lrp::runtime::{Engine, OnEdit, Time};
use lrp::ui::view::owner;
use serde_json::Value;

use crate::stage::Stage;

#[derive(PartialEq)]
pub struct Kept {
    /// Active states, and when they were entered.
    active: BTreeMap<String, Option<Time>>,
    values: BTreeMap<String, Value>,
    /// Of all states.
    visits: BTreeMap<String, u64>,
    /// The state that spawned a running machine.
    spawned_by: BTreeMap<String, String>,
}

impl Kept {
    pub fn of(stage: &Stage) -> Kept {
        let (engine, machines) = (stage.engine(), stage.view.machines.iter());
        let running = machines.filter(|(_, machine)| machine.running);
        let active = engine.active().into_iter();
        let entered = |state: &str| owner(state).and_then(|machine| engine.entered(machine));
        Kept {
            active: active.map(|state| (state.clone(), entered(&state))).collect(),
            values: engine.values().into_iter().collect(),
            visits: engine.program().states.iter().map(|state| visits(engine, &state.path)).collect(),
            spawned_by: running
                .filter_map(|(path, it)| Some((path.to_string(), it.spawned_by.as_ref()?.to_string())))
                .collect(),
        }
    }

    /// After an edit, with what it said.
    pub fn check(&self, after: &Kept, load: &Load, mode: OnEdit, set: &[&str]) -> Result<(), String> {
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
        let undisturbed = |path: &str| !self.around(path).any(|machine| ended.contains(&machine));
        for (state, entered) in self.active.iter().filter(|(state, _)| undisturbed(state)) {
            if after.active.get(&called(load, state)) != Some(entered) {
                return Err(format!("{state} is disturbed"));
            }
        }
        for (var, value) in &self.values {
            let now = called(load, var);
            if !set.contains(&&*now) && after.values.get(&now).is_some_and(|now| now != value) {
                return Err(format!("{var} has changed"));
            }
        }
        let ran = |state: &str| self.active.keys().any(|active| owner(active) == owner(state));
        for (state, visits) in self.visits.iter().filter(|(state, _)| ran(state) && undisturbed(state)) {
            if after.visits.get(&called(load, state)).is_some_and(|now| now != visits) {
                return Err(format!("visits of {state} have changed"));
            }
        }
        Ok(())
    }

    /// The machine of a state, and those that it runs in.
    fn around<'a>(&'a self, state: &'a str) -> impl Iterator<Item = &'a str> {
        std::iter::successors(owner(state), |&machine| owner(self.spawned_by.get(machine)?))
    }
}

fn visits(engine: &Engine, state: &str) -> (String, u64) {
    (state.into(), engine.visits(state).unwrap_or(0))
}

/// A path after an edit that may have renamed things on it: the innermost of them says it all.
pub(super) fn called(load: &Load, path: &str) -> String {
    let renames = load.changes.iter().filter_map(|change| Some((&*change.path, &**change.to.as_ref()?)));
    let on_it = renames.filter_map(|(old, new)| Some((new, path.strip_prefix(old)?)));
    let on_it = on_it.filter(|(_, rest)| rest.is_empty() || rest.starts_with('/'));
    on_it.min_by_key(|(_, rest)| rest.len()).map_or(path.into(), |(new, rest)| format!("{new}{rest}"))
}

/// Whether an edit has anything to do with an active state.
fn concerns(load: &Load, state: &str) -> bool {
    load.changes.iter().any(|change| match (change.op, change.kind) {
        (Op::Removed, Element::Machine) => owner(state) == Some(&*change.path),
        (Op::Removed | Op::Changed, Element::State) => *change.path == *state,
        _ => false,
    })
}
