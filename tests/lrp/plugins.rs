//! Bridges in processes of their own: that they are found, that programs talk with them, and that whatever they do costs
//! the program nothing. The bridges are the examples of the author crate.

mod documented;
mod found;
mod held_up;
mod kept;
mod talk;
mod told;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use lrp::model::Edit;
use lrp::runtime::record::Health;
use lrp::runtime::{Command, Options, Record, Time, What};
use lrp::session::compile::{Compiler, Rejected};
use lrp::session::driver::Driver;
use lrp::session::plugins::{Folders, Plugins};
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;

/// How long something may take that takes milliseconds on a machine with nothing else to do.
const PATIENCE: Duration = Duration::from_secs(30);

pub fn lrp_binary() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_lrp"))
}

/// Where `cargo test --workspace` puts the author crate's examples.
pub fn examples() -> PathBuf {
    let folder = lrp_binary().with_file_name("examples");
    let echo = folder.join("liblrp_bridge_echo.so");
    assert!(echo.exists(), "{} is missing: run the tests by `cargo test --workspace`", echo.display());
    folder
}

pub fn plugins(folders: Vec<PathBuf>) -> Plugins {
    Plugins::new(Folders::new(folders), lrp_binary())
}

/// A program with its robots in real time, whose steps are made when the test says so.
pub struct Run {
    driver: Driver,
    compiler: Compiler,
    now: Time,
    pub records: Vec<Record>,
}

impl Run {
    /// Its robots begin to connect; the program isn't loaded yet.
    pub fn prepare(text: &str, folder: PathBuf, plugins: Plugins) -> Run {
        let workshop = Workshop { folder, seed: 1, robots: Robots::AsProgrammed, plugins: plugins.clone() };
        let mut run = Run {
            driver: Driver::new(Options::default(), workshop),
            compiler: Compiler::new(Vec::new()).with_plugins(plugins),
            now: Time::ZERO,
            records: Vec::new(),
        };
        let edit = run.compile(text);
        run.driver.prepare(&edit, &mut |record| run.records.push(record));
        run
    }

    /// A program that began once its robots were there.
    pub fn start(text: &str, folder: PathBuf, plugins: Plugins) -> Run {
        let mut run = Run::prepare(text, folder, plugins);
        run.until("its robots to be there", |run| run.driver.is_ready());
        run.save(text);
        run
    }

    fn compile(&mut self, text: &str) -> Edit {
        let running = self.driver.engine().program();
        match self.compiler.compile_after(Source::new("r.lrp", text), running) {
            Ok(program) => Edit::of(running, program),
            Err(Rejected { diagnostics, .. }) => panic!("{diagnostics:?}"),
        }
    }

    pub fn save(&mut self, text: &str) {
        let edit = self.compile(text);
        self.command(Command::Load(edit));
    }

    pub fn command(&mut self, command: Command) {
        let records = &mut self.records;
        self.driver.command(command, &mut |record| records.push(record)).expect("a command that can be obeyed");
    }

    pub fn step(&mut self) {
        self.now = self.now + Time::from_ms(100.0);
        let records = &mut self.records;
        self.driver.step(self.now, &mut |record| records.push(record));
    }

    /// Hears its robots until something is so.
    pub fn until(&mut self, what: &str, holds: impl Fn(&Run) -> bool) {
        self.wait(what, holds, |run| {
            let records = &mut run.records;
            run.driver.attend(&mut |record| records.push(record));
        });
    }

    /// Steps until something is so.
    pub fn step_until(&mut self, what: &str, holds: impl Fn(&Run) -> bool) {
        self.wait(what, holds, Run::step);
    }

    fn wait(&mut self, what: &str, holds: impl Fn(&Run) -> bool, go_on: impl Fn(&mut Run)) {
        let end = Instant::now() + PATIENCE;
        while !holds(self) {
            assert!(Instant::now() < end, "waited for {what} in vain:\n{:#?}", self.records);
            go_on(self);
            std::thread::park_timeout(Duration::from_millis(2));
        }
    }

    pub fn value(&self, path: &str) -> Option<serde_json::Value> {
        self.driver.engine().value(path)
    }

    /// What was told of its robot's connection, in order.
    pub fn health(&self) -> Vec<(Health, Option<String>)> {
        let states = self.records.iter().filter_map(|record| match &record.what {
            What::Bridge(state) => Some((state.state, state.message.clone())),
            _ => None,
        });
        states.collect()
    }

    pub fn is_up_after(&self, losses: usize) -> bool {
        let health = self.health();
        health.last().is_some_and(|last| last.0 == Health::Up) && self.losses().len() >= losses
    }

    /// Why it was lost, each time.
    pub fn losses(&self) -> Vec<String> {
        let lost = self.health().into_iter().filter(|state| state.0 == Health::Lost);
        lost.map(|(_, message)| message.unwrap_or_default()).collect()
    }

    pub fn logs(&self) -> Vec<String> {
        let logs = self.records.iter().filter_map(|record| match &record.what {
            What::Log(log) => Some(log.message.clone()),
            _ => None,
        });
        logs.collect()
    }
}
