//! Calls that take their time: moves, which are over when their motors are still, and modes, once the sensor is in them.

use std::time::{Duration, Instant};

use lrp_bridge::{Level, Robot};
use serde_json::Value;

use crate::motor::Motors;
use crate::poll::World;
use crate::sensor::{self, Choice};

/// How long a motor may take to begin, from when the brick has the command.
const BEGIN: Duration = Duration::from_millis(100);

/// How long a sensor may take to change its mode.
const CHANGE: Duration = Duration::from_secs(3);

/// Moves under way.
#[derive(Default)]
pub struct Moves {
    moves: Vec<Move>,
}

struct Move {
    id: u64,
    motors: Motors,
    since: Instant,
    begun: bool,
}

impl Moves {
    pub fn begin(&mut self, id: u64, motors: Motors) {
        self.moves.push(Move { id, motors, since: Instant::now(), begun: false });
    }

    /// These motors are about something else now.
    pub fn overtake(&mut self, motors: Motors, robot: &Robot) {
        let fail = |ended: &Move| robot.reply(ended.id, Err("ended by a later command to its motor".to_string()));
        self.moves.extract_if(.., |one| one.motors.overlaps(motors)).for_each(|ended| fail(&ended));
    }

    /// The motors of a move that is given up.
    pub fn cancel(&mut self, id: u64) -> Option<Motors> {
        let at = self.moves.iter().position(|one| one.id == id)?;
        Some(self.moves.remove(at).motors)
    }

    /// What was read tells which are over.
    pub fn settle(&mut self, world: &World, robot: &Robot) {
        let busy = world.busy();
        for one in &mut self.moves {
            one.begun |= one.motors.overlaps(busy) || one.since.elapsed() >= BEGIN;
        }
        let over = self.moves.extract_if(.., |one| one.begun && !one.motors.overlaps(busy));
        over.for_each(|one| robot.reply(one.id, Ok(Value::Null)));
    }

    pub fn end(&mut self, why: &str, robot: &Robot) {
        self.moves.drain(..).for_each(|one| robot.reply(one.id, Err(why.to_string())));
    }
}

/// The modes that the sensors are to be in, also when they are plugged in anew.
#[derive(Default)]
pub struct Modes {
    wanted: [Option<Choice>; 4],
    /// Calls that wait for a mode.
    calls: Vec<Waiting>,
    /// What was said of each port, so that it is said once.
    said: [Option<String>; 4],
}

struct Waiting {
    id: u64,
    port: usize,
    since: Instant,
}

impl Modes {
    /// The form wants these. Where it says nothing new, what the program called stays.
    pub fn settle(&mut self, before: &[Option<Choice>; 4], now: &[Option<Choice>; 4]) {
        for port in 0..4 {
            if before[port] != now[port] {
                self.wanted[port] = now[port].clone();
            }
        }
    }

    pub fn want(&mut self, id: u64, port: usize, choice: Choice, robot: &Robot) {
        let overtaken = self.calls.extract_if(.., |call| call.port == port);
        overtaken.for_each(|call| robot.reply(call.id, Err("another mode is wanted by now".to_string())));
        self.wanted[port] = Some(choice);
        self.calls.push(Waiting { id, port, since: Instant::now() });
    }

    /// Whether a call that waits was given up. The mode is still wanted.
    pub fn cancel(&mut self, id: u64) -> bool {
        let waiting = self.calls.len();
        self.calls.retain(|call| call.id != id);
        self.calls.len() < waiting
    }

    /// The sensors that are to be put into another mode, and into which; answers calls that are done or can't be.
    pub fn due(&mut self, world: &World, robot: &Robot) -> Vec<(usize, u8)> {
        let mut due = Vec::new();
        for port in 0..4 {
            let seen = &world.sensors[port];
            let Some(choice) = self.wanted[port].as_ref().filter(|_| sensor::is_ready(seen.kind)) else { continue };
            match choice.on(seen.kind) {
                Ok(mode) if mode == seen.mode => self.answer(port, Ok(Value::Null), robot),
                Ok(mode) => due.push((port, mode)),
                Err(problem) => self.complain(port, problem, robot),
            }
        }
        self.give_up(world, robot);
        due
    }

    pub fn end(&mut self, why: &str, robot: &Robot) {
        self.calls.drain(..).for_each(|call| robot.reply(call.id, Err(why.to_string())));
    }

    fn complain(&mut self, port: usize, problem: String, robot: &Robot) {
        if self.said[port].as_ref() != Some(&problem) {
            robot.log(Level::Warn, format!("sensor{}: {problem}", port + 1));
            self.said[port] = Some(problem.clone());
        }
        self.answer(port, Err(problem), robot);
    }

    fn answer(&mut self, port: usize, result: Result<Value, String>, robot: &Robot) {
        let answered = self.calls.extract_if(.., |call| call.port == port);
        answered.for_each(|call| robot.reply(call.id, result.clone()));
    }

    fn give_up(&mut self, world: &World, robot: &Robot) {
        for call in self.calls.extract_if(.., |call| call.since.elapsed() >= CHANGE) {
            let seen = sensor::name(world.sensors[call.port].kind);
            robot.reply(call.id, Err(format!("port {} isn't in that mode yet; it has {seen}", call.port + 1)));
        }
    }
}
