//! Records as short lines for reading, and how a program stands as its records tell it.

use serde_json::Value;

use super::bench::Trouble;
use super::failure::Situation;
use super::value::text;
use crate::runtime::record::{Change, Finding, Forced, Health, Load, Record, Taken, What};
use crate::runtime::{Breaking, Command, Engine};

const SHOWN: usize = 8;

pub fn situation(engine: &Engine, records: &[Record], troubles: &[Trouble]) -> Situation {
    let paused = if engine.is_paused() { ", paused" } else { "" };
    let told: Vec<&Record> = records.iter().filter(|record| !is_message(&record.what)).collect();
    let start = told.len().saturating_sub(SHOWN);
    Situation {
        time: format!("{} ms, step {}{paused}", engine.now().ms(), engine.steps()),
        active: Some(engine.active())
            .filter(|active| !active.is_empty())
            .unwrap_or_else(|| vec!["no machine runs".to_string()]),
        records: told[start..].iter().map(|record| line(record)).collect(),
        robot: messages(engine.steps(), records),
        errors: troubles.iter().map(trouble).collect(),
    }
}

fn is_message(what: &What) -> bool {
    matches!(what, What::Input { .. } | What::Output { .. } | What::Status { .. })
}

/// The latest message of each input, then what was sent in the last step.
fn messages(step: u64, records: &[Record]) -> Vec<String> {
    let mut inputs: Vec<&Record> = Vec::new();
    for record in records {
        if let What::Input { bridge, name, .. } = &record.what {
            let same = |other: &&Record| matches!(&other.what, What::Input { bridge: b, name: n, .. } if b == bridge && n == name);
            inputs.retain(|other| !same(other));
            inputs.push(record);
        }
    }
    let outputs = records.iter().rev().take_while(|record| record.step == step);
    let mut outputs: Vec<&Record> = outputs.filter(|record| matches!(record.what, What::Output { .. })).collect();
    outputs.reverse();
    inputs.into_iter().chain(outputs).map(line).collect()
}

fn line(record: &Record) -> String {
    format!("{:>8} ms  {}", record.t.ms(), what(&record.what))
}

fn trouble(trouble: &Trouble) -> String {
    let Trouble { finding: Finding { file, line, column, message, .. }, count, .. } = trouble;
    match count {
        0 | 1 => format!("{file}:{line}:{column}: {message}"),
        count => format!("{file}:{line}:{column}: {message} ({count} times)"),
    }
}

fn what(what: &What) -> String {
    match what {
        What::Load(loaded) => load(loaded),
        What::Reject { findings, .. } => match findings.first() {
            Some(first) => format!("edit refused: {}:{}:{}: {}", first.file, first.line, first.column, first.message),
            None => "edit refused".to_string(),
        },
        What::Held(held) => format!("edit held: {} changes", held.changes.len()),
        What::Breakpoints { all } => format!("{} breakpoints", all.len()),
        What::Command { command: asked } => format!("command {}", command(asked)),
        What::Spawn { machine, by: Some(by) } => format!("spawn {machine} by {by}"),
        What::Spawn { machine, by: None } => format!("spawn {machine}"),
        What::Enter { state } => format!("enter {state}"),
        What::Exit { state } => format!("exit {state}"),
        What::Transition(taken) => transition(taken),
        What::Guards { state, .. } => format!("guards of {state}"),
        What::Discard { machine } => format!("discard {machine}"),
        What::Set { var, value, by } => format!("{var} = {} by {by}", text(value)),
        What::Input { bridge, name, value } => format!("{bridge}.{name} is {}", text(value)),
        What::Output { bridge, name, value } => sent(bridge, name, value),
        What::Call { bridge, name, arguments, .. } => format!("call {bridge}.{name} {}", text(arguments)),
        What::Offer { bridge, .. } => format!("{bridge} offers something else"),
        What::Found { bridge, found } => format!("{bridge} sees {} things", found.len()),
        What::Cancel { bridge, id } => format!("cancel call {id} of {bridge}"),
        What::Reply { bridge, name, done: false, value, .. } => format!("feedback of {bridge}.{name}: {}", text(value)),
        What::Reply { bridge, name, error: Some(error), .. } => format!("{bridge}.{name} failed: {error}"),
        What::Reply { bridge, name, value, .. } => format!("reply to {bridge}.{name}: {}", text(value)),
        What::Log(log) => format!("log {:?}: {}", log.level, log.message),
        What::Error(fault) => format!("error {}:{}:{}: {}", fault.file, fault.line, fault.column, fault.message),
        What::Mended(mended) => format!("mended {}:{}:{}: {}", mended.file, mended.line, mended.column, mended.code),
        What::Pause { reason, .. } => format!("pause: {reason}"),
        What::Resume => "resume".to_string(),
        What::Force { state, how: Forced::Transition } => format!("transition by hand to {state}"),
        What::Force { state, how: Forced::Jump } => format!("jump by hand to {state}"),
        What::Restart { reason } => format!("restart: {reason}"),
        What::Stop { reason } => format!("robot stopped: {reason}"),
        What::Skip { steps } => format!("{steps} steps skipped"),
        What::Status { rate, .. } => format!("{rate} steps a second"),
        What::Bridge(state) => match state.state {
            Health::Connecting => format!("bridge {} connecting", state.bridge),
            Health::Up => format!("bridge {} up", state.bridge),
            Health::Lost => format!("bridge {} lost", state.bridge),
        },
    }
}

