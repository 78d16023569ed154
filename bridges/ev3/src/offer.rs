//! What a program sees of a brick: an input for each port, devices to tell motors and sensors what to do, a few calls.

use lrp_bridge::{Argument, Description, Device, Function, Port};
use serde_json::{Value, json};

use crate::motor::Motor;
use crate::poll::BUTTONS;

const SPEED: &str = "per cent of the full speed, -100 to 100; more is brought to these";
const HOW: &str = "\"brake\" or \"coast\" at the end";

pub fn description() -> Description {
    let sensors = 1..=4;
    let mut inputs: Vec<Port> = sensors.clone().map(sensor_port).collect();
    inputs.extend(Motor::ALL.map(motor_port));
    let buttons: serde_json::Map<String, Value> =
        BUTTONS.map(|name| (name.to_string(), json!(false))).into_iter().collect();
    inputs.push(Port::new("buttons", buttons.into(), "whether each of the brick's buttons is pressed"));
    let battery = json!({ "volts": null, "amperes": null, "percent": null });
    inputs.push(Port::new("battery", battery, "the brick's battery"));
    let devices = Motor::ALL.into_iter().map(motor).chain(sensors.map(sensor)).collect();
    Description { inputs, calls: calls(), devices, ..Description::default() }
}

fn sensor_port(number: usize) -> Port {
    let message = json!({
        "kind": "", "mode": "", "value": null, "values": null, "raw": null, "percent": null, "unit": "",
        "pressed": null, "colour": null,
    });
    Port::new(format!("port{number}"), message, "what the sensor says; a field without value is nil")
}

fn motor_port(motor: Motor) -> Port {
    let message = json!({ "kind": "", "position": null, "speed": null, "busy": false });
    let doc = "position in degrees since the last reset, speed in per cent, busy while a move is under way";
    Port::new(format!("port{}", motor.letter()), message, doc)
}

fn motor(motor: Motor) -> Device {
    let speed = || Argument::new("speed");
    let usual = || Argument::new("speed").or(50);
    let how = || Argument::new("how").or("brake");
    let ramp = || Argument::new("ramp").or(0);
    let turn = || Argument::new("turn").or(0);
    let arg = Argument::new;
    let port = |field: &str| format!("port{}.{field}", motor.letter());
    let together = "in step with another motor; turn 0 to 200: the other is slower, stands at 100, turns the other way \
                    above; below 0 this one is";
    let functions = vec![
        Function::new("startAtSpeed", vec![speed()], format!("turn until told otherwise; speed {SPEED}")),
        Function::new("start", vec![speed()], "the same as startAtSpeed"),
        Function::new("startAtPower", vec![arg("power")], "turn unregulated until told otherwise; power -100 to 100 %"),
        Function::new("stop", vec![how()], "\"brake\" holds it, \"coast\" lets it run out"),
        Function::new(
            "moveBy",
            vec![arg("degrees"), usual(), how(), ramp()],
            format!("turn by so much; {HOW}; ramp degrees"),
        ),
        Function::new(
            "moveTo",
            vec![arg("position"), usual(), how(), ramp()],
            "turn to a position, degrees from the last reset",
        ),
        Function::new("runFor", vec![arg("ms"), usual(), how(), ramp()], format!("turn for so long; {HOW}; ramp ms")),
        Function::new("startWith", vec![arg("other"), speed(), turn()], together),
        Function::new("moveWith", vec![arg("other"), arg("degrees"), usual(), turn(), how()], together),
        Function::new("runWith", vec![arg("other"), arg("ms"), usual(), turn(), how()], together),
        Function::new("reset", vec![], "where it is now is position 0"),
        Function::reading("position", port("position"), "degrees since the last reset"),
        Function::reading("speed", port("speed"), "per cent of the full speed"),
        Function::reading("busy", port("busy"), "whether a move is under way"),
        Function::reading("kind", port("kind"), "\"large-motor\", \"medium-motor\" or \"none\""),
    ];
    Device { name: format!("motor{}", motor.letter()), functions, doc: "a motor".to_string() }
}

fn sensor(number: usize) -> Device {
    let port = |field: &str| format!("port{number}.{field}");
    let functions = vec![
        Function::new(
            "setMode",
            vec![Argument::new("mode")],
            "a mode by name (\"reflected\") or number (\"Mode2\", 2)",
        ),
        Function::reading("read", port("value"), "the value in the mode's unit"),
        Function::reading("values", port("values"), "all values of a mode that has several"),
        Function::reading("raw", port("raw"), "the value as the sensor gives it"),
        Function::reading("percent", port("percent"), "the value as a part of its range, 0 to 100"),
        Function::reading("unit", port("unit"), "the mode's unit"),
        Function::reading("mode", port("mode"), "the mode's name"),
        Function::reading(
            "kind",
            port("kind"),
            "\"touch\", \"colour\", \"ultrasonic\", \"gyro\", \"infrared\", .. or \"none\"",
        ),
        Function::reading("pressed", port("pressed"), "of a touch sensor: whether it is pressed"),
        Function::reading("colour", port("colour"), "of a colour sensor in its colour mode: the colour's name"),
        Function::reading("color", port("colour"), "the same as colour"),
    ];
    Device { name: format!("sensor{number}"), functions, doc: "a sensor".to_string() }
}

fn calls() -> Vec<Function> {
    let arg = Argument::new;
    let volume = || arg("volume").or(50);
    vec![
        Function::new("fullStop", vec![], "stop all motors at once, with brakes"),
        Function::new(
            "tone",
            vec![arg("hz"), arg("ms").or(200), volume()],
            "a tone of 250 to 10000 Hz, for up to 32767 ms",
        ),
        Function::new("play", vec![arg("file"), volume()], "a sound file of the brick, without its ending"),
        Function::new("silence", vec![], "end the sound"),
        Function::new(
            "led",
            vec![arg("light")],
            "\"off\", \"green\", \"red\", \"orange\", also with -flashing or -pulsing",
        ),
    ]
}
