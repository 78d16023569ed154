//! What motors can be told, as commands. Speeds and degrees are the brick's: which way a motor is mounted isn't known here.

use crate::command::Command;

const RESET: u8 = 0xa2;
const STOP: u8 = 0xa3;
const POWER: u8 = 0xa4;
const SPEED: u8 = 0xa5;
const START: u8 = 0xa6;
const STEP_SPEED: u8 = 0xae;
const TIME_SPEED: u8 = 0xaf;
const STEP_SYNC: u8 = 0xb0;
const TIME_SYNC: u8 = 0xb1;
const CLEAR_COUNT: u8 = 0xb2;

/// The brick itself, not one chained to it.
const LAYER: i32 = 0;

/// One of the motors A to D, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motor(usize);

impl Motor {
    pub const ALL: [Motor; 4] = [Motor(0), Motor(1), Motor(2), Motor(3)];

    pub fn index(self) -> usize {
        self.0
    }

    pub fn letter(self) -> char {
        ['A', 'B', 'C', 'D'][self.0]
    }

    pub fn of_letter(letter: &str) -> Option<Motor> {
        Motor::ALL.into_iter().find(|motor| letter.len() == 1 && letter.starts_with(motor.letter()))
    }
}

/// A set of motors, as the brick's bit field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Motors(u8);

impl Motors {
    pub const NONE: Motors = Motors(0);
    pub const ALL: Motors = Motors(0x0f);

    pub fn and(self, motor: Motor) -> Motors {
        Motors(self.0 | 1 << motor.0)
    }

    pub fn has(self, motor: Motor) -> bool {
        self.overlaps(motor.into())
    }

    pub fn overlaps(self, other: Motors) -> bool {
        self.0 & other.0 != 0
    }
}

impl From<Motor> for Motors {
    fn from(motor: Motor) -> Motors {
        Motors::NONE.and(motor)
    }
}

/// What a motor does at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    Coast = 0,
    Brake = 1,
}

/// How far a motor goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Degrees(i32),
    Milliseconds(i32),
}

fn told(code: u8, motors: Motors, numbers: &[i32]) -> Command {
    let mut command = Command::default();
    command.op(code).numbers(&[LAYER, motors.0.into()]).numbers(numbers);
    command
}

/// Turns at a speed that the brick keeps under load, until it is told otherwise.
pub fn start_at_speed(motors: Motors, speed: i32) -> Command {
    start(told(SPEED, motors, &[speed]), motors)
}

/// Turns with a power that the brick doesn't regulate.
pub fn start_at_power(motors: Motors, power: i32) -> Command {
    start(told(POWER, motors, &[power]), motors)
}

fn start(mut command: Command, motors: Motors) -> Command {
    command.then(&told(START, motors, &[]));
    command
}

pub fn stop(motors: Motors, halt: Halt) -> Command {
    told(STOP, motors, &[halt as i32])
}

/// Turns for a way and stops. `ramp`: that much of it is speeding up, and as much slowing down.
pub fn turn(motors: Motors, speed: i32, way: Way, ramp: i32, halt: Halt) -> Command {
    let (code, length) = match way {
        Way::Degrees(degrees) => (STEP_SPEED, degrees),
        Way::Milliseconds(ms) => (TIME_SPEED, ms),
    };
    let ramp = ramp.clamp(0, length / 2);
    told(code, motors, &[speed, ramp, length - 2 * ramp, ramp, halt as i32])
}

/// Two motors in step; a way of 0 has no end. `turn`: how much slower the second (above 0) or the first (below) goes; at
/// 100 it stands, at 200 it turns the other way.
pub fn turn_together(motors: Motors, speed: i32, turn: i32, way: Way, halt: Halt) -> Command {
    let (code, length) = match way {
        Way::Degrees(degrees) => (STEP_SYNC, degrees),
        Way::Milliseconds(ms) => (TIME_SYNC, ms),
    };
    told(code, motors, &[speed, turn, length, halt as i32])
}

/// Where it is now is 0.
pub fn reset(motors: Motors) -> Command {
    let mut command = told(RESET, motors, &[]);
    command.then(&told(CLEAR_COUNT, motors, &[]));
    command
}
