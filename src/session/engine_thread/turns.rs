//! What the engine's thread does, turn by turn: obeys a command, makes the step that is due, hears the robots, passes the
//! records on.

use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::{Batch, End, Message, News, Pacing, locked};
use crate::model::{Edit, Program};
use crate::runtime::{Command, Record, What};
use crate::session::driver::Driver;
use crate::session::pace::{Due, Pace, Rate};
use crate::session::robots::Stopper;
use crate::session::trace::Clock;

const BATCH: Duration = Duration::from_millis(10);
/// Batches that may wait to be taken before the next step as fast as possible.
const PENDING: usize = 32;
const STATUS: Duration = Duration::from_millis(500);
/// While nothing steps, robots are heard this often.
const ATTEND: Duration = Duration::from_millis(50);
/// A step that is later than this: the process was stopped, or got no time to run, and what robots said meanwhile is
/// still to be read.
const HELD_UP: Duration = Duration::from_secs(1);
/// How long that may take. Until then no step is made, which would take what is long ago for what is now.
const CATCH_UP: Duration = Duration::from_millis(200);
/// How often a robot's clock is looked at for the next step.
const LOOK_AT_CLOCK: Duration = Duration::from_millis(2);

pub(super) struct Loop<'n, N: Fn(News)> {
    driver: Driver,
    pacing: Pacing,
    pace: Pace,
    stoppers: Arc<Mutex<Vec<Stopper>>>,
    /// The one that runs, for others to see.
    program: Arc<Mutex<Arc<Program>>>,
    news: &'n N,
    batch: Vec<Record>,
    pending: Arc<()>,
    flushed: Instant,
    started: Instant,
    /// Of a robot whose clock is followed, as last seen.
    robots_clock: Option<Duration>,
    /// No step is made before.
    caught_up: Instant,
    loaded: bool,
    /// The first program, until its robots are there or somebody wants it to begin without them.
    first: Option<Edit>,
    status: Status,
}

struct Status {
    since: Instant,
    steps: u64,
    late: Duration,
}

impl Status {
    fn new() -> Status {
        Status { since: Instant::now(), steps: 0, late: Duration::ZERO }
    }
}

impl<'n, N: Fn(News)> Loop<'n, N> {
    pub fn new(
        driver: Driver,
        pacing: Pacing,
        stoppers: Arc<Mutex<Vec<Stopper>>>,
        program: Arc<Mutex<Arc<Program>>>,
        news: &'n N,
    ) -> Self {
        let now = Instant::now();
        let pace = Pace::new(pacing.rate, Duration::ZERO);
        Loop {
            driver,
            pacing,
            pace,
            stoppers,
            program,
            news,
            batch: Vec::new(),
            pending: Arc::default(),
            flushed: now,
            started: now,
            robots_clock: None,
            caught_up: now,
            loaded: false,
            first: None,
            status: Status::new(),
        }
    }

    pub fn run(&mut self, inbox: &Receiver<Message>) -> End {
        loop {
            let end = match self.next(inbox) {
                Next::Message(Message::Command(command)) => {
                    self.command(command);
                    None
                }
                Next::Message(Message::End) => Some(End::Asked),
                Next::Step => self.step().then_some(End::TimeIsUp),
                Next::Nothing => None,
            };
            if !self.runs() {
                self.driver.attend(&mut |record| self.batch.push(record));
                self.begin_if_ready();
            }
            self.report_status();
            if end.is_some() || self.flushed.elapsed() >= BATCH {
                self.flush();
            }
            if let Some(end) = end {
                self.driver.stop("the end", &mut |record| self.batch.push(record));
                self.flush();
                return end;
            }
        }
    }

    fn next(&mut self, inbox: &Receiver<Message>) -> Next {
        let wait = match (self.runs(), self.pacing.clock) {
            (false, _) => ATTEND,
            (true, _) if self.is_ahead() => BATCH,
            (true, Clock::Virtual) => Duration::ZERO,
            (true, Clock::Real) => self.wait_for_step(),
        };
        if wait.is_zero() {
            return match inbox.try_recv() {
                Ok(message) => Next::Message(message),
                Err(TryRecvError::Empty) => Next::Step,
                Err(TryRecvError::Disconnected) => Next::Message(Message::End),
            };
        }
        self.flush();
        match inbox.recv_timeout(wait) {
            Ok(message) => Next::Message(message),
            Err(RecvTimeoutError::Timeout) if self.runs() && !self.is_ahead() && self.is_due() => Next::Step,
            Err(RecvTimeoutError::Timeout) => Next::Nothing,
            Err(RecvTimeoutError::Disconnected) => Next::Message(Message::End),
        }
    }

    fn wait_for_step(&mut self) -> Duration {
        let now = self.clock();
        let wait = self.pace.wait(now);
        // A robot's clock may run at any speed.
        if self.robots_clock.is_some() { wait.min(LOOK_AT_CLOCK) } else { wait }
    }

