//! Lines of text over a pseudo terminal: each way to write fields, templates, calls, the stop.

use lrp_bridge::{Event, Level, Peer};
use serde_json::{Value, json};

use crate::terminal::{Robot, Socket, bridge, config, until_log};

/// A robot that is up; its socket is to be kept.
fn up(rest: Value) -> (Peer, Robot, Socket) {
    let socket = Socket::new();
    let mut robot = socket.plug();
    let mut rest = rest;
    rest["ready"] = json!("ready");
    rest["stop"] = json!("S");
    let mut lrp = bridge(config(&socket.path(), rest));
    robot.say("\0\x7fnoise while it boots\r\nready v2\r\n");
    lrp.until_up();
    assert_eq!(robot.line(), "S", "it is stopped first");
    (lrp, robot, socket)
}

#[test]
fn names_and_values() {
    let (mut lrp, mut robot, _socket) =
        up(json!({ "inputs": { "light": 0, "bumper": false, "pose": { "x": 0, "y": 0 }, "name": "" } }));
    robot.say("light=230 bumper:1, pose.x=0.5; pose.y = -2 name=\"Robby the robot\"\n");
    assert_eq!(lrp.input("light"), json!({ "data": 230 }));
    assert_eq!(lrp.input("bumper"), json!({ "data": true }));
    assert_eq!(lrp.input("pose"), json!({ "x": 0.5, "y": -2 }));
    assert_eq!(lrp.input("name"), json!({ "data": "Robby the robot" }));
    robot.say("pose.y=3\nlight=1e2\n");
    assert_eq!(lrp.input("pose"), json!({ "x": 0.5, "y": 3 }), "what isn't said stays as it was");
    assert_eq!(lrp.input("light"), json!({ "data": 100.0 }));
}

#[test]
fn columns() {
    let (mut lrp, mut robot, _socket) = up(json!({
        "fields": "csv", "inputs": { "light": 0, "pose": { "x": 0, "y": 0 } },
        "columns": ["light", "", "pose.x", "pose.y"],
    }));
    robot.say("230, \"left, right\", 1.5, 2\r\n");
    assert_eq!(lrp.input("light"), json!({ "data": 230 }));
    assert_eq!(lrp.input("pose"), json!({ "x": 1.5, "y": 2 }));
    robot.say("30,1.5,2\n");
    assert!(until_log(&mut lrp, "can't be read").contains("it has 3 columns, not 4"));
}

#[test]
fn columns_by_the_first() {
    let (mut lrp, mut robot, _socket) = up(json!({
        "fields": "nmea", "inputs": { "fix": { "lat": 0, "lon": 0 }, "knots": 0 },
        "columns": { "GPGLL": ["fix.lat", "", "fix.lon"], "GPVTG": ["", "", "", "", "knots"] },
    }));
    robot.say("$GPGLL,5057.970,N,00146.110,E,142451,A*27\r\n");
    assert_eq!(lrp.input("fix"), json!({ "lat": 5057.97, "lon": 146.11 }));
    robot.say("$GPGSV,3,1,11\r\n$GPVTG,89.68,T,,M,0.5,N*00\r\n");
    let why = until_log(&mut lrp, "can't be read");
    assert!(why.contains("its checksum should be"), "{why}");
}

#[test]
fn json() {
    let (mut lrp, mut robot, _socket) = up(json!({
        "fields": "json", "inputs": { "light": 0, "pose": { "x": 0, "at": { "t": 0 } }, "scan": {} },
        "rename": { "l": "light" },
    }));
    robot.say("{\"l\":230,\"pose\":{\"x\":1,\"at\":{\"t\":7}},\"scan\":[1,2,3],\"battery\":{\"volts\":7.4}}\n");
    assert_eq!(lrp.input("light"), json!({ "data": 230 }));
    assert_eq!(lrp.input("pose"), json!({ "x": 1, "at": { "t": 7 } }));
    assert_eq!(lrp.input("scan"), json!({ "data": [1, 2, 3] }));
}

#[test]
fn fields_that_no_input_takes_are_told() {
    let (mut lrp, mut robot, _socket) = up(json!({}));
    robot.say("light=230 name=Robby\n");
    let found = lrp.until("both fields", |event| match event {
        Event::Found { found } => {
            let fields: Vec<_> = found.iter().filter(|found| found.what == "field").cloned().collect();
            (fields.len() == 2).then_some(fields)
        }
        _ => None,
    });
    let told: Vec<_> = found.iter().map(|found| (&*found.name, &*found.type_name, found.setting.as_deref())).collect();
    assert_eq!(told, [("light", "number", Some("inputs.light = 0")), ("name", "text", Some("inputs.name = \"\""))]);
}

#[test]
fn outputs_are_lines() {
    let (mut lrp, mut robot, _socket) = up(json!({ "outputs": {
        "move": "M {linear.x:.2} {angular.z}", "wheels": ["L {left}", "R {right}"], "say": "{{{text:s}}}", "any": "{:json}",
    } }));
    let move_ = json!({ "linear": { "x": 0.256 }, "angular": { "z": -1.5 } });
    lrp.send("move", move_);
    lrp.send("wheels", json!({ "left": 10, "right": true }));
    lrp.send("say", json!({ "text": "hello\nM 9 9" }));
    lrp.send("any", json!({ "a": [1, 2.5] }));
    let lines: Vec<String> = (0..5).map(|_| robot.line()).collect();
    assert_eq!(lines, ["M 0.26 -1.5", "L 10", "R 1", "{hello M 9 9}", "{\"a\":[1,2.5]}"]);
    lrp.send("move", json!({ "linear": { "x": { "lua": "nan" } }, "angular": { "z": 0 } }));
    assert_eq!(until_log(&mut lrp, "wasn't sent"), "`move` wasn't sent: `linear.x` should be a number");
}

