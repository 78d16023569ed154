//! A program on the test bench: an engine with its robots, stepped in virtual time, and everything it told. Knows nothing of the
//! language that tests are written in.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use lrp_bridge::Scope;
use serde_json::Value;

use super::deadline::Deadline;
use super::failure::{Complaint, Situation};
use super::message::{self, Direction, hint};
use super::options::Options;
use super::readable;
use super::why::{self, WayOut};
use super::written::Written;
use crate::model::{Description, Edit, Program, Robot};
use crate::runtime::record::{Breakpoint, Fault, Finding, Held};
use crate::runtime::{self, Command, Input, Record, Reply, Time, What};
use crate::session::compile::{Compiler, Rejected};
use crate::session::driver::Driver;
use crate::session::files::{Disk, Files};
use crate::session::findings;
use crate::session::pace::Pace;
use crate::session::plugins::Plugins;
use crate::session::robots::{Robots, Workshop};
use crate::syntax::render::{Style, render};
use crate::syntax::{Code, Diagnostic, Source};

pub struct Bench {
    driver: Driver,
    compiler: Compiler,
    files: Written,
    /// Takes the place of the one in the program's bridge forms.
    world: Option<PathBuf>,
    file: Source,
    pace: Pace,
    /// When the next step is due.
    due: Time,
    /// Up to where the test has advanced; lies between steps where it asked for no whole number of periods.
    clock: Time,
    records: Vec<Record>,
    deadline: Deadline,
}

/// Gives a required Lua module's text, or why there is none.
pub type Library = Box<dyn Fn(&str) -> Result<String, String>>;

/// Where a program's text comes from, and what it finds beside itself.
pub struct Setting {
    pub file: Source,
    /// What it may import and require.
    pub files: Written,
    /// The program's own folder.
    pub folder: PathBuf,
    /// The test's, from which it names worlds.
    pub test_folder: PathBuf,
    pub library: Library,
}

/// Something wrong in the program, with how often it went wrong.
#[derive(Clone, Debug)]
pub struct Trouble {
    pub finding: Finding,
    /// The state or machine it belongs to.
    pub state: Arc<str>,
    pub count: u64,
}

impl Bench {
    /// A program at time 0, with everything spawned.
    pub fn start(setting: Setting, options: &Options, deadline: Deadline) -> Result<Bench, Complaint> {
        let Setting { file, files, folder, test_folder, library } = setting;
        // The program names worlds as seen from its own folder.
        let world = options.world.as_ref().map(|world| match folder == test_folder {
            true => PathBuf::from(world),
            false => std::path::absolute(test_folder.join(world)).unwrap_or_else(|_| world.into()),
        });
        let plugins = Plugins::here(&[]);
        let compiler_for = |robots| Compiler::new(robots).with_files(files.clone()).with_plugins(plugins.clone());
        let mut compiler = compiler_for(Vec::new());
        let mut program = compiler.compile(file.clone()).map_err(|rejected| broken(&rejected))?;
        if let Some(chosen) = &options.bridge
            && let robots @ [_, ..] = &*replaced(&program, chosen)
        {
            compiler = compiler_for(robots.to_vec());
            program = compiler.compile(file.clone()).map_err(|rejected| broken(&rejected))?;
        }
        let robots = if options.bridge.is_some() { Robots::Simulated } else { Robots::Fake };
        let workshop = Workshop { folder, seed: options.seed, robots, plugins };
        let &Options { seed, on_edit, on_error, .. } = options;
        let mut driver =
            Driver::new(runtime::Options { seed, on_edit, on_error, ..runtime::Options::default() }, workshop);
        driver.engine_mut().library(library);
        let mut pace = Pace::new(options.rate, std::time::Duration::ZERO);
        let due = pace.make();
        let (clock, records) = (Time::ZERO, Vec::new());
        let mut bench = Bench { driver, compiler, files, world, file, pace, due, clock, records, deadline };
        bench.load(program)?;
        bench.missing_robots()?;
        Ok(bench)
    }

    fn load(&mut self, mut program: Program) -> Result<(), Complaint> {
        if let Some(world) = &self.world {
            for config in program.bridges.iter_mut().filter_map(|bridge| bridge.config.as_object_mut()) {
                config.insert("world".to_string(), world.display().to_string().into());
            }
        }
        let edit = Edit::of(self.driver.engine().program(), program);
        self.command(Command::Load(edit))
    }

    /// A test that asks for a robot can't do without it.
    fn missing_robots(&self) -> Result<(), Complaint> {
        let program = self.driver.engine().program();
        let is_robots = |finding: &&Diagnostic| matches!(finding.code, Code::BadBridge | Code::UnknownBridge);
        let found: Vec<Diagnostic> = program.findings.iter().filter(is_robots).cloned().collect();
        match found.is_empty() {
            true => Ok(()),
            false => Err(Complaint::new(format!(
                "the robot can't be made:\n{}",
                render(&found, &program.sources, Style::Plain)
            ))),
        }
    }