    /// After the time until the next step, unless that was only until a look at a robot's clock.
    fn is_due(&mut self) -> bool {
        self.robots_clock.is_none() || self.wait_for_step().is_zero()
    }

    /// Real time since the start; or that of a robot whose clock the program follows.
    fn clock(&mut self) -> Duration {
        let Some(now) = self.driver.robots_time() else { return self.started.elapsed() };
        // It begins to be followed, or was set back: program time goes on from where it is.
        if self.robots_clock.is_none_or(|before| now < before) {
            self.pace.resume(now);
        }
        self.robots_clock = Some(now);
        now
    }

    /// Whether it makes records faster than they are taken. Only real time waits for nobody.
    fn is_ahead(&self) -> bool {
        let hurries = self.pacing.clock == Clock::Virtual || self.pace.rate().hz() == 0.0;
        hurries && Arc::strong_count(&self.pending) > PENDING
    }

    fn runs(&self) -> bool {
        self.loaded && !self.driver.engine().is_paused()
    }

    /// The first program waits for its robots, whatever is edited meanwhile.
    fn begin_if_ready(&mut self) {
        if self.driver.is_ready()
            && let Some(first) = self.first.take()
        {
            self.obey(Command::Load(first));
        }
    }

    fn command(&mut self, command: Command) {
        match command {
            Command::Load(edit) if !self.loaded => {
                self.driver.prepare(&edit, &mut |record| self.batch.push(record));
                self.first = Some(edit);
                self.begin_if_ready();
            }
            Command::Resume if self.first.is_some() => {
                let first = self.first.take().map(Command::Load);
                first.into_iter().for_each(|load| self.obey(load));
            }
            command => self.obey(command),
        }
    }

    fn obey(&mut self, command: Command) {
        let real = self.clock();
        let loads = matches!(command, Command::Load(_) | Command::ApplyHeld);
        match &command {
            Command::Rate { hz } => match Rate::new(*hz) {
                Some(rate) => self.pace.set_rate(rate, real),
                None => return,
            },
            Command::Resume if self.driver.engine().is_paused() => {
                self.pace.resume(real);
                self.status = Status::new();
            }
            Command::Step if self.loaded && self.driver.engine().is_paused() => {
                let _ = self.driver.command(command, &mut |record| self.batch.push(record));
                let now = self.pace.make();
                self.driver.step(now, &mut |record| self.batch.push(record));
                return;
            }
            _ => {}
        }
        // A refusal is among the records.
        let _ = self.driver.command(command, &mut |record| self.batch.push(record));
        if loads {
            *locked(&self.stoppers) = self.driver.stoppers();
            *locked(&self.program) = Arc::clone(self.driver.engine().program());
            if !std::mem::replace(&mut self.loaded, true) {
                let now = self.clock();
                self.pace.resume(now);
                self.status = Status::new();
            }
            // Before a block of it can hold anything up.
            self.flush();
        }
    }

    /// Whether the run is over.
    fn step(&mut self) -> bool {
        let due = match self.pacing.clock {
            Clock::Virtual => Due { now: self.pace.make(), skipped: 0, late: Duration::ZERO },
            Clock::Real => {
                let now = self.clock();
                self.pace.take(now)
            }
        };
        if self.pacing.until.is_some_and(|until| due.now > until) {
            return true;
        }
        // A robot's clock may make any leap.
        if due.late > HELD_UP && self.robots_clock.is_none() {
            self.caught_up = Instant::now() + CATCH_UP;
        }
        let is_behind = Instant::now() < self.caught_up;
        let steps = due.skipped + u64::from(is_behind);
        let batch = &mut self.batch;
        if steps > 0 {
            self.driver.say(What::Skip { steps }, &mut |record| batch.push(record));
        }
        if is_behind {
            return false;
        }
        self.driver.step(due.now, &mut |record| batch.push(record));
        self.status.steps += 1;
        self.status.late = due.late;
        self.pacing.until == Some(due.now)
    }

    fn report_status(&mut self) {
        let since = self.status.since.elapsed();
        if self.pacing.clock == Clock::Virtual || since < STATUS {
            return;
        }
        let rate = self.status.steps as f64 / since.as_secs_f64();
        let round = |number: f64| (number * 10.0).round() / 10.0;
        let what = What::Status { rate: round(rate), late: round(self.status.late.as_secs_f64() * 1e3) };
        let batch = &mut self.batch;
        self.driver.say(what, &mut |record| batch.push(record));
        self.status = Status::new();
    }

    fn flush(&mut self) {
        if !self.batch.is_empty() {
            let (records, pending) = (std::mem::take(&mut self.batch), Arc::clone(&self.pending));
            (self.news)(News::Records(Batch { records, _pending: pending }));
        }
        self.flushed = Instant::now();
    }
}

enum Next {
    Message(Message),
    Step,
    Nothing,
}
