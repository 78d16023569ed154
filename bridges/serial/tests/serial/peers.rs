//! Against peers that are not ours to bend: a simulated ATmega328, socat, and another client of Firmata on the same board.

use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Order, Peer};
use lrp_peers::{program, python};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::board::Bench;
use crate::terminal::{bridge, config, until_log, until_open};

fn data(value: &Value) -> i64 {
    value["data"].as_i64().unwrap_or(i64::MIN)
}

fn pulse(lrp: &mut Peer) {
    lrp.order(Order::Stop);
    lrp.until("`stopped`", |event| (*event == Event::Stopped).then_some(()));
}

#[test]
fn a_board_that_speaks_in_lines() {
    let Some(bench) = Bench::with("lines") else { return };
    let board = bench.plug();
    let rest = json!({
        "ready": "ready lines", "stop": "S",
        "inputs": { "light": 0, "wheels": { "left": 0, "right": 0 } },
        "rename": { "left": "wheels.left", "right": "wheels.right" },
        "outputs": { "drive": "M {left:.0} {right:.0}" },
        "calls": { "ping": { "send": "P {n}", "reply": "pong {}" }, "dance": { "send": "D", "reply": "d", "error": "error {:s}" } },
    });
    let mut lrp = bridge(config(board.path(), rest));
    board.press_reset();
    lrp.until_up();
    until_log(&mut lrp, "halted");
    lrp.send("drive", json!({ "left": 100, "right": -50.4 }));
    lrp.input_where("wheels", |wheels| *wheels == json!({ "left": 100, "right": -50 }));
    assert_eq!(lrp.input_where("light", |light| data(light) != 100), json!({ "data": 150 }));
    let mut times = Vec::new();
    for n in 0..20 {
        let begun = Instant::now();
        let ping = lrp.call("ping", vec![json!(n)]);
        assert_eq!(lrp.reply(ping), Ok(json!(n + 1)));
        times.push(begun.elapsed());
    }
    times.sort();
    eprintln!("a call to the board and back: {:?} in the median, {:?} at most", times[10], times[19]);
    let dance = lrp.call("dance", vec![]);
    assert_eq!(lrp.reply(dance), Err("error D".into()));
    pulse(&mut lrp);
    lrp.input_where("wheels", |wheels| *wheels == json!({ "left": 0, "right": 0 }));
    // Its reset button.
    lrp.send("drive", json!({ "left": 9, "right": 9 }));
    lrp.input_where("wheels", |wheels| wheels["left"] == 9);
    board.press_reset();
    until_log(&mut lrp, "began anew");
    // Its cable.
    drop(board);
    lrp.until_lost();
    let board = bench.plug();
    until_open(&mut lrp);
    board.press_reset();
    lrp.until_up();
    until_log(&mut lrp, "halted");
    assert_eq!(lrp.input("wheels"), json!({ "left": 0, "right": 0 }));
    // lrp is gone.
    lrp.send("drive", json!({ "left": 9, "right": 9 }));
    lrp.input_where("wheels", |wheels| wheels["left"] == 9);
    assert_eq!(lrp.close(), 0);
    let mut port = serialport::new(board.path().to_string_lossy(), 115_200).timeout(Duration::from_secs(5));
    port = port.exclusive(false);
    let lines = BufReader::new(port.open().expect("the board's port")).lines();
    let halted = lines.take(200).map_while(Result::ok).any(|line| line.contains("left=0 right=0"));
    assert!(halted, "the board was left moving");
}

#[test]
fn the_sketch_of_the_manual() {
    let Some(bench) = Bench::with_sketch() else { return };
    let board = bench.plug();
    let rest = json!({
        "ready": "ready", "stop": "S", "inputs": { "light": 0, "bumper": 0 },
        "outputs": { "move": "M {linear.x:.2} {angular.z:.2}" },
    });
    let mut lrp = bridge(config(board.path(), rest));
    board.press_reset();
    lrp.until_up();
    // 3 of 5 V.
    lrp.input_where("light", |light| (610..=618).contains(&data(light)));
    lrp.send("move", json!({ "linear": { "x": 0.5 }, "angular": { "z": 0 } }));
    lrp.input_where("bumper", |bumper| data(bumper) == 0);
    board.press_bumper();
    lrp.input_where("bumper", |bumper| data(bumper) == 1);
}

fn firmata(port: &std::path::Path) -> Value {
    json!({
        "port": port, "codec": "firmata", "sampling": 20,
        "pins": {
            "led": "output 13", "button": "input 7", "motor": "pwm 5", "light": "analog A0", "arm": "servo 9",
            "lamp": "output 12", "dark": "input 4 inverted",
        },
    })
}

