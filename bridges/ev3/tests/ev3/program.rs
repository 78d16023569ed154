//! What programs do with a brick that is well.

use std::time::{Duration, Instant};

use lrp_bridge::Event;
use serde_json::{Value, json};

use crate::peer::{Robot, eventually};

#[test]
fn it_is_halted_first_and_then_read() {
    let mut robot = Robot::connected(json!({}));
    robot.lrp.input("port1");
    let state = robot.brick.state();
    assert_eq!(crate::peer::hex(&state.frames[0].1), "0100000000a3000f01");
    assert!(state.machine.kept_awake > 0, "it would switch itself off");
}

#[test]
fn the_published_idioms() {
    let mut robot = Robot::connected(json!({}));
    assert_eq!(robot.call("motorA.startAtSpeed", json!([50])), Ok(Value::Null));
    assert_eq!(robot.call("motorB.startAtSpeed", json!([-20])), Ok(Value::Null));
    assert_eq!((robot.speed(0), robot.speed(1)), (50.0, -20.0));
    assert_eq!(robot.call("motorA.stop", json!(["brake"])), Ok(Value::Null));
    assert_eq!((robot.speed(0), robot.speed(1)), (0.0, -20.0));
    assert_eq!(robot.call("fullStop", json!([])), Ok(Value::Null));
    assert!(robot.is_still());
    assert_eq!(robot.operations(), ["a3000f01", "a500018132a60001", "a500022ca60002", "a3000101", "a3000f01"]);
}

#[test]
fn inputs_say_what_is_plugged_in() {
    let mut robot = Robot::connected(json!({}));
    robot.brick.state().machine.plug(1, 16, &[1.0]);
    robot.brick.state().machine.plug(2, 33, &[57.4]);
    robot.brick.state().machine.sensors[1].percent = 57;
    robot.brick.state().machine.pressed.push(2);
    let touched = robot.lrp.input_where("port1", |message| message["kind"] == "touch" && message["value"] == 1.0);
    let wanted = json!({ "kind": "touch", "mode": "pressed", "value": 1.0, "raw": 0, "percent": 0, "unit": "", "pressed": true });
    assert_eq!(touched, wanted);
    let near = robot.lrp.input_where("port2", |message| message["value"] == 57.4);
    let wanted =
        json!({ "kind": "infrared", "mode": "proximity", "value": 57.4, "raw": 0, "percent": 57, "unit": "%" });
    assert_eq!(near, wanted);
    assert_eq!(robot.lrp.input("port3"), json!({ "kind": "none" }));
    let motor = json!({ "kind": "large-motor", "position": 0, "speed": 0, "busy": false });
    assert_eq!(robot.lrp.input("portA"), motor);
    let buttons = json!({ "up": false, "enter": true, "down": false, "right": false, "left": false, "back": false });
    assert_eq!(robot.lrp.input("buttons"), buttons);
    assert_eq!(robot.lrp.input("battery"), json!({ "volts": 7.4, "amperes": 0.18, "percent": 83 }));
}

#[test]
fn a_move_is_done_when_the_motor_is_still() {
    let mut robot = Robot::connected(json!({}));
    let begun = Instant::now();
    assert_eq!(robot.call("motorA.moveBy", json!([200, 100, "brake", 20])), Ok(Value::Null));
    assert!(begun.elapsed() >= Duration::from_millis(200), "it takes a fifth of a second: {:?}", begun.elapsed());
    assert_eq!(robot.lrp.input_where("portA", |motor| motor["busy"] == false)["position"], 200);
    assert_eq!(robot.call("motorA.moveTo", json!([-50, 100, "coast", 0])), Ok(Value::Null));
    assert_eq!(robot.lrp.input_where("portA", |motor| motor["busy"] == false)["position"], -50);
    assert!(!robot.brick.state().machine.motors[0].brake);
    assert_eq!(robot.call("motorA.moveTo", json!([-50, 100, "coast", 0])), Ok(Value::Null), "it is there");
    assert_eq!(robot.call("motorA.runFor", json!([120, 50, "brake", 0])), Ok(Value::Null));
    assert_eq!(robot.call("motorA.reset", json!([])), Ok(Value::Null));
    assert_eq!(robot.lrp.input_where("portA", |motor| motor["position"] == 0)["busy"], false);
    assert_eq!(robot.brick.state().machine.blocked, 0, "nothing may keep the brick from hearing a stop");
}

#[test]
fn motors_go_in_step() {
    let mut robot = Robot::connected(json!({}));
    assert_eq!(robot.call("motorB.startWith", json!(["C", 40, 30])), Ok(Value::Null));
    assert_eq!((robot.speed(1), robot.speed(2)), (40.0, 28.0));
    assert_eq!(robot.call("motorC.moveWith", json!(["B", -100, 50, 30, "brake"])), Ok(Value::Null));
    assert_eq!(robot.call("motorC.moveWith", json!(["motorB", 0, 50, 30, "brake"])), Ok(Value::Null), "no way at all");
    assert_eq!(robot.call("motorB.runWith", json!(["C", 0, 50, 0, "brake"])), Ok(Value::Null), "no time at all");
    let sent = robot.operations();
    assert_eq!(sent[1..], ["b100068128".to_string() + "1e0001", "b0000681ce228164".to_string() + "01"]);
    assert!(robot.is_still());
}

