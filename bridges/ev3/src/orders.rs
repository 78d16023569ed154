//! What a program calls, as what is to be done at the brick; and what is wrong with it.

use serde_json::Value;

use crate::command::Command;
use crate::motor::{self, Halt, Motor, Motors, Way};
use crate::sensor::Choice;
use crate::settings::Settings;

const SOUND: u8 = 0x94;
const BREAK: u8 = 0x00;
const TONE: u8 = 0x01;
const PLAY: u8 = 0x02;
const WRITE: u8 = 0x82;
const LED: u8 = 0x1b;

const LIGHTS: [&str; 10] = [
    "off",
    "green",
    "red",
    "orange",
    "green-flashing",
    "red-flashing",
    "orange-flashing",
    "green-pulsing",
    "red-pulsing",
    "orange-pulsing",
];

/// The longest a brick may play a tone, and the furthest a motor turns at one call.
const LONGEST_TONE: f64 = 32767.0;
const FURTHEST: f64 = 1e9;

/// The longest path of a sound.
const PATH: usize = 200;

#[derive(Clone, Debug, PartialEq)]
pub enum Deed {
    /// Done as soon as the brick has it. Ends what these motors were about.
    Send { command: Command, motors: Motors },
    /// Done when these motors are at their end.
    Move { command: Command, motors: Motors },
    /// A move whose length depends on where the motor is by then.
    MoveTo { motor: Motor, position: i32, motion: Motion },
    /// Done when the sensor is in the mode.
    Mode { port: usize, choice: Choice },
    /// Nothing is to be done for it.
    Nothing,
}

/// How a motor moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    /// As the program counts.
    pub speed: i32,
    pub halt: Halt,
    pub ramp: i32,
}

/// Reads a call, as `motorA.start`, with its arguments.
pub fn read(call: &str, arguments: &[Value], settings: &Settings) -> Result<Deed, String> {
    let arguments = Arguments(arguments);
    let deed = match call.split_once('.') {
        None => whole(call, arguments)?,
        Some((device, function)) => {
            let motor = device.strip_prefix("motor").and_then(Motor::of_letter);
            let port =
                device.strip_prefix("sensor").and_then(|port| port.parse().ok()).filter(|port| (1..=4).contains(port));
            match (motor, port) {
                (Some(motor), _) => of_motor(motor, function, arguments, settings)?,
                (_, Some(port)) => of_sensor(port, function, arguments)?,
                _ => None,
            }
        }
    };
    deed.ok_or_else(|| format!("an EV3 brick has no `{call}`"))
}

/// Halts all motors.
pub fn full_stop() -> Command {
    motor::stop(Motors::ALL, Halt::Brake)
}

/// A motor's way to a position from where it is, both as the program counts. None: it is there.
pub fn way_to(motor: Motor, distance: i32, motion: Motion, settings: &Settings) -> Option<Command> {
    let speed = settings.sign(motor) * distance.signum() * motion.speed.abs();
    let way = Way::Degrees(distance.saturating_abs());
    (distance != 0).then(|| motor::turn(motor.into(), speed, way, motion.ramp, motion.halt))
}

fn whole(call: &str, arguments: Arguments) -> Result<Option<Deed>, String> {
    let mut command = Command::default();
    match call {
        "fullStop" => return Ok(Some(Deed::Send { command: full_stop(), motors: Motors::ALL })),
        "tone" => {
            let (hz, ms) =
                (arguments.between(0, "hz", 250.0, 10_000.0)?, arguments.between(1, "ms", 0.0, LONGEST_TONE)?);
            command.op(SOUND).op(TONE).numbers(&[arguments.volume(2)?, hz, ms]);
        }
        "play" => {
            let file = arguments.text(0, "file")?;
            if file.len() > PATH {
                return Err(format!("`file` is longer than {PATH} bytes"));
            }
            command.op(SOUND).op(PLAY).number(arguments.volume(1)?).text(file);
        }
        "silence" => {
            command.op(SOUND).op(BREAK);
        }
        "led" => {
            let light = arguments.text(0, "light")?;
            let Some(number) = LIGHTS.iter().position(|known| *known == light) else {
                return Err(format!("`{light}` is no light; there are {}", LIGHTS.join(", ")));
            };
            command.op(WRITE).op(LED).number(number as i32);
        }
        _ => return Ok(None),
    }
    Ok(Some(Deed::Send { command, motors: Motors::NONE }))
}

fn of_sensor(port: usize, function: &str, arguments: Arguments) -> Result<Option<Deed>, String> {
    if function != "setMode" {
        return Ok(None);
    }
    let choice = match arguments.given(0) {
        Value::String(mode) => Choice::read(mode)?,
        _ => Choice::number(arguments.between(0, "mode", 0.0, 7.0)? as u8).ok_or("modes are 0 to 7")?,
    };
    Ok(Some(Deed::Mode { port: port - 1, choice }))
}

fn of_motor(motor: Motor, function: &str, arguments: Arguments, settings: &Settings) -> Result<Option<Deed>, String> {
    let motors = Motors::from(motor);
    let sign = settings.sign(motor);
    let command = match function {
        "startAtSpeed" | "start" => motor::start_at_speed(motors, sign * arguments.percent(0, "speed")?),
        "startAtPower" => motor::start_at_power(motors, sign * arguments.percent(0, "power")?),
        "stop" => motor::stop(motors, arguments.halt(0)?),
        "reset" => motor::reset(motors),
        "moveBy" | "moveTo" | "runFor" => return turn(motor, function, arguments, settings).map(Some),
        "startWith" | "moveWith" | "runWith" => return together(motor, function, arguments, settings).map(Some),
        _ => return Ok(None),
    };
    Ok(Some(Deed::Send { command, motors }))
}