/// What the wires of the board give back: led to button, motor to light.
fn settled(lrp: &mut Peer, led: i64, motor: i64) -> Value {
    lrp.send("led", json!({ "data": led }));
    lrp.send("motor", json!({ "data": motor }));
    let near = motor * 1023 / 255;
    let button = lrp.input_where("button", |button| data(button) == led);
    let light = lrp.input_where("light", |light| (data(light) - near).abs() <= 2);
    json!({ "button": button["data"], "light": light["data"] })
}

#[test]
fn a_board_with_firmata_as_another_client_sees_it() {
    let Some(bench) = Bench::with("firmata") else { return };
    let board = bench.plug();
    let mut lrp = bridge(firmata(board.path()));
    lrp.until_up();
    let ours = json!([settled(&mut lrp, 1, 255), settled(&mut lrp, 0, 51)]);
    lrp.send("lamp", json!({ "data": 1 }));
    lrp.input_where("dark", |dark| data(dark) == 0);
    lrp.send("arm", json!({ "data": 90 }));
    // A value that doesn't change is told all the same, so that it doesn't grow stale.
    let (first, second) = (lrp.input("button"), lrp.input("button"));
    assert_eq!((data(&first), data(&second)), (0, 0));
    settled(&mut lrp, 1, 255);
    pulse(&mut lrp);
    lrp.input_where("button", |button| data(button) == 0);
    lrp.input_where("light", |light| data(light) == 0);
    lrp.input_where("dark", |dark| data(dark) == 1);
    // Its reset button: the pins are set up again.
    board.press_reset();
    until_log(&mut lrp, "began anew");
    settled(&mut lrp, 1, 255);
    assert_eq!(lrp.close(), 0);

    board.press_reset();
    let Some(python) = python("serial") else { return };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/serial/crosscheck.py");
    let output = Command::new(python).arg(script).arg(board.path()).output().expect("a Python");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let theirs: Value = serde_json::from_slice(&output.stdout).expect("what it saw");
    assert_eq!(ours, theirs);
}

#[test]
fn a_board_that_can_not_do_what_is_asked_of_a_pin() {
    let Some(bench) = Bench::with("firmata") else { return };
    let board = bench.plug();
    let mut lrp =
        bridge(json!({ "port": board.path(), "codec": "firmata", "pins": { "fan": "pwm 3", "led": "output 13" } }));
    let told = until_log(&mut lrp, "`fan`");
    assert_eq!(told, "`fan`: that pin can't do pwm on this board; pins that can: 5, 6");
    lrp.until_up();
}

/// Two terminals joined back to back.
struct Socat {
    child: Child,
    folder: TempDir,
}

impl Socat {
    fn new(program: &std::path::Path) -> Socat {
        let folder = TempDir::new().expect("a folder");
        let end = |name: &str| format!("pty,raw,echo=0,link={}", folder.path().join(name).display());
        // Over after a minute, whatever becomes of the test.
        let child = Command::new(program).args(["-T60", &end("a"), &end("b")]).spawn().expect("socat");
        let until = Instant::now() + Duration::from_secs(10);
        while !(folder.path().join("a").exists() && folder.path().join("b").exists()) && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        Socat { child, folder }
    }
}

impl Drop for Socat {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn two_terminals_joined_by_socat() {
    let Some(program) = program("socat") else { return };
    let socat = Socat::new(&program);
    let other = OpenOptions::new().read(true).write(true).open(socat.folder.path().join("b")).expect("the other end");
    let mut lines = BufReader::new(other.try_clone().expect("the same"));
    let mut robot = other;
    let rest = json!({ "fields": "json", "stop": "S", "inputs": { "light": 0 }, "outputs": { "say": "{text:json}" } });
    let mut lrp = bridge(config(&socat.folder.path().join("a"), rest));
    robot.write_all(b"{}\n").expect("an end that listens");
    lrp.until_up();
    lrp.send("say", json!({ "text": "h\u{e9}llo\n" }));
    let mut heard = String::new();
    for _ in 0..2 {
        lines.read_line(&mut heard).expect("a line");
    }
    assert_eq!(heard, "S\n\"h\u{e9}llo\\n\"\n");
    robot.write_all(b"{\"light\": 4}\n").expect("an end that listens");
    assert_eq!(lrp.input("light"), json!({ "data": 4 }));
}