#[test]
fn a_later_command_or_a_cancel_ends_a_move() {
    let mut robot = Robot::connected(json!({}));
    let overtaken = robot.begin("motorA.moveBy", json!([100_000, 50, "brake", 0]));
    let kept = robot.begin("motorB.moveBy", json!([100_000, 50, "brake", 0]));
    robot.begin("motorA.start", json!([10]));
    assert_eq!(robot.lrp.reply(overtaken), Err("ended by a later command to its motor".into()));
    robot.lrp.order(lrp_bridge::Order::Cancel { id: kept });
    assert_eq!(robot.lrp.reply(kept), Err("cancelled".into()));
    eventually("motor B stops", || robot.speed(1) == 0.0);
    assert_eq!(robot.speed(0), 10.0);
}

#[test]
fn what_one_step_sends_leaves_in_one_frame() {
    let mut robot = Robot::connected(json!({}));
    let call = |id, call: &str, arguments: Vec<Value>| {
        lrp_bridge::Item::Call(lrp_bridge::Call { call: call.into(), id, arguments })
    };
    robot.brick.mood(lrp_fake_ev3::Mood::Slow(Duration::from_millis(60)));
    let items = vec![
        call(1, "motorB.start", vec![json!(30)]),
        call(2, "motorC.start", vec![json!(30)]),
        call(3, "led", vec![json!("red")]),
        call(4, "motorX.start", vec![json!(30)]),
    ];
    robot.lrp.order(lrp_bridge::Order::Send { items });
    assert_eq!(robot.lrp.reply(3), Ok(Value::Null));
    let sent = robot.operations().split_off(1);
    assert!(sent.concat().contains("a500021ea60002a500041ea60004821b02"), "{sent:?}");
    assert!(sent.len() <= 2, "the first may have left before the rest came: {sent:?}");
}

#[test]
fn sensors_are_put_into_their_modes() {
    let brick = lrp_fake_ev3::Brick::start(0);
    brick.state().machine.plug(2, 29, &[3.0]);
    let mut robot = Robot::new(brick, json!({ "sensors": [null, "colour/colour", "ultrasonic"] }));
    let seen = robot.lrp.input_where("port2", |message| message["colour"] == "green");
    assert_eq!((&seen["mode"], &seen["value"]), (&json!("colour"), &json!(3.0)));
    assert_eq!(robot.call("sensor2.setMode", json!(["Mode1"])), Ok(Value::Null));
    assert_eq!(robot.lrp.input_where("port2", |message| message["mode"] == "ambient")["unit"], "%");
    // Plugged in anew it is in its first mode, and is put back.
    robot.brick.state().machine.plug(2, 29, &[3.0]);
    eventually("it is put back", || robot.brick.state().machine.sensors[1].mode == 1);
    assert_eq!(robot.call("sensor2.setMode", json!(["rgb"])), Ok(Value::Null));
    robot.brick.state().machine.sensors[1].values = vec![10.0, 20.0, 30.0];
    assert_eq!(robot.lrp.input_where("port2", |seen| seen["values"][2] == 30.0)["values"], json!([10.0, 20.0, 30.0]));
    let angle = robot.call("sensor2.setMode", json!(["angle"])).expect_err("not this sensor's");
    assert!(angle.starts_with("`angle` is no mode of colour; it has reflected, ambient"), "{angle}");
    let nobody = robot.call("sensor4.setMode", json!([1])).expect_err("nothing is there");
    assert_eq!(nobody, "port 4 isn't in that mode yet; it has none");
    robot.brick.state().machine.plug(3, 16, &[0.0]);
    let warned = robot.lrp.until("a warning", |event| match event {
        Event::Log { message, .. } => Some(message.clone()),
        _ => None,
    });
    assert_eq!(warned, "sensor3: a ultrasonic sensor is wanted, and this is touch");
    assert_eq!(robot.brick.state().machine.blocked, 0);
}

#[test]
fn a_reversed_motor_counts_the_other_way() {
    let mut robot = Robot::connected(json!({ "reversed": ["A"] }));
    assert_eq!(robot.call("motorA.start", json!([50])), Ok(Value::Null));
    assert_eq!(robot.speed(0), -50.0);
    robot.lrp.input_where("portA", |motor| motor["speed"] == 50 && motor["position"].as_i64() > Some(0));
    assert_eq!(robot.call("motorA.moveTo", json!([0, 100, "brake", 0])), Ok(Value::Null));
    let position = robot.brick.state().machine.motors[0].position;
    assert!(position.abs() <= 1.0, "a brick counts whole degrees: {position}");
}

#[test]
fn lights_and_sounds() {
    let mut robot = Robot::connected(json!({}));
    for (call, arguments) in [
        ("led", json!(["orange-pulsing"])),
        ("tone", json!([440, 500, 20])),
        ("play", json!(["ui/Startup", 100])),
        ("silence", json!([])),
    ] {
        assert_eq!(robot.call(call, arguments), Ok(Value::Null), "{call}");
    }
    assert_eq!(robot.brick.state().machine.shown, ["light 9", "tone [20, 440, 500]", "play 100 ui/Startup", "silence"]);
}

/// A form that is edited changes what differs; only another brick is another connection.
#[test]
fn an_edited_form_keeps_the_connection() {
    let mut robot = Robot::connected(json!({}));
    let address = robot.brick.address.to_string();
    robot.lrp.configure(json!({ "address": address, "rate": 40, "reversed": ["A"] }));
    assert_eq!(robot.call("motorA.start", json!([50])), Ok(Value::Null));
    assert_eq!((robot.speed(0), robot.brick.state().unlocked), (-50.0, 1));
    let other = lrp_fake_ev3::Brick::start(0);
    robot.lrp.configure(json!({ "address": other.address.to_string() }));
    robot.lrp.until_up();
    assert!(robot.is_still(), "the brick that is left stands still");
    assert_eq!((other.state().unlocked, robot.brick.state().unlocked), (1, 1));
    other.end();
}
