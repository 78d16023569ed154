//! A large program that runs at 1,000 Hz by the clock, as in a session, while its edits are compiled on another thread.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::large::{Edit, Size, program};
use lrp::model::{self, Program};
use lrp::runtime::{Command, Options, Time};
use lrp::session::compile::Compiler;
use lrp::session::driver::Driver;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;

pub const EDITS: usize = 20;
const PERIOD: Duration = Duration::from_millis(1);
/// Between two edits.
const STEPS: u32 = 60;

/// The longest time between the beginnings of two steps, around each of several edits of so many blocks; or of none.
pub fn gaps(size: Size, blocks: Option<usize>) -> Vec<Duration> {
    let (saves, inbox) = channel::<String>();
    let (compiled, commands) = channel();
    thread::scope(|scope| {
        scope.spawn(move || compile(&inbox, &compiled));
        run(size, blocks, saves, &commands)
    })
}

fn compile(saves: &Receiver<String>, compiled: &Sender<Command>) {
    let mut compiler = Compiler::new(Vec::new());
    let mut running: Arc<Program> = Arc::default();
    let mut ran = Arc::default();
    for text in saves {
        // Kept until the next save, as in a session, so that it is dropped here and not on the engine's thread.
        drop(std::mem::replace(&mut ran, Arc::clone(&running)));
        let Ok(program) = compiler.compile(Source::new("large.lrp", text)) else {
            unreachable!("the large program is one")
        };
        let edit = model::Edit::of(&running, program);
        running = Arc::clone(&edit.program);
        // Nobody waits for the last one.
        let _ = compiled.send(Command::Load(edit));
    }
}

/// The compiler's thread ends with the saves.
fn run(size: Size, blocks: Option<usize>, saves: Sender<String>, commands: &Receiver<Command>) -> Vec<Duration> {
    let workshop = Workshop { folder: ".".into(), seed: 1, robots: Robots::Fake, plugins: Plugins::default() };
    let mut driver = Driver::new(Options::default(), workshop);
    let mut gaps = Vec::with_capacity(EDITS);
    saves.send(program(size, Edit::Nothing)).expect("the compiler waits for saves");
    let first = commands.recv().expect("the compiler sends what it made");
    driver.command(first, &mut drop).expect("a load is never refused");
    for version in 1..=EDITS as u64 {
        let text = blocks.map(|count| program(size, Edit::Blocks { count, version }));
        let edit = match text {
            Some(text) => {
                saves.send(text).expect("the compiler waits for saves");
                Awaited::Edit
            }
            None => Awaited::Nothing,
        };
        gaps.push(longest_gap(&mut driver, commands, edit));
    }
    gaps
}

#[derive(Clone, Copy, PartialEq)]
enum Awaited {
    Edit,
    Nothing,
}

/// Goes on for some steps after what is awaited has been taken over.
fn longest_gap(driver: &mut Driver, commands: &Receiver<Command>, awaited: Awaited) -> Duration {
    let mut longest = Duration::ZERO;
    let mut due = Instant::now();
    let mut last = due;
    let (mut steps, mut loaded) = (0, (awaited == Awaited::Nothing).then_some(0));
    while loaded.is_none_or(|at| steps < at + STEPS) {
        let waits = due.saturating_duration_since(Instant::now());
        if let Ok(command) = commands.recv_timeout(waits) {
            driver.command(command, &mut drop).expect("a load is never refused");
            loaded = Some(steps);
            continue;
        }
        let begins = Instant::now();
        longest = longest.max(begins - last);
        last = begins;
        let now = driver.engine().now() + Time(1_000);
        driver.step(now, &mut drop);
        steps += 1;
        // Steps that couldn't be made in time are left out.
        due = (due + PERIOD).max(begins);
    }
    longest
}
