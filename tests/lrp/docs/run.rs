//! An example as it runs: five seconds of virtual time at 10 Hz, with a stand-in for its robot. Knows nothing of documents.

use std::path::PathBuf;

use lrp::model::Program;
use lrp::runtime::{Command, Input, Options, Record, Time, What};
use lrp::session::compile::{Compiler, Rejected};
use lrp::session::driver::Driver;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::{Diagnostic, Source};

use super::page::Example;
use crate::shelf::Shelf;

const PERIOD_MS: u64 = 100;
const STEPS: u64 = 50;

#[derive(Default)]
pub struct Run {
    /// What was wrong before it ran.
    pub errors: Vec<String>,
    /// What else the checks said.
    pub remarks: Vec<String>,
    pub faults: Vec<String>,
    /// `500 enter esc/tock`
    pub lines: Vec<String>,
}

/// What is done to the program, each with its time in ms: messages from its robot before the step, commands after it,
/// then saves.
#[derive(Default)]
struct Feeds {
    inputs: Vec<(u64, Input)>,
    commands: Vec<(u64, Command)>,
    /// Pieces of the text, each with what takes its place.
    saves: Vec<(u64, (String, String))>,
}

pub fn run(example: &Example) -> Result<Run, String> {
    let mut feeds = Feeds::default();
    for line in &example.fed {
        feeds.read(line).ok_or_else(|| format!("`{line}` can't be read"))?;
    }
    let mut text = example.text.clone();
    let program = match compile(&text, &example.files, &Program::default()) {
        Ok(program) => program,
        Err(Rejected { diagnostics, .. }) => return Ok(Run { errors: errors(&diagnostics), ..Run::default() }),
    };
    let mut run = Run { errors: errors(&program.findings), remarks: remarks(&program.findings), ..Run::default() };
    let workshop = Workshop { folder: PathBuf::new(), seed: 1, robots: Robots::Fake, plugins: Plugins::default() };
    let mut driver = Driver::new(Options::default(), workshop);
    let mut see = |record: Record| run.see(&record);
    let refused = |refused: lrp::runtime::Refused| refused.0;
    driver.command(Command::Load(program.into()), &mut see).map_err(refused)?;
    for step in 1..=STEPS {
        let now = step * PERIOD_MS;
        for (_, input) in feeds.inputs.extract_if(.., |(at, _)| *at <= now) {
            driver.inject(input);
        }
        if !driver.engine().is_paused() {
            driver.step(Time(now * 1000), &mut see);
        }
        for (_, command) in feeds.commands.extract_if(.., |(at, _)| *at <= now) {
            driver.command(command, &mut see).map_err(refused)?;
        }
        for (_, (old, new)) in feeds.saves.extract_if(.., |(at, _)| *at <= now) {
            text = replaced(&text, &old, &new)?;
            let program = compile(&text, &example.files, driver.engine().program())
                .map_err(|rejected| errors(&rejected.diagnostics).join("\n"))?;
            driver.command(Command::Load(program.into()), &mut see).map_err(refused)?;
        }
    }
    Ok(run)
}

fn compile(text: &str, files: &[(String, String)], running: &Program) -> Result<Program, Rejected> {
    let files = Shelf::of(files.to_vec());
    Compiler::new(Vec::new()).with_files(files).compile_after(Source::new("example.lrp", text), running)
}

fn replaced(text: &str, old: &str, new: &str) -> Result<String, String> {
    match text.matches(old).count() {
        1 => Ok(text.replace(old, new)),
        count => Err(format!("`{old}` stands {count} times in the text")),
    }
}

fn errors(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).map(|error| told("error", error)).collect()
}

fn remarks(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().filter(|diagnostic| !diagnostic.is_error()).map(|remark| told("remark", remark)).collect()
}

fn told(kind: &str, diagnostic: &Diagnostic) -> String {
    format!("{kind}[{}]: {}", diagnostic.code.name(), diagnostic.message)
}

impl Feeds {
    /// `300 input robot.light {"data":200}`, `400 command {"command":"pause"}`, `500 save OLD => NEW`
    fn read(&mut self, line: &str) -> Option<()> {
        let mut words = line.splitn(3, ' ');
        let at = words.next()?.parse().ok()?;
        match (words.next()?, words.next()?) {
            ("command", command) => self.commands.push((at, serde_json::from_str(command).ok()?)),
            ("save", edit) => {
                let (old, new) = edit.split_once(" => ")?;
                self.saves.push((at, (old.to_string(), new.to_string())));
            }
            (_, input) => {
                let (name, value) = input.split_once(' ')?;
                let (bridge, name) = name.split_once('.')?;
                let value = serde_json::from_str(value).ok()?;
                self.inputs.push((at, Input { bridge: bridge.into(), name: name.into(), value }));
            }
        }
        Some(())
    }
}

impl Run {
    fn see(&mut self, record: &Record) {
        let told = match &record.what {
            What::Spawn { machine, .. } => format!("spawn {machine}"),
            What::Enter { state } => format!("enter {state}"),
            What::Exit { state } => format!("exit {state}"),
            What::Discard { machine } => format!("discard {machine}"),
            What::Transition(taken) => format!("transition {} {} -> {}", taken.machine, taken.from, taken.to),
            What::Set { var, value, .. } => format!("set {var} = {value}"),
            What::Output { bridge, name, value } => format!("output {bridge}.{name} {value}"),
            What::Log(log) => format!("log {}", log.message),
            What::Held(held) => match &held.restarts {
                Some(reason) => format!("held restarts: {reason}"),
                None => "held".to_string(),
            },
            What::Pause { .. } => "pause".to_string(),
            What::Resume => "resume".to_string(),
            What::Error(fault) => {
                // Mistakes that were there before it ran are told again when it is loaded.
                let known = self.errors.iter().any(|error| error.contains(&*fault.message));
                if !known {
                    self.faults.push(format!("{} at {}: {}", fault.code, fault.line, fault.message));
                }
                format!("error {}", fault.code)
            }
            _ => return,
        };
        self.lines.push(format!("{} {told}", record.t.ms()));
    }
}
