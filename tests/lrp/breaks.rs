//! What a robot is told around a breakpoint: the step's outputs wait, what `onpause` sends doesn't. And programs that pause
//! where there is no screen.

use std::fs;

use lrp::runtime::{Command, OnError, Options, Time, What};
use lrp::session::compile::Compiler;
use lrp::session::driver::Driver;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;

use crate::binary;

/// Drives from the first step on, where it pauses and brings the robot to rest.
const PROGRAM: &str = "(bridge robot sim)
(machine m
  (state a)
  (state b (onentry [robot.move{ linear = { x = 0.2 } }]) (onentry [if now() > 0 then error('no') end]) BREAK)
  (ontime 100 a -> b))
(onpause [robot.move{}])
(spawn m a)";

struct Rig {
    driver: Driver,
    now: f64,
}

impl Rig {
    fn paused_in_b(text: &str, on_error: OnError) -> Rig {
        let workshop =
            Workshop { folder: ".".into(), seed: 1, robots: Robots::AsProgrammed, plugins: Plugins::default() };
        let driver = Driver::new(Options { on_error, ..Options::default() }, workshop);
        let Ok(program) = Compiler::new(Vec::new()).compile(Source::new("a.lrp", text)) else { panic!("it compiles") };
        let mut rig = Rig { driver, now: 0.0 };
        rig.obey(Command::Load(program.into()));
        rig.step(100.0);
        assert!(rig.driver.engine().is_paused(), "it pauses in its first step");
        rig
    }

    fn obey(&mut self, command: Command) {
        self.driver.command(command, &mut |_| ()).expect("it is obeyed");
    }

    /// How far the robot has come, in metres, `ms` later.
    fn step(&mut self, ms: f64) -> f64 {
        self.now += ms;
        let mut x = None;
        self.driver.step(Time::from_ms(self.now), &mut |record| {
            if let What::Input { name, value, .. } = &record.what
                && **name == *"odom"
            {
                x = value["x"].as_f64();
            }
        });
        x.expect("the simulator tells where it is")
    }

    /// Whether the robot goes in the steps to come.
    fn drives(&mut self) -> bool {
        let from = self.step(10.0);
        self.step(10.0) > from
    }
}

fn on_break() -> Rig {
    Rig::paused_in_b(&PROGRAM.replace("BREAK", "(break)"), OnError::Continue)
}

#[test]
fn what_the_step_sent_leaves_after_what_the_pause_sent() {
    let mut rig = on_break();
    rig.obey(Command::Resume);
    assert!(rig.drives(), "the robot was told to drive last");
}

#[test]
fn it_leaves_with_a_step_by_hand_as_well() {
    let mut rig = on_break();
    rig.obey(Command::Step);
    assert!(rig.drives());
}

#[test]
fn the_pause_for_an_error_holds_it_as_well() {
    let mut rig = Rig::paused_in_b(&PROGRAM.replace("BREAK", ""), OnError::Pause);
    rig.obey(Command::Resume);
    assert!(rig.drives());
}

#[test]
fn a_restart_or_a_runstop_drops_it() {
    for command in [Command::Restart, Command::Runstop] {
        let mut rig = on_break();
        rig.obey(command.clone());
        rig.obey(Command::Resume);
        assert!(!rig.drives(), "{command:?}");
    }
}

#[test]
fn what_a_person_does_meanwhile_leaves_after_it() {
    let mut rig = on_break();
    rig.obey(Command::JumpTo { state: "m/a".into() });
    rig.obey(Command::TransitionTo { state: "m/b".into() });
    rig.obey(Command::Resume);
    assert!(rig.drives());
}

/// What `lrp run` says of a program, and its exit code.
fn run(text: &str, options: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("p.lrp"), text).expect("a program");
    let args = [&["run", "p.lrp", "--virtual", "--for", "10s", "--trace", "-"], options].concat();
    let said = binary::lrp(folder.path(), &args);
    let last = said.out.lines().last().unwrap_or_default().to_string();
    (said.code, said.err, last)
}

#[test]
fn a_run_without_a_screen_ends_where_it_pauses() {
    let text = "(machine m (state a (running [if now() == 300 then error('no luck') end]))) (spawn m a)";
    let (code, said, last) = run(text, &["--pause-on-error"]);
    assert_eq!(code, Some(1));
    assert!(said.contains("paused: error in m/a: no luck; nobody can let it go on without a screen"), "{said}");
    assert_eq!(last, r#"{"step":3,"t":300,"kind":"stop","reason":"the end"}"#);
    let (code, said, last) = run("(machine m (state a) (state b (break)) (eps a -> b)) (spawn m a)", &[]);
    assert_eq!(code, Some(1));
    assert!(said.starts_with("paused: breakpoint: entered m/b; nobody"), "{said}");
    assert_eq!(last, r#"{"step":1,"t":100,"kind":"stop","reason":"the end"}"#);
    let (code, said, last) = run(text, &[]);
    assert!(code == Some(1) && said.contains("no luck") && last.contains(r#""t":10000"#), "{said}{last}");
}
