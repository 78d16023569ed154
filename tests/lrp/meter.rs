//! What a screen costs on the line: a program runs in virtual time, the real app draws it through the real backend, and
//! what reaches the terminal is counted.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use lrp::model::Edit;
use lrp::runtime::{Command, Options, Record, Time, What};
use lrp::session::compile::Compiler;
use lrp::session::driver::Driver;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;
use lrp::ui::app::{App, Effect, Event, Options as Screen};
use lrp::ui::cadence::Cadence;
use lrp::ui::key::Key;
use lrp::ui::quiet::Quiet;
use lrp::ui::settings::Settings;
use lrp::ui::view::Choices;
use ratatui::layout::{Rect, Size};
use ratatui::{Terminal, TerminalOptions, Viewport};

/// Records reach the screen this far apart, as the engine's thread sends them.
const BATCH: f64 = 10.0;
/// Milliseconds between two records of the rate that is kept.
const STATUS: f64 = 500.0;

/// A program on a screen.
pub struct Meter {
    driver: Driver,
    app: App,
    terminal: Terminal<Quiet<Counter>>,
    sent: Counter,
    cadence: Cadence,
    rate: f64,
    /// ms since the program was loaded.
    now: f64,
    steps: u64,
    told: f64,
}

/// Whether the robot is one whose world can be drawn.
#[derive(Clone, Copy)]
pub enum World {
    Drawn,
    Unknown,
}

impl World {
    fn leave(self, mut record: Record) -> Record {
        if let (World::Unknown, What::Bridge(state)) = (self, &mut record.what) {
            state.world = None;
        }
        record
    }
}

/// A terminal that only counts.
#[derive(Clone, Default)]
pub struct Counter(Arc<AtomicUsize>);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.fetch_add(bytes.len(), Ordering::Relaxed);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Bytes in each second of a run.
pub struct Bytes(Vec<usize>);

impl Bytes {
    pub fn mean(&self) -> usize {
        self.0.iter().sum::<usize>().div_ceil(self.0.len())
    }

    pub fn most(&self) -> usize {
        self.0.iter().copied().max().unwrap_or(0)
    }
}

impl Meter {
    /// A text as a program in the folder of the behaviours, at so many steps a second, its first frame drawn.
    pub fn new(text: &str, rate: f64, size: Size, world: World, keys: &str) -> Meter {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("behaviors");
        let name = folder.join("program.lrp").display().to_string();
        let Ok(program) = Compiler::new(Vec::new()).compile(Source::new(name, text)) else { panic!("not a program") };
        let mut driver = Driver::new(
            Options::default(),
            Workshop { folder, seed: 1, robots: Robots::AsProgrammed, plugins: Plugins::default() },
        );
        let options = Screen {
            file: "program.lrp".into(),
            rate,
            choices: Choices::default(),
            settings: Settings::default(),
            size,
        };
        let mut app = App::new(options);
        let load = Command::Load(Edit::of(&Arc::default(), program));
        driver.command(load, &mut |record| app.record(&world.leave(record))).expect("a load is never refused");
        let sent = Counter::default();
        let viewport = Viewport::Fixed(Rect::new(0, 0, size.width, size.height));
        let terminal = Terminal::with_options(Quiet::new(sent.clone(), size), TerminalOptions { viewport });
        let terminal = terminal.expect("a terminal");
        let cadence = Cadence::default();
        let mut meter = Meter { driver, app, terminal, sent, cadence, rate, now: 0.0, steps: 0, told: 0.0 };
        meter.press(keys);
        meter.draw();
        meter
    }

    /// Keys given as text.
    pub fn press(&mut self, keys: &str) {
        for key in keys.split_whitespace() {
            let key = Event::Key(key.parse::<Key>().expect("a key").into());
            for effect in self.app.event(key) {
                if let Effect::Command(command) = effect {
                    self.command(command);
                }
            }
        }
        self.cadence.ask();
    }

    fn command(&mut self, command: Command) {
        let Meter { driver, app, .. } = self;
        // A refusal is among the records.
        let _ = driver.command(command, &mut |record| app.record(&record));
    }

    /// Goes on for some seconds.
    pub fn run(&mut self, seconds: usize) -> Bytes {
        let second = |_| {
            let (before, until) = (self.sent.0.load(Ordering::Relaxed), self.now + 1000.0);
            while self.now + BATCH / 2.0 < until {
                self.batch();
            }
            self.sent.0.load(Ordering::Relaxed) - before
        };
        Bytes((0..seconds).map(second).collect())
    }

    /// What comes from the engine at once.
    fn batch(&mut self) {
        self.now += BATCH;
        let mut records: Vec<Record> = Vec::new();
        while (self.steps + 1) as f64 * 1000.0 / self.rate <= self.now {
            self.steps += 1;
            let now = Time::from_ms(self.steps as f64 * 1000.0 / self.rate);
            self.driver.step(now, &mut |record| records.push(record));
        }
        if self.now - self.told >= STATUS {
            self.told = self.now;
            self.driver.say(What::Status { rate: self.rate, late: 0.1 }, &mut |record| records.push(record));
        }
        records.iter().for_each(|record| self.app.record(record));
        let now = Duration::from_secs_f64(self.now / 1000.0);
        if self.app.dirty() && self.cadence.wait(now).is_zero() {
            self.draw();
        }
    }

    fn draw(&mut self) {
        let app = &self.app;
        self.terminal.draw(|frame| app.draw(frame)).expect("a frame");
        self.app.drawn();
        self.cadence.drawn(Duration::from_secs_f64(self.now / 1000.0));
    }
}

/// A program of the behaviours' folder.
pub fn behavior(name: &str) -> String {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("behaviors").join(name);
    std::fs::read_to_string(file).expect("a behaviour")
}
