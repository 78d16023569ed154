//! A brick to try programs with where there is none: `cargo run -p lrp-bridge-ev3 --example fake_brick -- 5555`. Tells what
//! its motors do; a line `1 30` has the sensor on port 1 give 30, `press 2` and `release 2` are for its buttons.

use std::io::BufRead;
use std::thread::{sleep, spawn};
use std::time::Duration;

use lrp_fake_ev3::Brick;

/// How often its motors are looked at.
const LOOK: Duration = Duration::from_millis(100);

fn main() {
    let port = std::env::args().nth(1).and_then(|port| port.parse().ok()).unwrap_or(5555);
    let brick = Brick::start(port);
    brick.call_out(3015, "EV3", "0016533F0C1E");
    brick.state().machine.plug(1, 16, &[0.0]);
    brick.state().machine.plug(3, 29, &[60.0]);
    println!("a brick `EV3` at {}: touch sensor on port 1, colour sensor on port 3", brick.address);
    let watched = brick.clone();
    spawn(move || watch(&watched));
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        if !obey(&brick, &line) {
            println!("`1 30`, `press 2`, `release 2`, not `{line}`");
        }
    }
    // Without anybody to type, it goes on until it is killed.
    loop {
        sleep(LOOK);
    }
}

fn obey(brick: &Brick, line: &str) -> bool {
    let mut words = line.split_whitespace();
    let (Some(first), Some(second)) = (words.next(), words.next()) else { return false };
    let machine = &mut brick.state().machine;
    match (first, first.parse::<usize>(), second.parse::<i32>()) {
        ("press", _, Ok(button)) => machine.pressed.push(button),
        ("release", _, Ok(button)) => machine.pressed.retain(|&pressed| pressed != button),
        (_, Ok(port @ 1..=4), Ok(value)) => machine.sensors[port - 1].values = vec![value as f32],
        _ => return false,
    }
    true
}

fn watch(brick: &Brick) {
    let mut told = String::new();
    loop {
        let mut state = brick.state();
        state.machine.pass();
        let speeds = state.machine.motors.map(|motor| motor.speed);
        let modes: Vec<u8> = state.machine.sensors.iter().map(|sensor| sensor.mode).collect();
        let shown = std::mem::take(&mut state.machine.shown);
        drop(state);
        shown.iter().for_each(|shown| println!("{shown}"));
        let now = format!("motors {speeds:?}, modes {modes:?}");
        if now != told {
            println!("{now}");
            told = now;
        }
        sleep(LOOK);
    }
}
