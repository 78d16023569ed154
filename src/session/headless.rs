//! `lrp run`: a program without a screen. Records go to a trace, what went wrong to standard error.

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::mpsc::{Sender, channel};

use super::engine_thread::{End, News};
use super::live::{Session, Setup};
use super::signals::{Signal, Signals};
use super::trace::Trace;
use crate::runtime::record::{Level, Load};
use crate::runtime::{Record, What};

enum Event {
    News(News),
    Signal(Signal),
}

/// Exit code 0: fine; 1: errors; 130: interrupted.
pub fn run(setup: Setup, trace: Option<PathBuf>) -> ExitCode {
    let mut trace = match trace.as_deref().map(|path| Trace::create(path, setup.conditions())).transpose() {
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
    let mut outcome = Outcome::default();
    while let Ok(event) = inbox.recv() {
        match event {
            Event::News(News::Records(records)) => {
                for record in &records {
                    outcome.see(record);
                    if let Some(trace) = &mut trace {
                        trace.record(record);
                    }
                }
                if let Some(trace) = &mut trace {
                    trace.flush();
                }
                let nobody_reads = trace.as_ref().is_some_and(Trace::is_broken);
                if outcome.refused || nobody_reads {
                    break;
                }
            }
            Event::News(News::Ended(End::Failed(why))) => return fail(&format!("lrp failed and stopped the robot: {why}")),
            Event::News(News::Stuck) => say(STUCK),
            Event::News(News::Ended(_)) => break,
            Event::Signal(Signal::Interrupt) => {
                drop(session);
                return ExitCode::from(130);
            }
            Event::Signal(Signal::Terminate | Signal::HangUp) => {
                drop(session);
                return ExitCode::SUCCESS;
            }
            Event::Signal(Signal::Suspend) => session.commands().halt(),
            Event::Signal(Signal::Continue) => {}
        }
    }
    ExitCode::from(u8::from(outcome.errors))
}

/// Said when a block can't be stopped.
pub const STUCK: &str = "a block can't be stopped; the robot was halted, and the program waits for that block";

fn fail(why: &str) -> ExitCode {
    eprintln!("lrp: {why}");
    ExitCode::FAILURE
}

#[derive(Default)]
struct Outcome {
    loaded: bool,
    errors: bool,
    /// The first text isn't a program.
    refused: bool,
}

impl Outcome {
    fn see(&mut self, record: &Record) {
        match &record.what {
            What::Load(load) => self.loaded(load),
            What::Reject { findings } => {
                for finding in findings {
                    say(&format!("{}:{}:{}: {}: {}", finding.file, finding.line, finding.column, finding.severity, finding.message));
                }
                self.errors |= !self.loaded;
                self.refused = !self.loaded;
            }
            What::Error(fault) if fault.count == 1 => {
                self.errors = true;
                say(&format!("{}:{}:{}: error: {}", fault.file, fault.line, fault.column, fault.message));
            }
            What::Log(log) if log.level >= Level::Info => say(&format!("{}: {}", level(log.level), log.message)),
            _ => {}
        }
    }

    fn loaded(&mut self, load: &Load) {
        if let (true, Some(reason)) = (self.loaded, &load.reason) {
            say(&format!("restarted: {reason}"));
        }
        self.loaded = true;
    }
}

fn level(level: Level) -> &'static str {
    match level {
        Level::Debug => "debug",
        Level::Info => "info",
        Level::Warn => "warn",
        Level::Error => "error",
    }
}

/// To standard error, which may be gone.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}
