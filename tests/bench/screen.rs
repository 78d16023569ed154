//! What the screen costs: bytes a second to the terminal for each layout, what it takes from the engine, how long a key
//! waits for its frame, and memory over hours. Prints the tables of docs/figures.md.

#[path = "../lrp/meter.rs"]
mod meter;
#[path = "screen/terminal.rs"]
mod terminal;
mod timing;

use std::fs;
use std::hint::black_box;
use std::process::Command;
use std::time::Duration;

use meter::{Meter, World, behavior};
use ratatui::layout::Size;
use terminal::Terminal;
use timing::{best, median, timed};

const SIZES: [(u16, u16); 5] = [(80, 24), (120, 40), (200, 60), (40, 24), (80, 12)];
const SECONDS: usize = 60;
const HOUR: usize = 3600;
const KEYS: usize = 40;

/// One machine in a state that it will leave in an hour.
const WAITING: &str = "(machine m (state a) (state b) (ontime 3600000 a -> b)) (spawn m a)";
/// The line follower where it has nothing more to do, while its robot goes on telling where it is.
const STANDING: &str = "Up Down Down Down Down Down Down Down Down Down Down J";
/// Two transitions, a variable and a nested machine at every step. Says after four seconds how many there were.
const BUSY: &str = "(var n := [0]) (var said := [false])
    (machine m
      (event over [now() >= 4000 and not said])
      (state a (onentry [n = n + 1]) (machine inner (state i) (state j) (eps i -> j)) (onentry (spawn inner i)))
      (state b (onentry [n = n + 1]))
      (state tell (onentry [said = true; log.warn('steps ' .. n)]))
      (on over * -> tell)
      (eps a -> b) (eps b -> a) (eps tell -> a))
    (spawn m a)";
/// Says something else at every step, fails at every step, changes state and a table.
const NOISY: &str = "(var n := [0]) (var list := [{}])
    (machine m
      (state a (running [n = n + 1; list[n % 100] = n; log.info('step ' .. n)]) (running [local x = nil; x.y = n]))
      (state b (running [n = n + 1; log.warn('other step ' .. n)]))
      (ontime 100 a -> b) (ontime 100 b -> a))
    (spawn m a)";

fn main() {
    bytes();
    speed();
    memory();
}

fn bytes() {
    println!("| bytes a second (most in one) | line follower | with its world | standing | waiting | 10,000 Hz |");
    println!("|---|---|---|---|---|---|");
    let follower = behavior("line_follower.lrp");
    for (width, height) in SIZES {
        let size = Size { width, height };
        let bytes = |text: &str, rate: f64, world, keys: &str| {
            let bytes = Meter::new(text, rate, size, world, keys).run(SECONDS);
            format!("{} ({})", bytes.mean(), bytes.most())
        };
        println!(
            "| {width}x{height} | {} | {} | {} | {} | {} |",
            bytes(&follower, 10.0, World::Unknown, ""),
            bytes(&follower, 10.0, World::Drawn, "w"),
            bytes(&follower, 10.0, World::Unknown, STANDING),
            bytes(WAITING, 10.0, World::Unknown, ""),
            bytes(BUSY, 10_000.0, World::Unknown, ""),
        );
    }
}

fn speed() {
    println!("\n| steps asked for | headless | with the screen | ratio | key to frame, ms: median | worst |");
    println!("|---|---|---|---|---|---|");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("busy.lrp"), BUSY).expect("a program");
    for rate in ["10000", "0"] {
        let alone = Command::new(env!("CARGO_BIN_EXE_lrp"))
            .args(["run", "busy.lrp", "--rate", rate, "--for", "5s"])
            .current_dir(folder.path())
            .output()
            .expect("it runs");
        let alone = steps(&String::from_utf8_lossy(&alone.stderr)).expect("it says how many steps it made");
        let mut terminal = Terminal::run(folder.path(), &["busy.lrp", "--rate", rate]);
        terminal.wait(|seen| seen.contains("RUN"));
        let waits: Vec<Duration> = (0..KEYS).map(|_| key_to_frame(&mut terminal)).collect();
        terminal.wait(|seen| steps(seen).is_some());
        let beside = steps(&terminal.seen()).expect("it has been waited for");
        let ms = |wait: Duration| format!("{:.1}", wait.as_secs_f64() * 1e3);
        let worst = waits.iter().copied().max().unwrap_or_default();
        let asked = if rate == "0" { "as many as can be" } else { rate };
        let ratio = beside as f64 / alone as f64;
        println!("| {asked} | {alone} | {beside} | {ratio:.2} | {} | {} |", ms(median(&waits)), ms(worst));
    }
}

/// How long until the help is seen; it is left again.
fn key_to_frame(terminal: &mut Terminal) -> Duration {
    let opened = timed(|| {
        terminal.press("?");
        terminal.wait(|seen| seen.contains("─ keys"));
    });
    terminal.press("\x1b");
    terminal.wait(|seen| seen.contains("─ machines"));
    opened
}

/// What the program says at its end.
fn steps(said: &str) -> Option<u64> {
    let (_, rest) = said.split_once("steps ")?;
    rest.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

fn memory() {
    let mut meter = Meter::new(NOISY, 10.0, Size { width: 80, height: 24 }, World::Unknown, "");
    let _ = meter.run(SECONDS);
    let before = resident();
    let rounds: Vec<Duration> =
        (0..HOUR / SECONDS - 1).map(|_| timed(|| drop(black_box(meter.run(SECONDS))))).collect();
    println!("\nAn hour of a noisy program: {before:.1} MB after a minute, {:.1} MB after an hour;", resident());
    println!("a minute of it takes {:?} to fold and draw.", best(&rounds));
}

/// MB in memory.
fn resident() -> f64 {
    let pages = fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: f64 = pages.split(' ').nth(1).and_then(|pages| pages.parse().ok()).unwrap_or(f64::NAN);
    pages * 4096.0 / 1e6
}
