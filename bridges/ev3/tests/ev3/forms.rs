//! What a form may say, what is wrong with it, and that what is offered is there.

use lrp_bridge::{Bridge, Problem};
use lrp_bridge_ev3::Ev3;
use lrp_bridge_ev3::motor::Motor;
use lrp_bridge_ev3::orders;
use lrp_bridge_ev3::settings::{Place, Settings};
use serde_json::{Value, json};

fn wrong(config: Value) -> Vec<String> {
    let problems = Ev3::offer(&config).err().unwrap_or_default();
    let told = |problem: Problem| {
        format!("{}: {} ({})", problem.key.unwrap_or_default(), problem.message, problem.help.unwrap_or_default())
    };
    problems.into_iter().map(told).collect()
}

fn settings(config: Value) -> Settings {
    Settings::read(&config).unwrap_or_else(|problems| panic!("{problems:?}"))
}

#[test]
fn nothing_need_be_said() {
    for config in [json!({}), json!([]), Value::Null] {
        assert_eq!(wrong(config.clone()), [""; 0]);
        assert!(matches!(settings(config).place, Place::Heard { port: 3015, .. }));
    }
}

#[test]
fn addresses() {
    for (address, host, port) in [
        ("ev3", "ev3", 5555),
        ("10.0.0.2:1", "10.0.0.2", 1),
        ("fe80::1", "fe80::1", 5555),
        ("brick.local:5556", "brick.local", 5556),
    ] {
        let place = settings(json!({ "address": address })).place;
        assert_eq!(place, Place::Address { host: host.into(), port }, "{address}");
    }
}

#[test]
fn mistakes_name_the_key_and_the_way_out() {
    assert_eq!(
        wrong(json!({ "adress": "x" })),
        ["adress: `ev3` has no setting `adress` (it has name, serial, address, sensors, reversed, rate, discovery)"]
    );
    assert_eq!(
        wrong(json!({ "address": "x:y" })),
        ["address: `x:y` is no address (a host's name or number, as `192.168.0.17` or `192.168.0.17:5555`)"]
    );
    assert_eq!(
        wrong(json!({ "name": "EV3", "address": "x" })),
        ["name: `address` says already which brick it is (leave `name` or `address` out)"]
    );
    assert_eq!(
        wrong(json!({ "rate": 1000 })),
        ["rate: `rate` is a number of Hz from 1 to 50 (20 is enough for most robots)"]
    );
    assert_eq!(wrong(json!({ "name": 7 })), ["name: `name` is a text (put it between quotes)"]);
    assert_eq!(
        wrong(json!({ "discovery": 0 })),
        ["discovery: `discovery` is a port, 1 to 65535 (leave it out for the usual one)"]
    );
    assert_eq!(wrong(json!({ "reversed": ["B", "E"] })), ["reversed: \"E\" is no motor (a list of letters A to D)"]);
}

#[test]
fn modes_are_named_or_numbered() {
    for mode in [
        json!("reflected"),
        json!("color/Color"),
        json!("COL-REFLECT"),
        json!("Mode2"),
        json!(2),
        json!("touch"),
        Value::Null,
    ] {
        assert_eq!(wrong(json!({ "sensors": [mode] })), [""; 0], "{mode}");
        assert_eq!(wrong(json!({ "sensors": { "3": mode } })), [""; 0], "{mode}");
    }
    let help = "(as `\"colour/reflected\"`, `\"touch\"` or `\"Mode2\"`)";
    assert_eq!(
        wrong(json!({ "sensors": { "5": "touch" } })),
        ["sensors.5: there is no sensor port `5` (ports are 1 to 4)"]
    );
    assert_eq!(
        wrong(json!({ "sensors": ["reflexted"] })),
        [format!("sensors.1: no sensor has a mode `reflexted`; write its name, or `Mode0` to `Mode7` {help}")]
    );
    assert_eq!(
        wrong(json!({ "sensors": [null, "touch/angle"] })),
        [format!("sensors.2: `angle` is no mode of touch; it has pressed, bumps {help}")]
    );
    assert_eq!(wrong(json!({ "sensors": [9] })), [format!("sensors.1: 9 is no mode; modes are 0 to 7 {help}")]);
}

#[test]
fn a_motor_may_be_reversed() {
    let settings = settings(json!({ "reversed": "B" }));
    assert_eq!(Motor::ALL.map(|motor| settings.sign(motor)), [1, -1, 1, 1]);
}

/// Every function that is offered does something with its defaults and plain arguments.
#[test]
fn what_is_offered_is_there() {
    let settings = settings(json!({}));
    let offered = Ev3::offer(&json!({})).expect("an offer");
    let own = offered.calls.iter().map(|call| (call.name.clone(), call));
    let of_devices = offered.devices.iter().flat_map(|device| {
        device.functions.iter().map(move |function| (format!("{}.{}", device.name, function.name), function))
    });
    for (name, function) in own.chain(of_devices) {
        if let Some(read) = &function.reads {
            let (input, field) = read.split_once('.').expect("a field");
            let message = &offered.input(input).unwrap_or_else(|| panic!("{name} reads {input}")).message;
            assert!(message.get(field).is_some(), "{name} reads {read}");
            continue;
        }
        let plain = |argument: &lrp_bridge::Argument| match &*argument.name {
            "other" => json!(if name.starts_with("motorA") { "B" } else { "A" }),
            "light" => json!("green"),
            "file" => json!("ui/Startup"),
            "hz" => json!(440),
            "mode" => json!("Mode1"),
            _ => json!(30),
        };
        let arguments: Vec<Value> = function
            .arguments
            .iter()
            .map(|argument| argument.default.clone().unwrap_or_else(|| plain(argument)))
            .collect();
        if let Err(problem) = orders::read(&name, &arguments, &settings) {
            panic!("{name}: {problem}");
        }
    }
}

#[test]
fn mistakes_in_calls_are_told() {
    let settings = settings(json!({ "reversed": ["B"] }));
    let told = |call: &str, arguments: Value| {
        orders::read(call, arguments.as_array().expect("a list"), &settings).expect_err("a mistake")
    };
    assert_eq!(told("motorA.start", json!(["fast"])), "`speed` is a number, not \"fast\"");
    assert_eq!(told("motorA.start", json!([{ "lua": "nan" }])), "`speed` is a number, not {\"lua\":\"nan\"}");
    assert_eq!(told("motorA.moveBy", json!([90, 0, "brake", 0])), "at speed 0 a move never ends");
    assert_eq!(told("motorA.stop", json!(["float"])), "`how` is \"brake\" or \"coast\", not \"float\"");
    assert_eq!(told("motorA.startWith", json!(["A", 50, 0])), "`other` is another motor's letter, not `A`");
    assert_eq!(
        told("motorA.startWith", json!(["B", 50, 0])),
        "one of these motors is reversed and the other isn't; they can't go in step"
    );
    assert_eq!(told("tone", json!([20, 100, 50])), "`hz` is from 250 to 10000, not 20");
    assert_eq!(told("motorE.start", json!([1])), "an EV3 brick has no `motorE.start`");
    assert!(told("led", json!(["blue"])).starts_with("`blue` is no light; there are off, green"));
}
