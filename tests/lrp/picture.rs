//! Whether the screen's picture, folded from records, is the engine's own: active states, values, visits, times,
//! breakpoints, mode.

use std::collections::{BTreeMap, BTreeSet};

use lrp::runtime::Engine;
use lrp::ui::view::{Mode, Origin, View, owner};

pub fn agrees(view: &View, engine: &Engine) -> Result<(), String> {
    let same = |what: &str, seen: String, is: String| match seen == is {
        true => Ok(()),
        false => Err(format!("{what}: seen {seen}, is {is}")),
    };
    let seen: BTreeSet<&str> =
        view.machines.keys().filter_map(|machine| view.active(machine)).map(|path| &**path).collect();
    let active = engine.active();
    let is: BTreeSet<&str> = active.iter().map(String::as_str).collect();
    same("active states", format!("{seen:?}"), format!("{is:?}"))?;
    if is.len() != active.len() {
        return Err(format!("a machine runs twice: {active:?}"));
    }
    for state in &active {
        let machine = owner(state).ok_or_else(|| format!("state {state} has no machine"))?;
        let seen = view.machines.get(machine).map(|machine| machine.entered);
        same(&format!("entered {machine}"), format!("{seen:?}"), format!("{:?}", engine.entered(machine)))?;
    }
    let seen = view.variables.iter().filter_map(|(path, var)| Some((path.to_string(), var.value.clone()?)));
    let seen: BTreeMap<_, _> = seen.collect();
    let is: BTreeMap<_, _> = engine.values().into_iter().collect();
    same("values", format!("{seen:?}"), format!("{is:?}"))?;
    for state in &engine.program().states {
        let seen = view.states.get(&state.path).map_or(0, |state| state.visits);
        same(
            &format!("visits of {}", state.path),
            seen.to_string(),
            engine.visits(&state.path).unwrap_or(0).to_string(),
        )?;
    }
    let seen = view.problems.iter().filter(|problem| problem.origin == Origin::Run);
    let seen = seen.map(|problem| (problem.key.code.clone(), problem.key.line, problem.key.column, problem.count));
    let is = engine.faults().map(|fault| (fault.code, fault.line, fault.column, fault.count));
    same("faults", format!("{:?}", seen.collect::<BTreeSet<_>>()), format!("{:?}", is.collect::<BTreeSet<_>>()))?;
    for (machine, running) in view.machines.iter().filter(|(_, machine)| machine.running) {
        if let Some(state) = running.spawned_by.as_ref().filter(|state| !view.is_active(state)) {
            return Err(format!("{machine} runs, but {state} that spawned it is not active"));
        }
    }
    same("breakpoints", format!("{:?}", view.breakpoints), format!("{:?}", engine.breakpoints()))?;
    same("paused", (view.mode != Mode::Running).to_string(), engine.is_paused().to_string())
}