#[test]
fn what_is_offered_has_every_field_at_its_default() {
    let mut lrp = Peer::of::<lrp_bridge_serial::Serial>();
    lrp.order(lrp_bridge::Order::Describe {
        config: json!({
            "inputs": { "light": 0, "pose": { "x": 0 } },
            "outputs": { "move": "M {linear.x:.2} {on:b} {text:s} {more:json}" },
            "calls": { "tone": { "send": "T {hz} {ms}", "reply": "ok {}" } },
        }),
    });
    let offer = lrp.offer();
    assert_eq!(offer.input("light").map(|port| &port.message), Some(&json!({ "data": 0 })));
    assert_eq!(offer.input("pose").map(|port| &port.message), Some(&json!({ "x": 0 })));
    let move_ = json!({ "linear": { "x": 0 }, "on": false, "text": "", "more": null });
    assert_eq!(offer.output("move").map(|port| &port.message), Some(&move_));
    let tone = offer.function("tone").expect("a call");
    assert_eq!(tone.arguments.iter().map(|argument| &*argument.name).collect::<Vec<_>>(), ["hz", "ms"]);
}

#[test]
fn calls_wait_for_the_line_that_answers() {
    let (mut lrp, mut robot, _socket) = up(json!({ "inputs": { "light": 0 }, "calls": {
        "beep": "B",
        "ping": { "send": "P {n}", "reply": "pong {}" },
        "where": { "send": "W", "reply": "at {x} {y}", "error": "lost {:s}" },
    } }));
    let beep = lrp.call("beep", vec![]);
    assert_eq!(lrp.reply(beep), Ok(Value::Null), "nothing is waited for");
    assert_eq!(robot.line(), "B");
    let (first, second) = (lrp.call("ping", vec![json!(1)]), lrp.call("ping", vec![json!(2)]));
    let place = lrp.call("where", vec![]);
    assert_eq!([robot.line(), robot.line(), robot.line()], ["P 1", "P 2", "W"]);
    robot.say("at 0.5 -1\nlight=3\npong 41\npong 42\n");
    assert_eq!(lrp.reply(place), Ok(json!({ "x": 0.5, "y": -1 })));
    assert_eq!((lrp.reply(first), lrp.reply(second)), (Ok(json!(41)), Ok(json!(42))));
    let place = lrp.call("where", vec![]);
    assert_eq!(robot.line(), "W");
    robot.say("lost in the dark\n");
    assert_eq!(lrp.reply(place), Err("lost in the dark".into()));
}

#[test]
fn calls_end_in_time_when_cancelled_and_with_a_stop() {
    let (mut lrp, mut robot, _socket) = up(json!({ "calls": {
        "quick": { "send": "Q", "reply": "q", "timeout": 50 }, "slow": { "send": "L", "reply": "l", "timeout": 60000 },
    } }));
    let quick = lrp.call("quick", vec![]);
    assert_eq!(lrp.reply(quick), Err("no answer within 50 ms".into()));
    let (first, second) = (lrp.call("slow", vec![]), lrp.call("slow", vec![]));
    lrp.order(lrp_bridge::Order::Cancel { id: first });
    assert_eq!([robot.line(), robot.line(), robot.line()], ["Q", "L", "L"]);
    robot.say("l\n");
    assert_eq!(lrp.reply(second), Ok(json!(true)), "the cancelled one takes no answer");
    let third = lrp.call("slow", vec![]);
    assert_eq!(robot.line(), "L");
    lrp.order(lrp_bridge::Order::Stop);
    assert_eq!(lrp.reply(third), Err("stopped".into()));
    lrp.until("`stopped`", |event| (*event == Event::Stopped).then_some(()));
    assert_eq!(robot.line(), "S");
}

#[test]
fn a_robot_that_begins_anew_is_stopped() {
    let (mut lrp, mut robot, _socket) = up(json!({ "inputs": { "light": 0 } }));
    robot.say("ready\n");
    until_log(&mut lrp, "began anew");
    assert_eq!(robot.line(), "S");
}

#[test]
fn comments_are_logged() {
    let (mut lrp, mut robot, _socket) = up(json!({}));
    robot.say("# battery is low\n");
    let level = lrp.until("comment", |event| match event {
        Event::Log { level, message, from: Some(_) } if message == "battery is low" => Some(*level),
        _ => None,
    });
    assert_eq!(level, Level::Info);
}

#[test]
fn an_edit_of_the_form_reconnects_nothing() {
    let (mut lrp, mut robot, socket) = up(json!({ "inputs": { "light": 0 }, "outputs": { "go": "G {x}" } }));
    let rest =
        json!({ "ready": "ready", "stop": "HALT", "inputs": { "light": 0, "far": 0 }, "outputs": { "go": "g{x}" } });
    lrp.configure(config(&socket.path(), rest));
    lrp.send("go", json!({ "x": 1 }));
    assert_eq!(robot.line(), "g1");
    robot.say("far=7\n");
    assert_eq!(lrp.input("far"), json!({ "data": 7 }));
    lrp.order(lrp_bridge::Order::Stop);
    assert_eq!(robot.line(), "HALT");
}

#[test]
fn without_lrp_it_is_stopped() {
    let (mut lrp, mut robot, _socket) = up(json!({ "outputs": { "go": "G" } }));
    lrp.send("go", json!({}));
    assert_eq!(robot.line(), "G");
    assert_eq!(lrp.close(), 0);
    assert_eq!(robot.line(), "S");
}
