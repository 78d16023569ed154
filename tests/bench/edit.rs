//! What an edit of a large program costs: reading, checking, comparing, taking over, and by how much it holds up the steps
//! of a program that runs at 1,000 Hz while the edit is compiled on another thread.

mod large;
mod live;
mod timing;

use std::sync::Arc;
use std::time::Duration;

use large::{Edit, Size};
use lrp::lua::Checker;
use lrp::model::checks::check;
use lrp::model::{self, Program, resolve};
use lrp::runtime::{Command, Engine, Options, Time, What};
use lrp::syntax::{FileId, Source, parse};
use timing::{best, median, timed};

const SIZE: Size = Size { machines: 50, states: 20, seed: 1 };
const ROUNDS: usize = 21;

/// What is done to a program again and again.
#[derive(Clone, Copy)]
enum Edited {
    /// So many blocks get another text, one that they never had.
    Blocks(usize),
    /// There and back.
    Once(Edit),
    /// It is loaded by those who have never seen it.
    FirstLoad,
}

const EDITS: [(&str, Edited); 10] = [
    ("nothing", Edited::Blocks(0)),
    ("1 block", Edited::Blocks(1)),
    ("10 blocks", Edited::Blocks(10)),
    ("100 blocks", Edited::Blocks(100)),
    ("1,000 blocks", Edited::Blocks(1_000)),
    ("a state added", Edited::Once(Edit::AddedState)),
    ("a state renamed", Edited::Once(Edit::RenamedState)),
    ("machines reordered", Edited::Once(Edit::Order)),
    ("layout and comments", Edited::Once(Edit::Layout)),
    ("everything is new", Edited::FirstLoad),
];

fn main() {
    let text = large::program(SIZE, Edit::Nothing);
    let program = checked(&text, &mut Checker::default());
    println!(
        "{} machines, {} states, {} transitions, {} blocks, {:.1} KB; milliseconds, best of {ROUNDS} edits\n",
        program.machines.len(),
        program.states.len(),
        program.transitions.len(),
        program.blocks.len(),
        text.len() as f64 / 1e3
    );
    println!(
        "{:22}{:>8}{:>8}{:>9}{:>8}{:>9}{:>10}",
        "edit", "parse", "check", "compare", "apply", "together", "(median)"
    );
    for (what, edited) in EDITS {
        Stages::of(edited).report(what);
    }
    throughput(&text);
    println!("\nlongest time from one step to the next at 1,000 Hz, ms; best and worst of {} edits", live::EDITS);
    report_gaps("without an edit", &live::gaps(SIZE, None));
    for (what, edited) in EDITS {
        if let Edited::Blocks(count) = edited {
            report_gaps(what, &live::gaps(SIZE, Some(count)));
        }
    }
}

fn report_gaps(what: &str, gaps: &[Duration]) {
    let worst = gaps.iter().copied().max().unwrap_or_default();
    println!("{what:22}{:8.2}{:8.2}   (median {:.2})", ms(best(gaps)), ms(worst), ms(median(gaps)));
}

fn throughput(text: &str) {
    let source = Source::new("large.lrp", text);
    let rounds: Vec<Duration> =
        (0..ROUNDS).map(|_| timed(|| drop(std::hint::black_box(parse(&source, FileId(0)))))).collect();
    let speed = |time: Duration| text.len() as f64 / 1e6 / time.as_secs_f64();
    println!("\nparsing: {:.1} MB/s (median {:.1})", speed(best(&rounds)), speed(median(&rounds)));
}

/// What each round took, by what was done in it.
#[derive(Default)]
struct Stages {
    parse: Vec<Duration>,
    check: Vec<Duration>,
    compare: Vec<Duration>,
    apply: Vec<Duration>,
}

impl Stages {
    fn of(edited: Edited) -> Stages {
        let base = large::program(SIZE, Edit::Nothing);
        match edited {
            Edited::FirstLoad => Stages::of_first_loads(&base),
            Edited::Blocks(count) => Stages::of_edits(&base, |round| {
                let version = round as u64 + 1;
                large::program(SIZE, Edit::Blocks { count, version })
            }),
            Edited::Once(edit) => Stages::of_edits(&base, |round| {
                large::program(SIZE, if round.is_multiple_of(2) { edit } else { Edit::Nothing })
            }),
        }
    }

    /// In an engine that runs; the text of each round.
    fn of_edits(base: &str, text: impl Fn(usize) -> String) -> Stages {
        let (mut checker, mut engine) = (Checker::default(), Engine::new(Options::default()));
        Stages::default().round(base, &mut checker, &mut engine);
        let mut stages = Stages::default();
        for round in 0..ROUNDS {
            stages.round(&text(round), &mut checker, &mut engine);
        }
        stages
    }

    fn of_first_loads(text: &str) -> Stages {
        let mut stages = Stages::default();
        for _ in 0..ROUNDS {
            stages.round(text, &mut Checker::default(), &mut Engine::new(Options::default()));
        }
        stages
    }

    fn round(&mut self, text: &str, checker: &mut Checker, engine: &mut Engine) {
        let source = Source::new("large.lrp", text);
        let mut parsed = None;
        self.parse.push(timed(|| parsed = Some(parse(&source, FileId(0)))));
        let parsed = parsed.expect("it was parsed");
        assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics[0]);
        let mut program = Program::default();
        self.check.push(timed(|| {
            program = resolve(&parsed.tree, source, &[], checker);
            check(&mut program, &[], checker);
        }));
        assert!(program.findings.iter().all(|it| !it.is_error()), "{:?}", program.findings);
        // Dropped beside the engine's thread, as in a session.
        let running = Arc::clone(engine.program());
        let mut edit = model::Edit::from(Program::default());
        self.compare.push(timed(|| edit = model::Edit::of(&running, program)));
        let load = Command::Load(edit);
        self.apply.push(timed(|| engine.command(load).expect("a load is never refused")));
        let restarted = |record: lrp::runtime::Record| matches!(record.what, What::Restart { .. });
        engine.drain(|record| assert!(!restarted(record), "these edits disturb nothing"));
        for _ in 0..10 {
            engine.step(engine.now() + Time(100_000), &[]);
        }
        engine.discard_records();
    }

    fn report(&self, what: &str) {
        let stages = [&self.parse, &self.check, &self.compare, &self.apply];
        let together: Vec<Duration> =
            (0..self.parse.len()).map(|round| stages.iter().map(|stage| stage[round]).sum()).collect();
        print!("{what:22}");
        stages.iter().for_each(|stage| print!("{:8.2}", ms(best(stage))));
        println!("{:9.2}{:10.2}", ms(best(&together)), ms(median(&together)));
    }
}

fn checked(text: &str, checker: &mut Checker) -> Program {
    let source = Source::new("large.lrp", text);
    resolve(&parse(&source, FileId(0)).tree, source, &[], checker)
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
