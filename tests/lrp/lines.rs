//! A record as one readable line: `5 500 enter esc/tock`.

use lrp::runtime::record::{Because, Breakpoint, Change, Fault, Finding, Forced, Held, Load, Log, Op, Taken, Way};
use lrp::runtime::{Command, Record, What};

type Path = std::sync::Arc<str>;

/// With a line's end. Texts of programs are left out.
pub fn line(record: &Record) -> String {
    let what = match &record.what {
        What::Load(load) => loaded(load),
        What::Reject { findings, .. } => {
            format!("reject{}", findings.iter().map(|it| format!("\n    {}", finding(it))).collect::<String>())
        }
        What::Held(held) => waiting(held),
        What::Breakpoints { all } => {
            let each = |it: &Breakpoint| format!("\n    {} by {:?}", it.at, it.by).to_lowercase();
            format!("breakpoints{}", all.iter().map(each).collect::<String>())
        }
        What::Command { command } => format!("command {}", commanded(command)),
        What::Spawn { machine, by: Some(by) } => format!("spawn {machine} by {by}"),
        What::Spawn { machine, by: None } => format!("spawn {machine}"),
        What::Enter { state } => format!("enter {state}"),
        What::Exit { state } => format!("exit {state}"),
        What::Transition(taken) => transition(taken),
        What::Guards { state, ways } => {
            format!("guards {state}{}", ways.iter().map(|it| format!("\n    {}", way(it))).collect::<String>())
        }
        What::Discard { machine } => format!("discard {machine}"),
        What::Set { var, value, by } => format!("set {var} = {value} by {by}"),
        What::Input { bridge, name, value } => format!("input {bridge}.{name} {value}"),
        What::Output { bridge, name, value } => format!("output {bridge}.{name} {value}"),
        What::Call { bridge, name, id, arguments } => format!("call {bridge}.{name} #{id} {arguments}"),
        What::Offer { bridge, .. } => format!("offer {bridge}"),
        What::Found { bridge, found } => format!("found {bridge} {}", found.len()),
        What::Cancel { bridge, id } => format!("cancel {bridge} #{id}"),
        What::Reply { bridge, name, id, done: false, value, .. } => format!("feedback {bridge}.{name} #{id} {value}"),
        What::Reply { bridge, name, id, error: Some(error), .. } => format!("failed {bridge}.{name} #{id} {error}"),
        What::Reply { bridge, name, id, value, .. } => format!("reply {bridge}.{name} #{id} {value}"),
        What::Log(log) => logged(log),
        What::Error(fault) => failed(fault),
        What::Mended(it) => format!("mended {}:{}:{}: {}", it.file, it.line, it.column, it.code),
        What::Pause { reason, at: None } => format!("pause: {reason}"),
        What::Pause { reason, at: Some(at) } => format!("pause at {at}: {reason}"),
        What::Resume => "resume".into(),
        What::Force { state, how: Forced::Transition } => format!("force {state} by transition"),
        What::Force { state, how: Forced::Jump } => format!("force {state} by jump"),
        What::Restart { reason } => format!("restart: {reason}"),
        What::Stop { reason } => format!("stop: {reason}"),
        What::Skip { steps } => format!("skip {steps}"),
        What::Status { rate, late } => format!("status {rate} {late}"),
        What::Bridge(state) => format!("bridge {} {} {:?}", state.bridge, state.kind, state.state).to_lowercase(),
    };
    format!("{} {} {what}\n", record.step, record.t.ms())
}

fn loaded(load: &Load) -> String {
    let reason = load.reason.as_ref().map(|reason| format!("; restarts: {reason}")).unwrap_or_default();
    assert_eq!(load.restarted, load.reason.is_some());
    blamed(&load.changes, load.reason.as_ref(), (&load.again, &load.discarded), &load.because);
    let changes: String = load.changes.iter().map(changed).collect();
    let findings = told(&load.findings);
    let machines = machines(&load.again, &load.discarded);
    format!("load{reason}{changes}{machines}{findings}")
}

fn waiting(held: &Held) -> String {
    let reason = held.restarts.as_ref().map(|reason| format!("; would restart: {reason}")).unwrap_or_default();
    blamed(&held.changes, held.restarts.as_ref(), (&held.again, &held.discarded), &held.because);
    let changes: String = held.changes.iter().map(changed).collect();
    let findings = told(&held.findings);
    format!("held{reason}{changes}{}{findings}", machines(&held.again, &held.discarded))
}