    /// The program's text as last edited, whether it could be taken over or not.
    pub fn text(&self) -> &str {
        &self.file.text
    }

    pub fn edit(&mut self, text: String) -> Result<(), Complaint> {
        self.file = Source::new(self.file.name.clone(), text);
        match self.compiler.compile_after(self.file.clone(), self.driver.engine().program()) {
            Ok(program) => self.load(program),
            Err(Rejected { sources, diagnostics }) => {
                let findings = findings::errors_first(&diagnostics, &sources);
                self.command(Command::Reject { findings, files: Vec::new() })
            }
        }
    }

    /// Another text in the place of a file other than the program's own.
    pub fn file_changed(&mut self, path: &Path) -> Result<(), Complaint> {
        let changed = Disk.canonical(path);
        let is_part = self.compiler.reached().iter().any(|file| self.files.canonical(&file.path) == changed);
        match path.extension() {
            _ if is_part => self.edit(self.file.text.to_string()),
            Some(lua) if lua == "lua" => self.command(Command::FileChanged { file: path.display().to_string() }),
            _ => Ok(()),
        }
    }

    pub fn command(&mut self, command: Command) -> Result<(), Complaint> {
        let Bench { driver, records, .. } = self;
        driver.command(command, &mut |record| records.push(record)).map_err(|refused| Complaint::new(refused.0))
    }

    /// Every step up to this much program time later; none while paused, when program time stands still.
    pub fn advance(&mut self, time: Time) -> Result<(), Complaint> {
        let until = self.clock + time;
        while self.due <= until && !self.is_paused() {
            self.one_step()?;
        }
        if !self.is_paused() {
            self.clock = until;
        }
        Ok(())
    }

    pub fn is_paused(&self) -> bool {
        self.driver.engine().is_paused()
    }

    pub fn breakpoints(&self) -> &[Breakpoint] {
        self.driver.engine().breakpoints()
    }

    /// So many steps, also while paused.
    pub fn steps(&mut self, count: u64) -> Result<(), Complaint> {
        for _ in 0..count {
            if self.is_paused() {
                self.command(Command::Step)?;
            }
            self.one_step()?;
        }
        Ok(())
    }

    fn one_step(&mut self) -> Result<(), Complaint> {
        self.deadline.check()?;
        let Bench { driver, records, .. } = self;
        driver.step(self.due, &mut |record| records.push(record));
        self.clock = self.due;
        self.due = self.pace.make();
        Ok(())
    }

    /// A message that the robot seems to send, for the next step. `name`: `robot.light`.
    pub fn input(&mut self, name: &str, value: Value) -> Result<(), Complaint> {
        let (bridge, offer, input) = self.robot(name)?;
        let port = message::port(&offer, Direction::Input, &bridge, input).map_err(Complaint::new)?;
        let value = match port {
            Some(port) => {
                message::filled(&port.message, value).map_err(|why| Complaint::new(format!("`{name}`: {why}")))?
            }
            None => value,
        };
        self.driver.inject(Input { bridge, name: input.into(), value });
        Ok(())
    }

    /// What a robot seems to say of a call, for the next step.
    pub(super) fn answer(&mut self, reply: Reply) {
        self.driver.reply(reply);
    }

