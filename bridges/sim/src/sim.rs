//! The simulator: commands in, program time on, readings out. It never looks at a clock; the same calls give the same readings.

use std::fmt;

use crate::body::Body;
use crate::geometry::Pose;
use crate::noise::{Channel, Noise, deviation};
use crate::world::World;
use crate::{robot, sensors};

/// Speeds asked of the robot: m/s forwards and rad/s counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist {
    pub linear: f64,
    pub angular: f64,
}

/// A command that was not taken because a speed in it is not a finite number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refused(Twist);

impl fmt::Display for Refused {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Twist { linear, angular } = self.0;
        write!(out, "the robot can't move at linear {linear} m/s, angular {angular} rad/s: both must be finite numbers")
    }
}

impl std::error::Error for Refused {}

/// The last command and when it lapses, µs.
#[derive(Debug, Clone)]
struct Command {
    twist: Twist,
    until: u64,
}

/// A robot driving in a world in program time, which begins at 0.
#[derive(Debug, Clone)]
pub struct Sim {
    world: World,
    noise: Noise,
    seed: u64,
    body: Body,
    command: Option<Command>,
    /// µs
    now: u64,
    /// Steps of motion done; `now` is less than one step later.
    ticks: u64,
}

impl Sim {
    /// A robot at rest at the start of `world`. `seed` chooses the noise.
    pub fn new(world: World, noise: Noise, seed: u64) -> Sim {
        let body = Body::at_rest(world.start());
        Sim { world, noise: noise.sensible(), seed, body, command: None, now: 0, ticks: 0 }
    }

    /// Moves on to the program time `t_us`, microseconds. How the way there is split into calls makes no difference.
    /// A time before the present is a clock that began anew: the robot stays where it is and its command lapses.
    pub fn advance_to(&mut self, t_us: u64) {
        let target = t_us / robot::STEP_US;
        if t_us < self.now {
            self.command = None;
            self.ticks = target;
        }
        while self.ticks < target {
            if self.rests() {
                self.ticks = target;
            } else {
                self.step();
            }
        }
        self.now = t_us;
    }

    /// Nothing moves and nothing will: the time may pass in one leap.
    fn rests(&self) -> bool {
        self.wanted() == STANDSTILL && self.body.linear == 0.0 && self.body.angular == 0.0
    }

    fn step(&mut self) {
        let Twist { linear, angular } = self.wanted();
        self.body.step(linear, angular, &self.world);
        self.ticks += 1;
    }

    /// The speeds of the command, while it is in force.
    fn wanted(&self) -> Twist {
        match &self.command {
            Some(command) if self.ticks * robot::STEP_US < command.until => command.twist,
            _ => STANDSTILL,
        }
    }

    /// Asks for speeds, for the next 0.5 s of program time. What is too fast is brought to the highest speed there is.
    ///
    /// # Errors
    /// A speed that is not a finite number is refused; the command before stays in force until it lapses.
    pub fn drive(&mut self, twist: Twist) -> Result<(), Refused> {
        if !twist.linear.is_finite() || !twist.angular.is_finite() {
            return Err(Refused(twist));
        }
        let twist = Twist {
            linear: twist.linear.clamp(-robot::MAX_LINEAR, robot::MAX_LINEAR),
            angular: twist.angular.clamp(-robot::MAX_ANGULAR, robot::MAX_ANGULAR),
        };
        self.command = Some(Command { twist, until: self.now.saturating_add(robot::DEAD_MAN_US) });
        Ok(())
    }

    /// Brakes to a halt, as fast as the robot can.
    pub fn halt(&mut self) {
        self.command = None;
    }

    /// Puts the robot, at rest, where it started. Time goes on.
    pub fn put_at_start(&mut self) {
        self.body = Body::at_rest(self.world.start());
        self.command = None;
    }

    /// Changes the world under the robot. It drives on where it is, unless the start was moved or a wall is in its place: then it is put at the start.
    pub fn replace_world(&mut self, world: World) {
        let stays = world.start() == self.world.start() && world.has_room_at(self.body.pose.place());
        self.world = world;
        if !stays {
            self.put_at_start();
        }
    }

    /// Changes the noise from now on.
    pub fn set_noise(&mut self, noise: Noise) {
        self.noise = noise.sensible();
    }

    pub fn world(&self) -> &World {
        &self.world
    }

    /// The robot's true pose.
    pub fn pose(&self) -> Pose {
        self.body.pose
    }

    /// Program time, µs.
    pub fn now_us(&self) -> u64 {
        self.now
    }

    /// The light sensor's reading: 0 dark to 255 bright.
    pub fn light(&self) -> u8 {
        let reading = sensors::light(&self.world, self.body.pose) + self.noise.light * self.deviation(Channel::Light);
        reading.round().clamp(0.0, 255.0) as u8
    }

    /// Whether a wall touches the bumper.
    pub fn bumper(&self) -> bool {
        sensors::bumper(&self.world, self.body.pose)
    }

    /// The range sensor's reading: m to the nearest wall ahead, at most [`robot::MAX_RANGE`].
    pub fn range(&self) -> f64 {
        let reading = sensors::range(&self.world, self.body.pose) + self.noise.range * self.deviation(Channel::Range);
        reading.clamp(0.0, robot::MAX_RANGE)
    }

    fn deviation(&self, channel: Channel) -> f64 {
        deviation(self.seed, self.ticks, channel)
    }
}

const STANDSTILL: Twist = Twist { linear: 0.0, angular: 0.0 };
