//! A halt from another thread, and what the robot is told after it.

use lrp::runtime::{Command, Options, Time, What};
use lrp::session::compile::Compiler;
use lrp::session::driver::Driver;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::Source;

const PROGRAM: &str = "(bridge robot sim)
(machine m (state s (onentry [robot.move{ linear = { x = 0.2 } }])))
(spawn m s)";

fn started() -> Driver {
    let workshop = Workshop { folder: ".".into(), seed: 1, robots: Robots::AsProgrammed, plugins: Plugins::default() };
    let mut driver = Driver::new(Options::default(), workshop);
    let Ok(program) = Compiler::new(Vec::new()).compile(Source::new("a.lrp", PROGRAM)) else { panic!("it compiles") };
    obey(&mut driver, Command::Load(program.into()));
    driver
}

fn obey(driver: &mut Driver, command: Command) {
    driver.command(command, &mut |_| ()).expect("it is obeyed");
}

/// The robot's place after a step at `ms`.
fn step(driver: &mut Driver, ms: f64) -> f64 {
    let mut x = None;
    driver.step(Time::from_ms(ms), &mut |record| {
        if let What::Input { name, value, .. } = &record.what
            && **name == *"odom"
        {
            x = value["x"].as_f64();
        }
    });
    x.expect("the simulator tells where it is")
}

#[test]
fn a_halt_that_was_obeyed_does_not_undo_what_the_robot_is_told_later() {
    let mut driver = started();
    let start = step(&mut driver, 100.0);
    assert!(step(&mut driver, 200.0) > start);
    driver.stoppers().iter().for_each(|robot| robot.halt());
    obey(&mut driver, Command::Runstop);
    obey(&mut driver, Command::Restart);
    obey(&mut driver, Command::Resume);
    let stopped = step(&mut driver, 300.0);
    assert!(step(&mut driver, 400.0) > stopped, "what the restart told the robot is lost");
}

#[test]
fn runstop_halts_and_drops_what_was_held() {
    let mut driver = started();
    step(&mut driver, 100.0);
    obey(&mut driver, Command::Pause);
    obey(&mut driver, Command::Restart);
    obey(&mut driver, Command::Runstop);
    obey(&mut driver, Command::Resume);
    step(&mut driver, 200.0);
    let stopped = step(&mut driver, 300.0);
    assert_eq!(step(&mut driver, 400.0), stopped);
}
