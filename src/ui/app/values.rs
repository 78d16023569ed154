//! Nudging a variable's value: numbers by a tenth in round steps, booleans over and back; opening tables, pinning.

use serde_json::{Number, Value};

use super::{App, Effect};
use crate::runtime::command::Command;
use crate::ui::action::Action;
use crate::ui::format;
use crate::ui::scope::Row;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nudge {
    Up,
    Down,
    FarUp,
    FarDown,
}

impl App {
    /// Why a variable can't be set now.
    pub(super) fn refusal(&self, path: &str) -> Option<String> {
        let known = self.program().is_some_and(|program| program.var(path).is_some());
        if !known {
            return Some(format!("{path} comes from the robot and can't be set here"));
        }
        let valueless = self.view.variables.get(path).is_none_or(|variable| variable.value.is_none());
        valueless.then(|| format!("{path} has no value: its machine isn't running"))
    }

    pub(super) fn nudge(&mut self, nudge: Nudge) -> Vec<Effect> {
        let Some(path) = self.value.clone() else { return Vec::new() };
        let listing = self.values();
        if let Some(row) = listing.row(&path).filter(|row| matches!(row, Row::Item { .. }) || self.opens(row)) {
            return self.open_or_close(row, nudge);
        }
        if let Some(refusal) = self.refusal(&path) {
            return self.say(refusal);
        }
        let on_its_way = self.nudged.as_ref().filter(|(nudged, _)| *nudged == path).map(|(_, value)| value);
        let variable = self.view.variables.get(&path).and_then(|variable| variable.value.as_ref());
        let Some(value) = on_its_way.or(variable) else { return Vec::new() };
        let next = match nudged(value, nudge) {
            Ok(next) => next,
            Err(why) => {
                return self.say(format!("{path} {why}; {} types a value", self.keys().name(Action::EditValue)));
            }
        };
        let Some(value) = format::source(&next) else { return Vec::new() };
        self.nudged = Some((path.clone(), next));
        vec![Effect::Command(Command::Set { var: path.to_string(), value })]
    }
}

impl App {
    fn opens(&self, row: &Row) -> bool {
        row.inside(&self.view).is_some()
    }

    /// As in the machines: what is closed already is left for what is around it.
    fn open_or_close(&mut self, row: &Row, nudge: Nudge) -> Vec<Effect> {
        let Some(path) = row.path().cloned() else { return Vec::new() };
        match (is_up(nudge), row) {
            (true, _) if self.opens(row) => _ = self.arrangement.open.insert(path),
            (false, _) if self.opens(row) && self.arrangement.open.remove(&path) => (),
            (false, Row::Item { .. }) => self.value = path.rsplit_once('.').map(|(outer, _)| outer.into()),
            (true, Row::Item { root, .. }) => {
                let key = self.keys().name(Action::EditValue);
                return self.say(format!("{path} is part of a table; {key} at {root} types the whole of it"));
            }
            _ => return self.refusal(&path).map_or_else(Vec::new, |refusal| self.say(refusal)),
        }
        Vec::new()
    }

    pub(super) fn reset(&mut self) -> Vec<Effect> {
        let Some(path) = self.selected_variable() else { return Vec::new() };
        self.nudged = None;
        vec![Effect::Command(Command::Reset { var: path.to_string() })]
    }

    pub(super) fn pin(&mut self) -> Vec<Effect> {
        let Some(path) = self.selected_variable() else { return Vec::new() };
        let pinned = &mut self.arrangement.pinned;
        match pinned.iter().position(|pinned| *pinned == path) {
            Some(at) => _ = pinned.remove(at),
            None => pinned.push(path),
        }
        Vec::new()
    }
}

/// The next value, or what is said of one that has none.
fn nudged(value: &Value, nudge: Nudge) -> Result<Value, String> {
    match value {
        Value::Bool(yes) => Ok(Value::Bool(!yes)),
        Value::Number(number) => nudged_number(number, nudge),
        // Records carry these as text.
        Value::String(text) if matches!(&**text, "inf" | "-inf" | "nan") => {
            Err(format!("is {}, from where no step leads", format::value(value)))
        }
        _ => Err("is neither a number nor a boolean".into()),
    }
}

fn nudged_number(number: &Number, nudge: Nudge) -> Result<Value, String> {
    let end = || format!("is {number}: a step further would leave the range of numbers");
    if let Some(whole) = number.as_i64() {
        let step = step(whole as f64, nudge).max(1.0) as i64;
        let next = if is_up(nudge) { whole.checked_add(step) } else { whole.checked_sub(step) };
        return next.map(Value::from).ok_or_else(end);
    }
    let n = number.as_f64().ok_or_else(end)?;
    let step = step(n, nudge);
    let raw = if is_up(nudge) { n + step } else { n - step };
    Number::from_f64(tidy(raw, step)).map(Value::Number).ok_or_else(end)
}

fn is_up(nudge: Nudge) -> bool {
    matches!(nudge, Nudge::Up | Nudge::FarUp)
}

/// 1, 2 or 5 times a power of ten, about a tenth of the number; ten times that when far. From zero: 0.1.
fn step(n: f64, nudge: Nudge) -> f64 {
    let near = if n == 0.0 { 0.1 } else { round_step(n.abs() / 10.0) };
    match nudge {
        Nudge::Up | Nudge::Down => near,
        Nudge::FarUp | Nudge::FarDown => near * 10.0,
    }
}

/// The largest of 1, 2, 5 times a power of ten that is not above `n`.
fn round_step(n: f64) -> f64 {
    let power = 10f64.powi((n.log10() + 1e-9).floor() as i32);
    match n / power + 1e-9 {
        part if part >= 5.0 => 5.0 * power,
        part if part >= 2.0 => 2.0 * power,
        _ => power,
    }
}

/// Without the last digits that adding binary fractions leaves: `0.30000000000000004` is 0.3.
fn tidy(n: f64, step: f64) -> f64 {
    let decimals = (2.0 - step.log10().floor()).clamp(0.0, 300.0) as usize;
    format!("{n:.decimals$}").parse().unwrap_or(n)
}
