//! The pane of the robots: what it shows, what is sent by hand from there, and how what is seen there gets into the text.

use lrp::model::settings::{Setting, with_setting};
use lrp::runtime::command::Command;
use lrp::runtime::record::{BridgeState, Health, What};
use lrp::ui::app::{App, Effect};
use lrp_bridge::{Argument, Description, Device, Found, Function, Port};
use serde_json::json;

use crate::frames::{check, press, screen};
use crate::story::{Story, program};

const PROGRAM: &str = "(bridge robot ros2 [\n  subscribe = { light = \"/light\" },\n  stale = 500 ])\n\
                       (machine m\n  (state s (running [robot.move{ linear = { x = 0.2 } }])))\n(spawn m s)\n";

fn offer() -> Description {
    let twist = json!({ "linear": { "x": 0.0 }, "angular": { "z": 0.0 } });
    let light = Port::new("light", json!({ "data": 0 }), "brightness").of_type("std_msgs/msg/Int32");
    let sonar = Port::new("sonar", json!({ "range": 0.0 }), "metres").of_type("sensor_msgs/msg/Range");
    let motor = Device {
        name: "motorA".into(),
        functions: vec![
            Function::reading("position", "motors.A", "degrees"),
            Function::new("start", vec![Argument::new("speed").or(50)], ""),
        ],
        doc: String::new(),
    };
    Description {
        inputs: vec![light, sonar],
        outputs: vec![Port::new("move", twist, "m/s and rad/s").of_type("geometry_msgs/msg/Twist")],
        calls: vec![Function::new("say", vec![Argument::new("text")], "speaks")],
        devices: vec![motor],
        ..Description::default()
    }
}

/// A robot that is talked with, as the program runs.
fn story() -> Story {
    let mut story = Story::new();
    let text = program(PROGRAM);
    let state = |state, message: Option<&str>| {
        let message = message.map(ToString::to_string);
        What::Bridge(BridgeState { bridge: "robot".into(), kind: "ros2".into(), state, message, world: None })
    };
    story.tell(state(Health::Connecting, Some("looking for peers")));
    story.tell(state(Health::Up, None));
    story.tell(What::Offer { bridge: "robot".into(), description: Box::new(offer()) });
    let topic = |name: &str, type_name: &str, setting: &str| Found {
        name: name.into(),
        what: "topic".into(),
        type_name: type_name.into(),
        doc: "1 publishing, 0 subscribed".into(),
        setting: Some(setting.into()),
    };
    let found = vec![
        topic("/odom", "nav_msgs/msg/Odometry", "subscribe.odom"),
        topic("/scan", "sensor_msgs/msg/LaserScan", "subscribe.scan"),
    ];
    story.tell(What::Found { bridge: "robot".into(), found });
    story.load(&text, &[]).spawn("m", None).enter("m/s");
    for step in 1..=20 {
        story.at(step);
        story.input("light", json!({ "data": 142 + step }));
        story.output("move", json!({ "linear": { "x": 0.2 }, "angular": { "z": 0.0 } }));
    }
    let call = |id, name: &str, arguments| What::Call { bridge: "robot".into(), name: name.into(), id, arguments };
    let reply = |id, name: &str, done, value, error: Option<&str>| What::Reply {
        bridge: "robot".into(),
        name: name.into(),
        id,
        done,
        value,
        error: error.map(ToString::to_string),
    };
    story.at(21).tell(call(1, "say", json!(["hello"])));
    story.tell(call(2, "motorA.start", json!([50])));
    story.at(23).tell(reply(1, "say", true, json!(true), None));
    story.tell(call(3, "say", json!(["again"])));
    story.at(24).tell(reply(2, "motorA.start", false, json!({ "left": 0.5 }), None));
    story.at(25).tell(reply(3, "say", true, json!(null), Some("the speaker is busy")));
    story
}

fn shown(width: u16, height: u16) -> App {
    let mut app = screen(width, height, &story());
    assert_eq!(press(&mut app, "7"), []);
    app
}

#[test]
fn a_robot_with_all_it_has() {
    for (width, height) in [(80, 24), (120, 40), (40, 24), (80, 12)] {
        check(&format!("robots_{width}x{height}"), &shown(width, height));
    }
}

#[test]
fn a_robot_that_is_lost() {
    let mut story = story();
    let message = Some("crashed (SIGSEGV); started again in 0.5 s".to_string());
    let state = BridgeState { bridge: "robot".into(), kind: "ros2".into(), state: Health::Lost, message, world: None };
    story.at(30).tell(What::Bridge(state));
    for (width, height) in [(80, 24), (120, 40), (40, 24), (80, 12)] {
        let mut app = screen(width, height, &story);
        press(&mut app, "7");
        check(&format!("robot_lost_{width}x{height}"), &app);
    }
}

