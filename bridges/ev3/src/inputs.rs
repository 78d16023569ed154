//! What was read from a brick, as messages for the program.

use serde_json::{Map, Value, json};

use crate::motor::Motor;
use crate::poll::{BUTTONS, Sensor, Turning, World};
use crate::sensor;
use crate::settings::Settings;

pub fn messages(world: &World, settings: &Settings) -> Vec<(String, Value)> {
    let sensors =
        world.sensors.iter().enumerate().map(|(index, sensor)| (format!("port{}", index + 1), of_sensor(sensor)));
    let motors = Motor::ALL.into_iter().map(|motor| {
        let turning = &world.motors[motor.index()];
        (format!("port{}", motor.letter()), of_motor(turning, settings.sign(motor)))
    });
    let buttons: Map<String, Value> =
        BUTTONS.iter().zip(world.buttons).map(|(name, pressed)| (name.to_string(), pressed.into())).collect();
    let battery = present([
        ("volts", world.volts.map(tidy)),
        ("amperes", world.amperes.map(tidy)),
        ("percent", world.charge.map(Value::from)),
    ]);
    let brick = [("buttons".to_string(), Value::from(buttons)), ("battery".to_string(), battery)];
    sensors.chain(motors).chain(brick).collect()
}

fn of_sensor(seen: &Sensor) -> Value {
    let mode = sensor::mode_of(seen.kind, seen.mode);
    let value = seen.values.first().copied().flatten();
    let several =
        (seen.values.len() > 1).then(|| seen.values.iter().map(|value| value.map_or(Value::Null, tidy)).collect());
    let touched = matches!((seen.kind, seen.mode), (sensor::TOUCH | sensor::NXT_TOUCH, 0));
    let coloured = (seen.kind, seen.mode) == (sensor::COLOUR, sensor::COLOUR_MODE);
    present([
        ("kind", Some(sensor::name(seen.kind).into())),
        (
            "mode",
            sensor::is_ready(seen.kind)
                .then(|| mode.map_or_else(|| format!("Mode{}", seen.mode), |mode| mode.name.into()).into()),
        ),
        ("value", value.map(tidy)),
        ("values", several),
        ("raw", seen.raw.map(Value::from)),
        ("percent", seen.percent.map(Value::from)),
        ("unit", mode.map(|mode| mode.unit.into())),
        ("pressed", value.filter(|_| touched).map(|value| (value >= 0.5).into())),
        ("colour", value.filter(|_| coloured).and_then(sensor::colour).map(Value::from)),
    ])
}

fn of_motor(seen: &Turning, sign: i32) -> Value {
    present([
        ("kind", Some(sensor::name(seen.kind).into())),
        ("position", seen.position.map(|position| (sign * position).into())),
        ("speed", seen.speed.map(|speed| (sign * i32::from(speed)).into())),
        ("busy", Some(seen.busy.into())),
    ])
}

/// A field without a value is left out, and so nil.
fn present<const N: usize>(fields: [(&str, Option<Value>); N]) -> Value {
    fields.into_iter().filter_map(|(name, value)| Some((name.to_string(), value?))).collect::<Map<_, _>>().into()
}

/// With three decimals: as many as any sensor means.
fn tidy(value: f32) -> Value {
    json!((f64::from(value) * 1000.0).round() / 1000.0)
}
