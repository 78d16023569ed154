//! A brick that is connected: reads it at its rate, carries out what waits, and answers the calls.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use lrp_bridge::Robot;
use serde_json::Value;

use crate::command::Command;
use crate::desk::{Desk, Job, Next};
use crate::discovery::Discovery;
use crate::inputs;
use crate::link::{Link, Trouble};
use crate::motor::{self, Halt, Motor, Motors};
use crate::moves::{Modes, Moves};
use crate::orders::{self, Deed, Motion};
use crate::poll::{self, Poll, World};
use crate::settings::Settings;

/// The most operations, in bytes, that go into one frame.
const FULL: usize = 900;

/// How long sensors may take to come into their modes at the beginning.
const SETTLE: Duration = Duration::from_millis(100);

pub struct Visit<'a> {
    desk: &'a Desk,
    robot: &'a Robot,
    settings: &'a mut Settings,
    modes: &'a mut Modes,
    pub discovery: Option<&'a mut Discovery>,
    link: Link,
    world: World,
    moves: Moves,
    /// When everything is read next.
    due: Instant,
    /// Whether nothing was sent to a motor since everything was read.
    fresh: bool,
    /// What is being carried out.
    jobs: VecDeque<Job>,
    batch: Batch,
}

/// Commands on their way in one frame, and the calls they are for, in order.
#[derive(Default)]
struct Batch {
    command: Command,
    calls: Vec<Begun>,
}

struct Begun {
    id: u64,
    motors: Motors,
    /// Whether the call is over when its motors are still, or when the brick has it.
    moves: bool,
}

