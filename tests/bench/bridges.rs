//! What bridges cost the program: how long a message takes there and back, and how late steps are beside bridges that
//! hang, crash or flood. Ratios within one run.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use lrp::model::{Edit, Program};
use lrp::runtime::{Command, Options, Record, Time, What};
use lrp::session::compile::Compiler;
use lrp::session::driver::Driver;
use lrp::session::plugins::{Folders, Plugin, Plugins};
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;

const ROUND_TRIPS: usize = 2_000;
const PERIOD: Duration = Duration::from_millis(10);
const STEPS: u32 = 800;

fn main() {
    let binary = PathBuf::from(env!("CARGO_BIN_EXE_lrp"));
    let examples = binary.with_file_name("examples");
    if !examples.join("liblrp_bridge_echo.so").exists() {
        println!("first: cargo build --release --workspace && cargo build --release -p lrp-bridge --examples");
        return;
    }
    let built = binary.with_file_name("");
    let plugins = Plugins::new(Folders::new(vec![examples, built.join("deps"), built]), binary.clone());
    round_trip(&plugins);
    sizes(&plugins.folders, &binary);
    lateness(&plugins);
}

/// A program whose robots are there, or have had a second to be.
fn start(text: &str, folder: &Path, plugins: &Plugins) -> Driver {
    let workshop = Workshop { folder: folder.into(), seed: 1, robots: Robots::AsProgrammed, plugins: plugins.clone() };
    let mut driver = Driver::new(Options::default(), workshop);
    let mut compiler = Compiler::new(Vec::new()).with_plugins(plugins.clone());
    let Ok(program) = compiler.compile(Source::new("bench.lrp", text)) else { panic!("it is a program: {text}") };
    let edit = Edit::of(&Program::default().into(), program);
    driver.prepare(&edit, &mut drop);
    let end = Instant::now() + Duration::from_secs(1);
    while !driver.is_ready() && Instant::now() < end {
        driver.attend(&mut drop);
        sleep(Duration::from_millis(1));
    }
    driver.command(Command::Load(edit), &mut drop).expect("a load is never refused");
    driver
}

/// From an output in one step to the input that answers it in a later one, steps as fast as they can be.
fn round_trip(plugins: &Plugins) {
    let text = "(bridge robot echo)
        (var n := [0])
        (machine m
          (state said (onentry [n = n + 1; robot.say{ text = tostring(n) }]))
          (state heard)
          (eps said -> heard)
          (on [robot.heard.text == tostring(n)] heard -> said))
        (spawn m said)";
    let mut driver = start(text, Path::new("."), plugins);
    let (mut now, mut begun, mut trips) = (Time::ZERO, Instant::now(), Vec::new());
    while trips.len() < ROUND_TRIPS {
        now = now + Time(1000);
        let (mut sent, mut heard, before) = (false, false, Instant::now());
        driver.step(now, &mut |record: Record| match record.what {
            What::Output { .. } => sent = true,
            What::Input { .. } => heard = true,
            _ => {}
        });
        if heard {
            trips.push(begun.elapsed());
        }
        if sent {
            begun = before;
        }
    }
    trips.sort();
    let at = |part: f64| trips[(trips.len() as f64 * part) as usize].as_secs_f64() * 1e3;
    println!("there and back through a bridge's process, ms: median {:.3}  p99 {:.3}", at(0.5), at(0.99));
}

/// Of each bridge's library on disk, and of its process while it looks for a robot that isn't there.
fn sizes(folders: &Folders, lrp: &Path) {
    println!("\nbridge     library, KB     process, KB resident");
    for Plugin { kind, path, .. } in folders.all() {
        let library = std::fs::metadata(&path).map_or(0, |data| data.len());
        let config = match kind.as_str() {
            "ev3" => r#"{"address":"127.0.0.1:9"}"#,
            "serial" => r#"{"port":"/dev/none"}"#,
            "ros2" => r#"{"localhost":true,"domain":99}"#,
            _ => "{}",
        };
        println!("{kind:10} {:>11} {:>24}", library / 1000, resident(lrp, &path, config));
    }
}

fn resident(lrp: &Path, library: &Path, config: &str) -> String {
    let mut host = Process::new(lrp);
    host.arg("bridge-host").arg(library).stdin(Stdio::piped()).stdout(Stdio::null());
    let mut host = host.spawn().expect("a process");
    let order = format!(r#"{{"order":"configure","name":"robot","config":{config},"folder":"."}}"#);
    let mut orders = host.stdin.take().expect("a pipe");
    writeln!(orders, "{order}").expect("a bridge that listens");
    sleep(Duration::from_secs(2));
    let status = std::fs::read_to_string(format!("/proc/{}/status", host.id())).expect("its status");
    drop(orders);
    host.wait().expect("its end");
    let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    resident.unwrap_or_default().trim().trim_end_matches(" kB").to_string()
}

/// By how much steps at 100 Hz come too late.
fn lateness(plugins: &Plugins) {
    let folder = std::env::temp_dir();
    let machine = "(var n := [0]) (machine m (state s (running [n = n + 1]))) (spawn m s)";
    let robots =
        |first: &str| (0..4).map(|i| format!("(bridge r{i} unruly [ first = \"{first}\" ])\n")).collect::<String>();
    println!("\nlateness of steps at 100 Hz beside four bridges, us          median     p99");
    for (what, bridges) in [
        ("no bridge", String::new()),
        ("quiet", robots("")),
        ("hanging", robots("hang")),
        ("crashing again and again", robots("abort")),
        ("flooding", robots("flood")),
        ("no bridge again", String::new()),
    ] {
        let mut driver = start(&format!("{bridges}{machine}"), &folder, plugins);
        let late = run(&mut driver);
        let at = |part: f64| late[(late.len() as f64 * part) as usize].as_micros();
        println!("{what:56} {:>10} {:>7}", at(0.5), at(0.99));
    }
}

fn run(driver: &mut Driver) -> Vec<Duration> {
    let start = Instant::now();
    let mut late = Vec::new();
    for step in 1..=STEPS {
        let due = start + PERIOD * step;
        sleep(due.saturating_duration_since(Instant::now()));
        driver.step(Time::from_ms(f64::from(step) * 10.0), &mut drop);
        late.push(Instant::now().saturating_duration_since(due));
    }
    late.sort();
    late
}
