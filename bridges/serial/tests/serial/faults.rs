//! What happens to ports and lines: missing, forbidden, in use, pulled out, garbled, stuck.

use std::fs::{File, write};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Order, Peer};
use lrp_bridge_serial::Serial;
use serde_json::json;
use serialport::TTYPort;

use crate::terminal::{Socket, bridge, config, until_log, until_open};

fn lost(port: &str) -> String {
    let mut lrp = Peer::of::<Serial>();
    lrp.configure(json!({ "port": port }));
    lrp.until_lost()
}

#[test]
fn a_missing_port_names_those_that_there_are() {
    let mut lrp = Peer::of::<Serial>();
    lrp.configure(json!({ "port": "/dev/ttyNOWHERE7" }));
    let why = lrp.until_lost();
    assert!(why.starts_with("there is no port `/dev/ttyNOWHERE7`; there "), "{why}");
    lrp.until("what is found", |event| matches!(event, Event::Found { .. }).then_some(()));
}

#[test]
fn a_pattern_finds_the_one_port_it_fits() {
    let socket = Socket::new();
    let mut robot = socket.plug();
    let pattern = socket.path().with_file_name("tty?OB*");
    let mut lrp = bridge(config(&pattern, json!({ "stop": "S" })));
    robot.say("hello\n");
    lrp.until_up();
    write(socket.path().with_file_name("ttyROBOT1"), "").expect("a file");
    let why = lost(&pattern.to_string_lossy());
    assert!(why.contains("fits several ports: ") && why.ends_with("ttyROBOT1; name one of them"), "{why}");
}

#[test]
fn what_is_no_port_is_told() {
    let socket = Socket::new();
    File::create(socket.path()).expect("a file");
    assert_eq!(lost(&socket.path().to_string_lossy()), format!("{} is no serial port", socket.path().display()));
}

#[test]
fn a_port_in_use_is_told() {
    let socket = Socket::new();
    let _robot = socket.plug();
    let other = serialport::new(socket.path().to_string_lossy(), 9600);
    let _other = TTYPort::open(&other).expect("a free port");
    let why = lost(&socket.path().to_string_lossy());
    assert!(why.contains("is in use by another program"), "{why}");
}

#[test]
fn unplugged_and_plugged_in_again_it_is_stopped_first() {
    let socket = Socket::new();
    let mut robot = socket.plug();
    let rest = json!({ "ready": "ready", "stop": "S", "outputs": { "go": "G {x}" }, "inputs": { "light": 0 },
        "calls": { "slow": { "send": "L", "reply": "l", "timeout": 60000 } } });
    let mut lrp = bridge(config(&socket.path(), rest));
    robot.say("ready\n");
    lrp.until_up();
    let call = lrp.call("slow", vec![]);
    assert_eq!([robot.line(), robot.line()], ["S", "L"]);
    drop(robot);
    assert_eq!(lrp.reply(call), Err("the robot was lost".into()));
    let why = lrp.until_lost();
    assert!(why.contains("unplugged?"), "{why}");
    // Nothing is sent late.
    lrp.send("go", json!({ "x": 1 }));
    let mut robot = socket.plug();
    until_open(&mut lrp);
    robot.say("ght=7\nready\n");
    lrp.until_up();
    lrp.send("go", json!({ "x": 2 }));
    assert_eq!([robot.line(), robot.line()], ["S", "G 2"]);
    robot.say("light=8\n");
    assert_eq!(lrp.input("light"), json!({ "data": 8 }), "the rest of a line before is nobody's");
}

#[test]
fn garbage_is_counted_and_what_follows_is_read() {
    let socket = Socket::new();
    let mut robot = socket.plug();
    let mut lrp = bridge(config(&socket.path(), json!({ "ready": "ready", "inputs": { "light": 0 } })));
    robot.say("ready\n");
    lrp.until_up();
    robot.say(b"\xff\xfe\x00li\n");
    assert_eq!(until_log(&mut lrp, "no text"), "`\\xff\\xfe\\x00li` is no text: is `baud` wrong?");
    robot.say("light=dark\nplain words\n");
    robot.say(vec![b'x'; 10_000]);
    robot.say("\nlight=5\n");
    assert_eq!(lrp.input("light"), json!({ "data": 5 }));
    let told = until_log(&mut lrp, "times");
    assert_eq!(told, "a line of more than 4096 bytes can't be read (3 times so far, or of its like)");
}

#[test]
fn a_robot_that_does_not_read_holds_nothing_up() {
    let socket = Socket::new();
    let mut robot = socket.plug();
    let rest = json!({ "ready": "ready", "stop": "S", "outputs": { "go": "G {x} {text:s}" } });
    let mut lrp = bridge(config(&socket.path(), rest));
    robot.say("ready\n");
    lrp.until_up();
    // More than any terminal keeps.
    let begun = Instant::now();
    for x in 0..300 {
        lrp.send("go", json!({ "x": x, "text": "-".repeat(400) }));
    }
    lrp.order(Order::Ping { id: 5 });
    lrp.until("pong", |event| (*event == Event::Pong { id: 5 }).then_some(()));
    assert!(begun.elapsed() < Duration::from_secs(5));
    let dropped = lrp.until("drops", |event| match event {
        Event::Dropped { what, count } if what == "outputs" => Some(*count),
        _ => None,
    });
    assert!(dropped > 100, "{dropped}");
    // The latest is what goes out once it reads again.
    let mut last = robot.line();
    while !last.starts_with("G 299 ") {
        last = robot.line();
    }
    lrp.order(Order::Stop);
    assert_eq!(robot.line(), "S");
}

#[test]
fn a_stop_overtakes_what_is_stuck() {
    let socket = Socket::new();
    let mut robot = socket.plug();
    let rest = json!({ "ready": "ready", "stop": "S", "outputs": { "go": "G {text:s}" } });
    let mut lrp = bridge(config(&socket.path(), rest));
    robot.say("ready\n");
    lrp.until_up();
    for _ in 0..100 {
        lrp.send("go", json!({ "text": "-".repeat(400) }));
    }
    lrp.order(Order::Stop);
    lrp.until("`stopped`", |event| (*event == Event::Stopped).then_some(()));
    let lines: Vec<String> = std::iter::repeat_with(|| robot.line()).take(100).take_while(|line| line != "S").collect();
    assert!(lines.len() < 60, "a stop is not behind {} lines", lines.len());
}