fn turn(motor: Motor, function: &str, arguments: Arguments, settings: &Settings) -> Result<Deed, String> {
    let motion = Motion {
        speed: arguments.moving(1)?,
        halt: arguments.halt(2)?,
        ramp: arguments.between(3, "ramp", 0.0, FURTHEST)?,
    };
    let command = match function {
        "moveTo" => {
            let position = arguments.between(0, "position", -FURTHEST, FURTHEST)?;
            return Ok(Deed::MoveTo { motor, position, motion });
        }
        "moveBy" => {
            let degrees = arguments.between(0, "degrees", -FURTHEST, FURTHEST)?;
            way_to(motor, degrees * motion.speed.signum(), motion, settings)
        }
        _ => {
            let ms = arguments.between(0, "ms", 0.0, FURTHEST)?;
            let speed = settings.sign(motor) * motion.speed;
            (ms > 0).then(|| motor::turn(motor.into(), speed, Way::Milliseconds(ms), motion.ramp, motion.halt))
        }
    };
    Ok(command.map_or(Deed::Nothing, |command| Deed::Move { command, motors: motor.into() }))
}

fn together(motor: Motor, function: &str, arguments: Arguments, settings: &Settings) -> Result<Deed, String> {
    let other = arguments.text(0, "other")?;
    let partner = Motor::of_letter(other.strip_prefix("motor").unwrap_or(other)).filter(|&partner| partner != motor);
    let partner = partner.ok_or_else(|| format!("`other` is another motor's letter, not `{other}`"))?;
    let motors = Motors::from(motor).and(partner);
    if settings.sign(motor) != settings.sign(partner) {
        return Err("one of these motors is reversed and the other isn't; they can't go in step".to_string());
    }
    // The brick's first motor is the one with the lower letter.
    let side = if motor.index() < partner.index() { 1 } else { -1 };
    let bend = |at| Ok::<i32, String>(side * arguments.between(at, "turn", -200.0, 200.0)?);
    let sign = settings.sign(motor);
    if function == "startWith" {
        let (speed, turn) = (sign * arguments.percent(1, "speed")?, bend(2)?);
        let command = motor::turn_together(motors, speed, turn, Way::Milliseconds(0), Halt::Brake);
        return Ok(Deed::Send { command, motors });
    }
    let (speed, turn, halt) = (sign * arguments.moving(2)?, bend(3)?, arguments.halt(4)?);
    let (way, direction) = match function {
        "moveWith" => {
            let degrees = arguments.between(1, "degrees", -FURTHEST, FURTHEST)?;
            (Way::Degrees(degrees.abs()), degrees.signum())
        }
        _ => (Way::Milliseconds(arguments.between(1, "ms", 0.0, FURTHEST)?), 1),
    };
    // To the brick, no way at all is one without an end.
    if matches!(way, Way::Degrees(0) | Way::Milliseconds(0)) {
        return Ok(Deed::Nothing);
    }
    Ok(Deed::Move { command: motor::turn_together(motors, direction * speed, turn, way, halt), motors })
}

/// What a program gave, in the order of the description.
#[derive(Clone, Copy)]
struct Arguments<'a>(&'a [Value]);

impl<'a> Arguments<'a> {
    fn given(self, at: usize) -> &'a Value {
        self.0.get(at).unwrap_or(&Value::Null)
    }

    fn number(self, at: usize, name: &str) -> Result<f64, String> {
        let value = self.given(at);
        value.as_f64().ok_or_else(|| match value {
            Value::Null => format!("`{name}` is missing"),
            value => format!("`{name}` is a number, not {value}"),
        })
    }

    fn between(self, at: usize, name: &str, low: f64, high: f64) -> Result<i32, String> {
        let number = self.number(at, name)?.round();
        match (low..=high).contains(&number) {
            true => Ok(number as i32),
            false => Err(format!("`{name}` is from {low} to {high}, not {number}")),
        }
    }

    /// A speed or power. What a controller computes may well be more than a motor can do.
    fn percent(self, at: usize, name: &str) -> Result<i32, String> {
        Ok(self.number(at, name)?.round().clamp(-100.0, 100.0) as i32)
    }

    /// The speed of a move, which without any would never end.
    fn moving(self, at: usize) -> Result<i32, String> {
        match self.percent(at, "speed")? {
            0 => Err("at speed 0 a move never ends".to_string()),
            speed => Ok(speed),
        }
    }

    fn volume(self, at: usize) -> Result<i32, String> {
        self.between(at, "volume", 0.0, 100.0)
    }

    fn text(self, at: usize, name: &str) -> Result<&'a str, String> {
        self.given(at).as_str().ok_or_else(|| format!("`{name}` is a text, not {}", self.given(at)))
    }

    fn halt(self, at: usize) -> Result<Halt, String> {
        match self.text(at, "how")? {
            "brake" => Ok(Halt::Brake),
            "coast" => Ok(Halt::Coast),
            other => Err(format!("`how` is \"brake\" or \"coast\", not \"{other}\"")),
        }
    }
}