    pub(super) fn robot<'n>(&self, name: &'n str) -> Result<(Arc<str>, Description, &'n str), Complaint> {
        let split = name.split_once('.');
        let (robot, port) = split.ok_or_else(|| Complaint::new(format!("`{name}`: write it as `robot.{name}`")))?;
        let bridges = &self.driver.engine().program().bridges;
        let Some(form) = bridges.iter().find(|bridge| &*bridge.name == robot) else {
            let known = bridges.iter().map(|bridge| &*bridge.name);
            return Err(Complaint::new(format!("the program has no robot `{robot}`; {}", hint(robot, known))));
        };
        let open = || Description { scope: Scope::Open, ..Description::default() };
        let description = self.driver.offer(robot).unwrap_or_else(open);
        Ok((form.name.clone(), description, port))
    }

    /// What was sent to an output in the last step, in order. `name`: `robot.move`.
    pub fn outputs(&self, name: &str) -> Result<Vec<&Value>, Complaint> {
        let (robot, offer, output) = self.robot(name)?;
        message::port(&offer, Direction::Output, &robot, output).map_err(Complaint::new)?;
        let sent = self.last_step().filter_map(|record| match &record.what {
            What::Output { bridge, name, value } if *bridge == robot && &**name == output => Some(value),
            _ => None,
        });
        let mut sent: Vec<&Value> = sent.collect();
        sent.reverse();
        Ok(sent)
    }

    /// The records of the last step, the last one first.
    pub(super) fn last_step(&self) -> impl Iterator<Item = &Record> {
        let step = self.driver.engine().steps();
        self.records.iter().rev().take_while(move |record| record.step == step)
    }

    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// What taking the held edit over would do; none where nothing is held.
    pub fn held(&self) -> Option<&Held> {
        self.driver.engine().held()
    }

    pub fn active(&self) -> Vec<String> {
        self.driver.engine().active()
    }

    /// Fails where the program has no such state.
    pub fn is_active(&self, path: &str) -> Result<bool, Complaint> {
        let engine = self.driver.engine();
        match engine.program().state(path) {
            Some(_) => Ok(engine.active().iter().any(|active| active == path)),
            None => Err(self.no_state(path)),
        }
    }

    pub fn expect_active(&self, path: &str) -> Result<(), Complaint> {
        match self.is_active(path)? {
            true => Ok(()),
            false => {
                let complaint = Complaint::new(format!("expected `{path}` to be active"));
                let ways = self.ways_to(path);
                Err(if ways.is_empty() { complaint } else { complaint.seen(ways.join("\n")) })
            }
        }
    }

    /// What the transitions to a state from the one that is active beside it wait for.
    fn ways_to(&self, path: &str) -> Vec<String> {
        let Some((machine, state)) = path.rsplit_once('/') else { return Vec::new() };
        let ways = self.why(machine).unwrap_or_default().into_iter();
        ways.filter(|way| way.leads_to(state)).map(|way| way.to_string()).collect()
    }

    fn no_state(&self, path: &str) -> Complaint {
        let program = self.driver.engine().program();
        if program.machine(path).is_some() {
            return Complaint::new(format!("`{path}` is a machine; name one of its states: `{path}/STATE`"));
        }
        let known = program.states.iter().map(|state| &*state.path);
        Complaint::new(format!("the program has no state `{path}`; {}", hint(path, known)))
    }

    /// A variable's value; none while its machine doesn't run.
    pub fn get(&self, path: &str) -> Result<Option<Value>, Complaint> {
        let engine = self.driver.engine();
        if engine.program().var(path).is_none() {
            let known = engine.program().vars.iter().map(|var| &*var.path);
            return Err(Complaint::new(format!("the program has no variable `{path}`; {}", hint(path, known))));
        }
        Ok(engine.value(path))
    }

    /// What is wrong in the program that runs, each fault once, and in edits that were refused since it was taken over.
    pub fn troubles(&self) -> Vec<Trouble> {
        let loaded = self.records.iter().rposition(|record| matches!(record.what, What::Load(_))).unwrap_or(0);
        let mut troubles: Vec<Trouble> = self.driver.engine().faults().map(trouble).collect();
        for record in &self.records[loaded..] {
            let What::Reject { findings, .. } = &record.what else { continue };
            let errors = findings.iter().filter(|finding| finding.severity == "error");
            let all = errors.map(|finding| Trouble { finding: finding.clone(), state: Arc::default(), count: 1 });
            all.for_each(|trouble| put(&mut troubles, trouble));
        }
        troubles
    }

    /// The ways out of a state, or of the one that is active in a machine, with what their guards came to last.
    pub fn why(&self, path: &str) -> Result<Vec<WayOut>, Complaint> {
        let engine = self.driver.engine();
        let program = engine.program();
        let active = || engine.active().into_iter().find(|state| state.rsplit_once('/').is_some_and(|it| it.0 == path));
        let state = match program.machine(path) {
            Some(_) => active().ok_or_else(|| Complaint::new(format!("`{path}` is not running")))?,
            None => path.to_string(),
        };
        let state = program.state(&state).ok_or_else(|| self.no_state(path))?;
        Ok(why::ways(engine, &self.records, state))
    }

    pub fn situation(&self) -> Situation {
        readable::situation(self.driver.engine(), &self.records, &self.troubles())
    }
}

fn put(troubles: &mut Vec<Trouble>, new: Trouble) {
    let place = |trouble: &Trouble| {
        (trouble.finding.code.clone(), trouble.finding.file.clone(), trouble.finding.line, trouble.finding.column)
    };
    match troubles.iter_mut().find(|known| place(known) == place(&new)) {
        Some(known) => *known = new,
        None => troubles.push(new),
    }
}

fn trouble(fault: Fault) -> Trouble {
    let Fault { code, message, help, file, line, column, state, count } = fault;
    Trouble {
        finding: Finding { severity: "error".to_string(), code, message, help, file, line, column },
        state,
        count,
    }
}

/// The robots to be made in place of the program's: those of another kind, or one called `robot` where it has none.
fn replaced(program: &Program, chosen: &str) -> Vec<Robot> {
    if let Some((name, kind)) = chosen.split_once('=') {
        return vec![Robot { name: name.to_string(), kind: kind.to_string() }];
    }
    let robot = |name: &str| Robot { name: name.to_string(), kind: chosen.to_string() };
    match &*program.bridges {
        [] => vec![robot("robot")],
        bridges => bridges.iter().filter(|bridge| &*bridge.kind != chosen).map(|bridge| robot(&bridge.name)).collect(),
    }
}

fn broken(Rejected { sources, diagnostics }: &Rejected) -> Complaint {
    Complaint::new(format!("the program can't be read:\n{}", render(diagnostics, sources, Style::Plain)))
}