/// For all that is disturbed one of the changes is to blame.
fn blamed(changes: &[Change], reason: Option<&String>, (again, discarded): (&[Path], &[Path]), because: &[Because]) {
    for because in because {
        assert!(changes.iter().any(|change| because.is_of(change)), "{because:?} is none of {changes:?}");
    }
    match reason {
        Some(reason) => assert_eq!(Some(reason), because.first().map(Because::to_string).as_ref()),
        None => {
            let ends: Vec<&Path> = again.iter().chain(discarded).collect();
            assert_eq!(ends, because.iter().map(|because| &because.machine).collect::<Vec<_>>());
        }
    }
}

/// What the checks find has a corpus of its own; here it matters what is an error, whether anything runs, and which files
/// are part of it.
fn told(findings: &[Finding]) -> String {
    let codes = ["no-spawn", "import-cycle", "nothing-exported", "unknown-module"];
    let told = findings.iter().filter(|it| it.severity == "error" || codes.contains(&&*it.code));
    told.map(|it| format!("\n    {}", finding(it))).collect()
}

fn machines(again: &[std::sync::Arc<str>], discarded: &[std::sync::Arc<str>]) -> String {
    let again = again.iter().map(|machine| format!("\n    again {machine}"));
    again.chain(discarded.iter().map(|machine| format!("\n    discarded {machine}"))).collect()
}

fn changed(change: &Change) -> String {
    let sign = match change.op {
        Op::Added => '+',
        Op::Removed => '-',
        Op::Changed => '~',
        Op::Renamed => '=',
    };
    let kind = format!("{:?}", change.kind).to_lowercase();
    let to = change.to.as_ref().map(|to| format!(" to {to}")).unwrap_or_default();
    format!("\n    {sign}{kind} {}{to}", change.path)
}

/// `error unknown-state 3:7 message (help)`
fn finding(finding: &Finding) -> String {
    let help = finding.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
    let Finding { severity, code, message, file, line, column, .. } = finding;
    format!("{severity} {code} {}{line}:{column} {message}{help}", other(file, ":"))
}

/// The name of a file that isn't the program itself.
fn other(file: &str, end: &str) -> String {
    if file.is_empty() || file == "case.lrp" { String::new() } else { format!("{file}{end}") }
}

fn commanded(command: &Command) -> String {
    match command {
        Command::Load(_) => "load".into(),
        Command::Reject { .. } => "reject".into(),
        Command::Pause => "pause".into(),
        Command::Resume => "resume".into(),
        Command::Step => "step".into(),
        Command::Rate { hz } => format!("rate {hz}"),
        Command::TransitionTo { state } => format!("transition-to {state}"),
        Command::JumpTo { state } => format!("jump-to {state}"),
        Command::Set { var, value } => format!("set {var} {value}"),
        Command::Reset { var } => format!("reset {var}"),
        Command::Restart => "restart".into(),
        Command::Runstop => "runstop".into(),
        Command::FileChanged { file } => format!("file-changed {file}"),
        Command::Tell { bridge, what } => format!("tell {bridge}.{what}"),
        Command::PutAtStart { bridge } => format!("put-at-start {bridge}"),
        Command::OnEdit { mode } => format!("on-edit {mode:?}").to_lowercase(),
        Command::Saves { mode } => format!("saves {mode:?}").to_lowercase(),
        Command::ApplyHeld => "apply-held".into(),
        Command::DropHeld => "drop-held".into(),
        Command::Break { at, mode } => format!("{} break at {at}", format!("{mode:?}").to_lowercase()),
        Command::OnError { mode } => format!("on-error {mode:?}").to_lowercase(),
        Command::Explain { mode } => format!("explain {mode:?}").to_lowercase(),
    }
}

fn transition(taken: &Taken) -> String {
    let name = taken.name.as_ref().map(|name| format!(" ({name})")).unwrap_or_default();
    let via = taken.via.as_ref().map(|via| format!(" via {via}")).unwrap_or_default();
    format!("transition {}: {} -> {} by {}{name}{via}", taken.machine, taken.from, taken.to, taken.trigger)
}

/// `m: on go a -> b = false`
pub fn way(way: &Way) -> String {
    let after = way.after.map(|ms| format!(" after {ms}")).unwrap_or_default();
    let message = way.message.as_ref().map(|message| format!(" ({message})")).unwrap_or_default();
    let answer = serde_json::to_value(way.guard).expect("an answer is data");
    format!("{} = {}{after}{message}", way.transition, answer.as_str().expect("a word"))
}

fn logged(log: &Log) -> String {
    let level = format!("{:?}", log.level).to_lowercase();
    let place = match log.line {
        0 => String::new(),
        line => format!(" @{} {}line {line}", log.state, other(&log.file, " ")),
    };
    format!("log {level} {:?}{place}", log.message)
}

fn failed(fault: &Fault) -> String {
    let help = fault.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
    let Fault { code, message, file, line, column, state, count, .. } = fault;
    format!("error {code} {}{line}:{column} @{state} x{count}: {message}{help}", other(file, ":"))
}
