//! Plays a program in virtual time with a fake robot: what a case's head says happens when, and what came of it as
//! readable lines. Looks at the engine's records only; whether the screen's picture agrees with the engine is asserted.

use std::path::PathBuf;
use std::time::Duration;

use lrp::lua::Limits;
use lrp::model::Edit;
use lrp::runtime::{BreakAt, Breaking, Command, Engine, Explain, Input, OnEdit, OnError, Options, Record, Saves, Time};
use lrp::session::compile::{Compiler, Rejected};
use lrp::session::driver::Driver;
use lrp::session::findings;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;
use lrp::ui::view::View;

use crate::lines::line;
use crate::picture;
use crate::shelf::{Shelf, split as files_of};

/// What happens at a moment of real time.
#[derive(Clone, Debug)]
pub enum Event {
    Command(Command),
    Input(Input),
    /// The file is saved with this text.
    Save(String),
    /// So is another one, or it is removed.
    Write {
        file: String,
        text: Option<String>,
    },
}

pub struct Stage {
    driver: Driver,
    compiler: Compiler,
    files: Shelf,
    /// The program's text as last saved.
    text: String,
    /// Milliseconds between steps.
    period: f64,
    /// Program time of the last step, ms.
    now: f64,
    pub records: Vec<Record>,
    pub view: View,
}

impl Stage {
    /// `files`: those beside the program, by name.
    pub fn new(seed: u64, limit: Duration, files: Vec<(String, String)>) -> Stage {
        let options = Options { limits: Limits { time: limit, ..Limits::default() }, seed, ..Options::default() };
        let workshop = Workshop { folder: PathBuf::from("."), seed, robots: Robots::Fake, plugins: Plugins::default() };
        let mut driver = Driver::new(options, workshop);
        let files = Shelf::of(files);
        let library = files.clone();
        driver.engine_mut().library(move |wanted| library.module(wanted));
        let compiler = Compiler::new(Vec::new()).with_files(files.clone());
        let (text, records) = (String::new(), Vec::new());
        Stage { driver, compiler, files, text, period: 100.0, now: 0.0, records, view: View::new(10.0) }
    }

    pub fn engine(&self) -> &Engine {
        self.driver.engine()
    }

    pub fn event(&mut self, event: Event) {
        match event {
            Event::Input(input) => self.driver.inject(input),
            Event::Save(text) => self.save(text),
            Event::Write { file, text } => {
                let is_there = text.is_some();
                self.files.put(&file, text);
                if is_there {
                    self.save(self.text.clone());
                }
            }
            Event::Command(Command::Rate { hz }) => {
                self.period = 1000.0 / hz;
                self.command(Command::Rate { hz });
            }
            Event::Command(Command::Step) => {
                self.command(Command::Step);
                self.step();
            }
            Event::Command(command) => self.command(command),
        }
    }

    fn save(&mut self, text: String) {
        self.text.clone_from(&text);
        let running = self.driver.engine().program();
        let command = match self.compiler.compile_after(Source::new("case.lrp", text), running) {
            Ok(program) => Command::Load(Edit::of(running, program)),
            Err(Rejected { sources, diagnostics }) => {
                let (findings, files) = findings::of_rejected(&diagnostics, &sources);
                Command::Reject { findings, files }
            }
        };
        self.command(command);
    }

    pub fn command(&mut self, command: Command) {
        let mut fresh = Vec::new();
        // A refusal is among the records.
        let _ = self.driver.command(command, &mut |record| fresh.push(record));
        self.take(fresh);
    }

    /// A period of real time goes by: a step, unless it is paused.
    pub fn tick(&mut self) {
        if !self.driver.engine().is_paused() {
            self.step();
        }
    }

    fn step(&mut self) {
        self.now += self.period;
        let mut fresh = Vec::new();
        self.driver.step(Time::from_ms(self.now), &mut |record| fresh.push(record));
        self.take(fresh);
    }

    fn take(&mut self, fresh: Vec<Record>) {
        for record in &fresh {
            self.view.apply(record);
        }
        self.records.extend(fresh);
        if let Err(difference) = picture::agrees(&self.view, self.driver.engine()) {
            panic!("the picture differs from the engine: {difference}\nafter\n{}", lines(&self.records));
        }
    }
}

pub fn lines(records: &[Record]) -> String {
    records.iter().map(line).collect()
}

/// The head of a case: its lines that begin with `;!`.
#[derive(Debug)]
pub struct Head {
    /// How long it is played, ms of real time.
    length: f64,
    rate: f64,
    seed: u64,
    on_edit: OnEdit,
    limit: Duration,
    /// Lua files, by module name.
    modules: Vec<(String, String)>,
    /// In the order written.
    events: Vec<(f64, Event)>,
}

