//! `lrp run`: a program without a screen. Records go to a trace, what went wrong to standard error.

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use super::engine_thread::{End, News};
use super::live::{Session, Setup};
use super::signals::{self, Signal, Signals};
use super::trace::Trace;
use crate::runtime::record::{BridgeState, Finding, Health, Level, Load};
use crate::runtime::{Record, What};

enum Event {
    News(News),
    Signal(Signal),
}

/// Exit code 0: fine; 1: errors; 130: interrupted.
pub fn run(setup: Setup, trace: Option<PathBuf>) -> ExitCode {
    let trace = match trace.as_deref().map(|path| Trace::create(path, setup.conditions())).transpose() {
        Ok(trace) => trace,
        Err(error) => return fail(&format!("the trace can't be written: {error}")),
    };
    let (events, inbox) = channel::<Event>();
    let signals: Sender<Event> = events.clone();
    let _signals = Signals::watch(move |signal| drop(signals.send(Event::Signal(signal))));
    let session = match Session::start(setup, move |news| drop(events.send(Event::News(news)))) {
        Ok(session) => session,
        Err(why) => return fail(&why.to_string()),
    };
    let mut run = Run { trace, outcome: Outcome::default() };
    let end = run.follow(&inbox, &session);
    drop(session);
    // The robot's stop, and what came before it.
    for event in inbox.try_iter() {
        if let Event::News(News::Records(records)) = event {
            run.take(&records);
        }
    }
    match end {
        Some(code) => code,
        None => ExitCode::from(u8::from(run.outcome.errors)),
    }
}

struct Run {
    trace: Option<Trace>,
    outcome: Outcome,
}

impl Run {
    /// Until the run is over; an exit code where that doesn't depend on what went wrong in the program.
    fn follow(&mut self, events: &Receiver<Event>, session: &Session) -> Option<ExitCode> {
        for event in events {
            match event {
                Event::News(News::Records(records)) => {
                    self.take(&records);
                    if self.outcome.refused || self.outcome.paused || self.nobody_reads() {
                        return None;
                    }
                }
                Event::News(News::Stuck) => say(STUCK),
                Event::News(News::Ended(End::Failed(why))) => {
                    return Some(fail(&format!("lrp failed and stopped the robot: {why}")));
                }
                Event::News(News::Ended(_)) => return None,
                Event::Signal(Signal::Interrupt) => return Some(ExitCode::from(130)),
                Event::Signal(Signal::Terminate | Signal::HangUp) => return Some(ExitCode::SUCCESS),
                Event::Signal(Signal::Suspend) => {
                    if let Err(error) = session.commands().at_rest(signals::suspend) {
                        say(&format!("can't be suspended: {error}"));
                    }
                }
                Event::Signal(Signal::Continue) => {}
            }
        }
        None
    }

    fn take(&mut self, records: &[Record]) {
        for record in records {
            self.outcome.see(record);
            if let Some(trace) = &mut self.trace {
                trace.record(record);
            }
        }
        if let Some(trace) = &mut self.trace {
            trace.flush();
            if let Some(why) = trace.trouble() {
                say(&format!("lrp: {why}"));
            }
        }
    }

    /// Standard output was closed, as by `| head`.
    fn nobody_reads(&self) -> bool {
        self.trace.as_ref().is_some_and(Trace::is_unread)
    }
}

/// Said when a block can't be stopped.
pub const STUCK: &str = "a block can't be stopped; the robot was halted, and the program waits for that block";

fn fail(why: &str) -> ExitCode {
    say(&format!("lrp: {why}"));
    ExitCode::FAILURE
}

#[derive(Default)]
struct Outcome {
    loaded: bool,
    errors: bool,
    /// The first text isn't a program.
    refused: bool,
    /// At a breakpoint or because of an error: there is nobody to let it go on.
    paused: bool,
    /// That have begun to connect. What keeps a robot from being made is told as an error.
    robots: BTreeSet<Arc<str>>,
}

impl Outcome {
    fn see(&mut self, record: &Record) {
        match &record.what {
            What::Load(load) => self.loaded(load),
            What::Reject { findings, .. } => {
                findings.iter().for_each(tell);
                self.errors |= !self.loaded;
                self.refused = !self.loaded;
            }
            What::Error(fault) if fault.count == 1 => {
                self.errors = true;
                let place = format!("{}:{}:{}", fault.file, fault.line, fault.column);
                say(&with_help(format!("{place}: error: {}", fault.message), fault.help.as_deref()));
            }
            What::Pause { reason, .. } if !self.paused => {
                (self.paused, self.errors) = (true, true);
                say(&format!("paused: {reason}; nobody can let it go on without a screen, so the run ends here"));
            }
            What::Bridge(state) => self.robot(state),
            What::Log(log) if log.level >= Level::Info => say(&format!("{}: {}", level(log.level), log.message)),
            _ => {}
        }
    }

    fn robot(&mut self, state: &BridgeState) {
        if state.state == Health::Connecting {
            self.robots.insert(Arc::clone(&state.bridge));
        }
        if self.robots.contains(&state.bridge) {
            say(&robot_words(state));
        }
    }

    fn loaded(&mut self, load: &Load) {
        if let (true, Some(reason)) = (self.loaded, &load.reason) {
            say(&format!("restarted: {reason}"));
        }
        load.again.iter().for_each(|machine| say(&format!("started again: {machine}")));
        load.discarded.iter().for_each(|machine| say(&format!("runs no longer: {machine}")));
        load.findings.iter().filter(|finding| finding.severity == "warning").for_each(tell);
        self.loaded = true;
    }
}

/// `robot (ev3): lost: the brick doesn't answer`
fn robot_words(state: &BridgeState) -> String {
    let health = match state.state {
        Health::Connecting => "connecting",
        Health::Up => "up",
        Health::Lost => "lost",
    };
    let message = state.message.as_ref().map_or(String::new(), |message| format!(": {message}"));
    format!("{} ({}): {health}{message}", state.bridge, state.kind)
}

fn level(level: Level) -> &'static str {
    match level {
        Level::Debug => "debug",
        Level::Info => "info",
        Level::Warn => "warn",
        Level::Error => "error",
    }
}

/// A finding that concerns a whole file has no line.
fn tell(finding: &Finding) {
    let Finding { severity, message, help, file, line, column, .. } = finding;
    let line = match line {
        0 => format!("{file}: {severity}: {message}"),
        line => format!("{file}:{line}:{column}: {severity}: {message}"),
    };
    say(&with_help(line, help.as_deref()));
}

fn with_help(line: String, help: Option<&str>) -> String {
    match help {
        Some(help) => format!("{line}; {help}"),
        None => line,
    }
}

/// To standard error, which may be gone. A terminal there obeys nothing that a robot or a program wrote.
fn say(line: &str) {
    let mut text = String::with_capacity(line.len() + 1);
    for c in line.chars() {
        match c {
            '\n' | '\t' => text.push(c),
            c if c.is_control() => text.extend(c.escape_default()),
            c => text.push(c),
        }
    }
    text.push('\n');
    let _ = io::stderr().write_all(text.as_bytes());
}
