//! One command that reads everything at once, and what it found. Nothing in it can wait on the brick: a sensor that isn't
//! ready has no value, where the opcodes that wait for one would keep the brick from hearing a stop.

use crate::command::{Answer, At, Command};
use crate::motor::{Motor, Motors};
use crate::sensor;

const DEVICE: u8 = 0x99;
const TYPE_AND_MODE: u8 = 0x05;
const READ: u8 = 0x9a;
const READ_SI: u8 = 0x9d;
const READ_SEVERAL: u8 = 0x9e;
const MOTOR_READ: u8 = 0xa8;
const MOTOR_TEST: u8 = 0xa9;
const MOTOR_COUNT: u8 = 0xb3;
const BUTTON: u8 = 0x83;
const PRESSED: u8 = 0x09;
const SYSTEM: u8 = 0x81;
const VOLTS: u8 = 0x01;
const AMPERES: u8 = 0x02;
const CHARGE: u8 = 0x12;
const KEEP_AWAKE: u8 = 0x90;

/// Formats of the opcode that reads several values.
const RAW: i32 = 0x12;
const SI: i32 = 0x13;

const LAYER: i32 = 0;
const SAME_TYPE: i32 = 0;
const SAME_MODE: i32 = -1;

/// Motors as inputs come after the sensors of four chained bricks.
const MOTOR_PORT: i32 = 16;

/// The brick's buttons, in the order of their numbers from 1.
pub const BUTTONS: [&str; 6] = ["up", "enter", "down", "right", "left", "back"];

/// All that is read from a brick at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct World {
    pub sensors: [Sensor; 4],
    pub motors: [Turning; 4],
    /// Whether each is pressed.
    pub buttons: [bool; 6],
    pub volts: Option<f32>,
    pub amperes: Option<f32>,
    /// Per cent.
    pub charge: Option<u8>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensor {
    pub kind: u8,
    pub mode: u8,
    /// In the mode's unit.
    pub values: Vec<Option<f32>>,
    pub raw: Option<i32>,
    pub percent: Option<i8>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turning {
    pub kind: u8,
    /// Degrees since the last reset, as the brick counts.
    pub position: Option<i32>,
    /// Per cent, as the brick counts.
    pub speed: Option<i8>,
    pub busy: bool,
}

/// The command, and where in its answer things stand.
pub struct Poll {
    pub command: Command,
    sensors: [SensorAt; 4],
    motors: [MotorAt; 4],
    buttons: [At; 6],
    volts: At,
    amperes: At,
    charge: At,
}

struct SensorAt {
    kind: At,
    mode: At,
    values: Vec<At>,
    raw: At,
    percent: At,
}

struct MotorAt {
    kind: At,
    position: At,
    speed: At,
    busy: At,
}

impl Poll {
    /// Asks for as many values as the sensors seen last give in their modes.
    pub fn after(seen: &World) -> Poll {
        let mut command = Command::default();
        let sensors = [0, 1, 2, 3].map(|port| ask_sensor(&mut command, port, values_of(&seen.sensors[port])));
        let motors = Motor::ALL.map(|motor| ask_motor(&mut command, motor));
        let buttons = [1, 2, 3, 4, 5, 6].map(|button| {
            command.op(BUTTON).op(PRESSED).number(button);
            command.byte()
        });
        let [volts, amperes] = [VOLTS, AMPERES].map(|what| {
            command.op(SYSTEM).op(what);
            command.word()
        });
        command.op(SYSTEM).op(CHARGE);
        let charge = command.byte();
        command.op(KEEP_AWAKE);
        command.byte();
        Poll { command, sensors, motors, buttons, volts, amperes, charge }
    }

    /// Whatever the answer is, and however short, it is read as far as it goes.
    pub fn read(&self, answer: &[u8]) -> World {
        let answer = Answer(answer);
        World {
            sensors: self.sensors.each_ref().map(|at| Sensor {
                kind: answer.byte(at.kind).unwrap_or_default(),
                mode: answer.byte(at.mode).unwrap_or_default(),
                values: at.values.iter().map(|&at| answer.real(at)).collect(),
                raw: answer.integer(at.raw),
                percent: answer.small(at.percent),
            }),
            motors: self.motors.each_ref().map(|at| Turning {
                kind: answer.byte(at.kind).unwrap_or_default(),
                position: answer.integer(at.position),
                speed: answer.small(at.speed),
                busy: answer.byte(at.busy).is_some_and(|busy| busy != 0),
            }),
            buttons: self.buttons.map(|at| answer.byte(at).is_some_and(|pressed| pressed != 0)),
            volts: answer.real(self.volts),
            amperes: answer.real(self.amperes),
            charge: answer.byte(self.charge),
        }
    }
}

impl World {
    pub fn busy(&self) -> Motors {
        let busy = Motor::ALL.into_iter().filter(|motor| self.motors[motor.index()].busy);
        busy.fold(Motors::NONE, Motors::and)
    }
}

fn values_of(sensor: &Sensor) -> u8 {
    sensor::mode_of(sensor.kind, sensor.mode).map_or(1, |mode| mode.values)
}

fn type_and_mode(command: &mut Command, port: i32) -> (At, At) {
    command.op(DEVICE).op(TYPE_AND_MODE).numbers(&[LAYER, port]);
    (command.byte(), command.byte())
}

fn ask_sensor(command: &mut Command, port: usize, values: u8) -> SensorAt {
    let port = port as i32;
    let (kind, mode) = type_and_mode(command, port);
    let place = [LAYER, port, SAME_TYPE, SAME_MODE];
    command.op(READ_SEVERAL).numbers(&place).numbers(&[SI, values.into()]);
    let values = (0..values).map(|_| command.word()).collect();
    command.op(READ_SEVERAL).numbers(&place).numbers(&[RAW, 1]);
    let raw = command.word();
    command.op(READ).numbers(&place);
    SensorAt { kind, mode, values, raw, percent: command.byte() }
}

fn ask_motor(command: &mut Command, motor: Motor) -> MotorAt {
    let index = motor.index() as i32;
    let (kind, _) = type_and_mode(command, MOTOR_PORT + index);
    command.op(MOTOR_READ).numbers(&[LAYER, index]);
    // It has a second count, which isn't the one that a reset clears.
    let (speed, _) = (command.byte(), command.word());
    command.op(MOTOR_TEST).numbers(&[LAYER, 1 << index]);
    let busy = command.byte();
    command.op(MOTOR_COUNT).numbers(&[LAYER, index]);
    MotorAt { kind, position: command.word(), speed, busy }
}

/// Puts sensors into modes. Does nothing to one that isn't ready.
pub fn set_modes(modes: impl Iterator<Item = (usize, u8)>) -> Command {
    let mut command = Command::default();
    for (port, mode) in modes {
        command.op(READ_SI).numbers(&[LAYER, port as i32, SAME_TYPE, mode.into()]);
        command.word();
    }
    command
}