impl Head {
    pub fn read(text: &str) -> Head {
        let mut head = Head {
            length: 1000.0,
            rate: 10.0,
            seed: 1,
            on_edit: OnEdit::Restart,
            limit: Duration::from_millis(250),
            modules: Vec::new(),
            events: Vec::new(),
        };
        for line in text.lines().filter_map(|line| line.strip_prefix(";!")) {
            let (what, rest) = split(line.trim());
            match what {
                "for" => head.length = number(rest),
                "rate" => head.rate = number(rest),
                "seed" => head.seed = number(rest) as u64,
                "on-edit" => head.on_edit = on_edit(rest),
                "limit" => head.limit = Duration::from_secs_f64(number(rest) / 1000.0),
                "module" => {
                    let (name, text) = split(rest);
                    head.modules.push((name.into(), text.into()));
                }
                "at" => {
                    let (t, event) = split(rest);
                    head.events.push((number(t), read_event(event)));
                }
                _ => panic!("`;! {what}` is not known"),
            }
        }
        head
    }

    /// Plays a text with what its head and `saves` say, in the order of their times.
    pub fn play(self, case: &str, saves: Vec<(f64, Event)>) -> Vec<Record> {
        let (text, mut files) = files_of(case);
        files.extend(self.modules.into_iter().map(|(name, text)| (format!("{name}.lua"), text)));
        let mut stage = Stage::new(self.seed, self.limit, files);
        stage.period = 1000.0 / self.rate;
        let mut events: Vec<(f64, Event)> = self.events.into_iter().chain(saves).collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        if self.on_edit != OnEdit::Restart {
            stage.command(Command::OnEdit { mode: self.on_edit });
        }
        stage.event(Event::Save(text));
        let mut events = events.into_iter().peekable();
        let mut real = 0.0;
        loop {
            while let Some((_, event)) = events.next_if(|&(t, _)| t <= real) {
                stage.event(event);
            }
            real += stage.period;
            if real > self.length {
                return stage.records;
            }
            stage.tick();
        }
    }
}

fn split(text: &str) -> (&str, &str) {
    let (first, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (first, rest.trim())
}

/// Milliseconds, or seconds where it ends with `s`.
fn number(text: &str) -> f64 {
    let (text, unit) = text.strip_suffix('s').map_or((text, 1.0), |text| (text, 1000.0));
    unit * text.parse::<f64>().unwrap_or_else(|_| panic!("`{text}` is not a number"))
}

fn on_edit(text: &str) -> OnEdit {
    match text {
        "restart" => OnEdit::Restart,
        "keep" => OnEdit::Keep,
        _ => panic!("`{text}` is no way to edit"),
    }
}

pub fn read_event(text: &str) -> Event {
    let (what, rest) = split(text);
    Event::Command(match what {
        "pause" => Command::Pause,
        "resume" => Command::Resume,
        "step" => Command::Step,
        "restart" => Command::Restart,
        "runstop" => Command::Runstop,
        "rate" => Command::Rate { hz: number(rest) },
        "on-edit" => Command::OnEdit { mode: on_edit(rest) },
        "saves" => Command::Saves { mode: if rest == "hold" { Saves::Hold } else { Saves::Apply } },
        "apply-held" => Command::ApplyHeld,
        "drop-held" => Command::DropHeld,
        "transition-to" => Command::TransitionTo { state: rest.into() },
        "jump-to" => Command::JumpTo { state: rest.into() },
        "set" => {
            let (var, value) = split(rest);
            Command::Set { var: var.into(), value: value.into() }
        }
        "reset" => Command::Reset { var: rest.into() },
        "input" => {
            let (port, value) = split(rest);
            let (bridge, name) = port.split_once('.').expect("robot.input");
            let value = serde_json::from_str(value).expect("a message in JSON");
            return Event::Input(Input { bridge: bridge.into(), name: name.into(), value });
        }
        "break" => Command::Break { at: place(rest), mode: Breaking::Set },
        "clear" => Command::Break { at: place(rest), mode: Breaking::Clear },
        "on-error" => Command::OnError { mode: if rest == "pause" { OnError::Pause } else { OnError::Continue } },
        "explain" => Command::Explain { mode: if rest == "on" { Explain::On } else { Explain::Off } },
        _ => panic!("`{what}` is nothing that happens"),
    })
}

/// `state m/a`, `transition m: on go a -> b`, `condition x > 3`, `condition in m/a/n: x > 3`
fn place(text: &str) -> BreakAt {
    let (kind, rest) = split(text);
    match kind {
        "state" => BreakAt::State { state: rest.into() },
        "transition" => BreakAt::Transition { transition: rest.into() },
        "condition" => {
            let in_machine = rest.strip_prefix("in ").and_then(|rest| rest.split_once(": "));
            let (machine, condition) = in_machine.unwrap_or(("", rest));
            BreakAt::Condition { condition: condition.into(), machine: machine.into() }
        }
        _ => panic!("`{text}` is no place for a breakpoint"),
    }
}