impl<'a> Visit<'a> {
    pub fn new(
        desk: &'a Desk,
        robot: &'a Robot,
        settings: &'a mut Settings,
        modes: &'a mut Modes,
        link: Link,
    ) -> Visit<'a> {
        Visit {
            desk,
            robot,
            settings,
            modes,
            discovery: None,
            link,
            world: World::default(),
            moves: Moves::default(),
            due: Instant::now(),
            fresh: false,
            jobs: VecDeque::new(),
            batch: Batch::default(),
        }
    }

    /// Halts the brick, whatever it was about, and reads it twice: the first time puts the sensors into their modes, and
    /// a program that begins when the robot is up finds everything read.
    pub fn begin(&mut self) -> Result<(), Trouble> {
        self.link.ask(&orders::full_stop())?;
        self.poll()?;
        std::thread::sleep(SETTLE);
        self.poll()
    }

    /// Until it is over, or the form names another brick.
    pub fn serve(&mut self) -> Result<(), Trouble> {
        loop {
            match self.desk.next(self.due) {
                Next::Halt => self.halt()?,
                Next::Poll => self.poll()?,
                Next::Jobs(jobs) => {
                    self.jobs.extend(jobs);
                    self.carry_out()?;
                }
                Next::Cancel(ids) => ids.into_iter().try_for_each(|id| self.cancel(id))?,
                Next::Settings(settings) => {
                    let moved = settings.place != self.settings.place;
                    self.modes.settle(&self.settings.modes, &settings.modes);
                    *self.settings = settings;
                    if moved {
                        self.link.ask(&orders::full_stop())?;
                        return Ok(());
                    }
                }
                Next::Close => return Ok(()),
            }
        }
    }

    /// It is over: whoever waits is told why. Somebody waiting for a halt still gets it sent, though nobody will answer.
    pub fn end(mut self, why: &str) {
        if self.desk.wants_halt() {
            let _ = self.link.send(&orders::full_stop());
        }
        self.undo(why);
        let undone = self.desk.lost().into_iter();
        undone.for_each(|job| self.robot.reply(job.id, Err(why.to_string())));
        self.moves.end(why, self.robot);
        self.modes.end(why, self.robot);
    }

    fn halt(&mut self) -> Result<(), Trouble> {
        self.link.ask(&orders::full_stop())?;
        self.moves.end("stopped", self.robot);
        self.desk.halted();
        Ok(())
    }

    /// What is not with the brick yet won't be.
    fn undo(&mut self, why: &str) {
        let begun = std::mem::take(&mut self.batch).calls.into_iter().map(|call| call.id);
        let waiting = self.jobs.drain(..).map(|job| job.id);
        begun.chain(waiting).for_each(|id| self.robot.reply(id, Err(why.to_string())));
    }

    fn poll(&mut self) -> Result<(), Trouble> {
        let poll = Poll::after(&self.world);
        self.world = poll.read(&self.link.ask(&poll.command)?);
        self.fresh = true;
        self.due = (self.due + self.settings.period()).max(Instant::now() + Duration::from_millis(1));
        for (name, message) in inputs::messages(&self.world, self.settings) {
            self.robot.input(&name, message);
        }
        self.moves.settle(&self.world, self.robot);
        let modes = self.modes.due(&self.world, self.robot);
        if !modes.is_empty() && !self.desk.wants_halt() {
            self.link.ask(&poll::set_modes(modes.into_iter()))?;
        }
        self.look_round();
        Ok(())
    }

    /// Bricks come and go meanwhile.
    fn look_round(&mut self) {
        if let Some(discovery) = &mut self.discovery
            && discovery.catch_up().is_ok()
            && let Some(found) = discovery.news()
        {
            self.robot.found(found);
        }
    }

    fn cancel(&mut self, id: u64) -> Result<(), Trouble> {
        let moving = self.moves.cancel(id);
        if moving.is_some() || self.modes.cancel(id) {
            self.robot.reply(id, Err("cancelled".to_string()));
        }
        moving.map_or(Ok(()), |motors| self.link.ask(&motor::stop(motors, Halt::Brake)).map(|_| ()))
    }

    /// What waits goes in one frame, so that what a program sends in one step leaves together. A halt waits for one
    /// frame at most.
    fn carry_out(&mut self) -> Result<(), Trouble> {
        self.fresh = false;
        while let Some(job) = self.jobs.front().cloned() {
            if self.desk.wants_halt() {
                self.undo("stopped");
            } else if let Deed::MoveTo { motor, .. } = job.deed
                && self.batch.is_about(motor)
            {
                self.flush()?;
            } else if let Deed::MoveTo { .. } = job.deed
                && !self.fresh
            {
                self.poll()?;
            } else {
                self.begin_job(job)?;
                self.jobs.pop_front();
            }
        }
        self.flush()
    }

    fn begin_job(&mut self, Job { id, deed }: Job) -> Result<(), Trouble> {
        match deed {
            Deed::Send { command, motors } => self.add(&command, Begun { id, motors, moves: false })?,
            Deed::Move { command, motors } => self.add(&command, Begun { id, motors, moves: true })?,
            Deed::MoveTo { motor, position, motion } => self.move_to(id, motor, position, motion)?,
            Deed::Mode { port, choice } => {
                self.modes.want(id, port, choice, self.robot);
                self.due = Instant::now();
            }
            Deed::Nothing => self.robot.reply(id, Ok(Value::Null)),
        }
        Ok(())
    }

    /// From where the motor was read to be.
    fn move_to(&mut self, id: u64, motor: Motor, position: i32, motion: Motion) -> Result<(), Trouble> {
        let Some(seen) = self.world.motors[motor.index()].position else {
            self.robot.reply(id, Err(format!("the brick doesn't know where motor {} is", motor.letter())));
            return Ok(());
        };
        let distance = position.saturating_sub(self.settings.sign(motor) * seen);
        match orders::way_to(motor, distance, motion, self.settings) {
            Some(command) => self.add(&command, Begun { id, motors: motor.into(), moves: true })?,
            None => self.robot.reply(id, Ok(Value::Null)),
        }
        Ok(())
    }

    fn add(&mut self, command: &Command, call: Begun) -> Result<(), Trouble> {
        if self.batch.command.ops().len() + command.ops().len() > FULL {
            self.flush()?;
        }
        self.batch.command.then(command);
        self.batch.calls.push(call);
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Trouble> {
        if self.desk.wants_halt() {
            self.undo("stopped");
        }
        if self.batch.calls.is_empty() {
            return Ok(());
        }
        self.fresh = false;
        let refused = match self.link.ask(&self.batch.command) {
            Ok(_) => None,
            Err(Trouble::Refused) => Some(Trouble::Refused.to_string()),
            Err(trouble) => return Err(trouble),
        };
        for call in std::mem::take(&mut self.batch).calls {
            match &refused {
                Some(why) => self.robot.reply(call.id, Err(why.clone())),
                None => self.begun(call),
            }
        }
        Ok(())
    }

    /// The brick has a call's command.
    fn begun(&mut self, call: Begun) {
        self.moves.overtake(call.motors, self.robot);
        match call.moves {
            true => self.moves.begin(call.id, call.motors),
            false => self.robot.reply(call.id, Ok(Value::Null)),
        }
    }
}

impl Batch {
    fn is_about(&self, motor: Motor) -> bool {
        self.calls.iter().any(|call| call.motors.has(motor))
    }
}