#[test]
fn a_program_waits_for_its_robot() {
    let mut story = Story::new();
    let message = Some("looking for a brick".to_string());
    let state =
        BridgeState { bridge: "robot".into(), kind: "ev3".into(), state: Health::Connecting, message, world: None };
    story.tell(What::Bridge(state));
    let mut app = screen(80, 24, &story);
    check("waiting_80x24", &app);
    assert_eq!(press(&mut app, "Space"), [Effect::Command(Command::Resume)]);
}

#[test]
fn what_is_sent_by_hand_is_written_as_in_a_block() {
    let mut app = shown(80, 24);
    // robot, light, sonar, move
    press(&mut app, "Down Down Down Down Enter");
    check("tell_80x24", &app);
    let tell = |what: &str| Effect::Command(Command::Tell { bridge: "robot".into(), what: what.into() });
    assert_eq!(press(&mut app, "Enter"), [tell("move{angular = {z = 0.0}, linear = {x = 0.2}}")]);
    press(&mut app, "End Up Up Enter");
    assert_eq!(press(&mut app, "Enter"), [tell("motorA:start(50)")]);
}

#[test]
fn what_is_seen_there_is_written_into_the_form() {
    let mut app = shown(80, 24);
    press(&mut app, "End Enter");
    check("subscribe_80x24", &app);
    let effects = press(&mut app, "Enter");
    let [Effect::WriteBack(all)] = &effects[..] else { panic!("{effects:?}") };
    let written = &all[0].rewrite.to;
    assert!(
        written.starts_with("(bridge robot ros2 [\n  subscribe = { light = \"/light\", scan = \"/scan\" },\n"),
        "{written}"
    );
}

#[test]
fn what_is_seen_there_is_found_by_its_name() {
    let mut app = shown(80, 24);
    press(&mut app, "/ o d o Enter End Enter");
    let effects = press(&mut app, "Enter");
    let [Effect::WriteBack(all)] = &effects[..] else { panic!("{effects:?}") };
    assert!(all[0].rewrite.to.contains("odom = \"/odom\""));
}

/// The form's text with a setting.
fn with(form: &str, setting: &str) -> Result<String, String> {
    let text = format!("{form}\n(machine m (state s))\n(spawn m s)\n");
    let setting = Setting::read(setting)?;
    let (_, new) = with_setting(&program(&text), "robot", &setting)?;
    let (form, _) = new.split_once("\n(machine").expect("the rest");
    Ok(form.to_string())
}

#[test]
fn a_setting_changes_nothing_else() {
    for (form, setting, written) in [
        ("(bridge robot sim)", "stale = 500", "(bridge robot sim [ stale = 500 ])"),
        ("(bridge robot sim [])", "names.light = \"eye\"", "(bridge robot sim [ names = { light = \"eye\" } ])"),
        (
            "(bridge robot sim [ stale = 5 ])",
            "noise.light = 3",
            "(bridge robot sim [ stale = 5, noise = { light = 3 } ])",
        ),
        (
            "(bridge robot sim [names={light='a'}])",
            "names.move = 'b'",
            "(bridge robot sim [names={light='a', move = 'b' }])",
        ),
        (
            "(bridge robot sim [\n  stale = 5 -- ms\n])",
            "world = 'x'",
            "(bridge robot sim [\n  stale = 5, -- ms\n  world = 'x'\n])",
        ),
        (
            "(bridge robot sim [\n  stale = 5, -- ms\n])",
            "world = 'x'",
            "(bridge robot sim [\n  stale = 5, -- ms\n  world = 'x'\n])",
        ),
        (
            "(bridge robot sim [\n  names = {\n    light = 'a',\n  } ])",
            "names.move = 'b'",
            "(bridge robot sim [\n  names = {\n    light = 'a',\n    move = 'b'\n  } ])",
        ),
    ] {
        assert_eq!(with(form, setting), Ok(written.to_string()), "{form} {setting}");
    }
}

#[test]
fn a_setting_that_cannot_be_says_why() {
    for (form, setting, why) in [
        ("(bridge robot sim [ stale = 5 ])", "stale = 6", "`stale` is set already: change it in the editor"),
        (
            "(bridge robot sim [ names = { light = 'a' } ])",
            "names.light = 'b'",
            "`names.light` is set already: change it in the editor",
        ),
        (
            "(bridge robot sim [ stale = 2 + 3 ])",
            "world = 'x'",
            "the configuration of `robot` is no plain table: change it in the editor",
        ),
        ("(bridge robot sim)", "stale", "a setting is written `key = value`"),
        ("(bridge robot sim)", "stale = now()", "`now()` is no Lua literal, as \"/odom\" or 500 are"),
        ("(bridge robot sim)", "a.b.c = 1", "`a.b.c` can't be a setting: write `key = value` or `table.key = value`"),
        ("(bridge other sim)", "stale = 5", "the text has no form `(bridge robot ..)` to write it into"),
    ] {
        assert_eq!(with(form, setting), Err(why.to_string()), "{form} {setting}");
    }
}