/// A message as a program sends it.
pub fn sent(bridge: &str, name: &str, value: &Value) -> String {
    match value {
        Value::Object(_) | Value::Array(_) => format!("{bridge}.{name}{}", text(value)),
        plain => format!("{bridge}.{name}({})", text(plain)),
    }
}

fn transition(taken: &Taken) -> String {
    let last = |path: &str| path.rsplit('/').next().unwrap_or_default().to_string();
    let trigger = match &*taken.trigger {
        "block" => "on a block".to_string(),
        word @ ("eps" | "ontime") => word.to_string(),
        event => format!("on {event}"),
    };
    let why = taken.name.as_ref().map_or(trigger.clone(), |name| format!("{name}, {trigger}"));
    let via = taken.via.as_ref().map_or(String::new(), |via| format!(" via {}", last(via)));
    format!("{}: {} -> {}{via} ({why})", taken.machine, last(&taken.from), last(&taken.to))
}

fn load(load: &Load) -> String {
    let changes: Vec<String> = load.changes.iter().take(4).map(change).collect();
    let more = match load.changes.len().saturating_sub(changes.len()) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let which = if changes.is_empty() { String::new() } else { format!(" {}{more}", changes.join(", ")) };
    let outcome = load.reason.as_ref().map_or(String::new(), |reason| format!("; restarted: {reason}"));
    format!("load{which}{outcome}")
}

fn change(Change { op, path, to, .. }: &Change) -> String {
    let to = to.as_ref().map(|to| format!(" to {to}")).unwrap_or_default();
    format!("{} {path}{to}", format!("{op:?}").to_lowercase())
}

fn command(command: &Command) -> String {
    match command {
        Command::Load(_) => "load".to_string(),
        Command::Reject { .. } => "reject".to_string(),
        Command::Pause => "pause".to_string(),
        Command::Resume => "resume".to_string(),
        Command::Step => "step".to_string(),
        Command::Rate { hz } => format!("rate {hz}"),
        Command::TransitionTo { state } => format!("transition to {state}"),
        Command::JumpTo { state } => format!("jump to {state}"),
        Command::Set { var, value } => format!("set {var} to {value}"),
        Command::Reset { var } => format!("reset {var}"),
        Command::Restart => "restart".to_string(),
        Command::Runstop => "runstop".to_string(),
        Command::FileChanged { file } => format!("file {file} changed"),
        Command::Tell { bridge, what } => format!("tell {bridge}.{what}"),
        Command::PutAtStart { bridge } => format!("put {bridge} at its start"),
        Command::OnEdit { mode } => format!("on edit: {mode:?}").to_lowercase(),
        Command::Saves { mode } => format!("saves: {mode:?}").to_lowercase(),
        Command::ApplyHeld => "apply the held edit".to_string(),
        Command::DropHeld => "drop the held edit".to_string(),
        Command::Break { at, mode: Breaking::Set } => format!("break at {at}"),
        Command::Break { at, mode: Breaking::Clear } => format!("no break at {at}"),
        Command::OnError { mode } => format!("on error: {mode:?}").to_lowercase(),
        Command::Explain { mode } => format!("explain: {mode:?}").to_lowercase(),
    }
}
