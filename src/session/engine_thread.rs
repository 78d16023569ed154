//! The thread that owns the engine: paces it by the clock, takes commands between steps, passes records on in batches.

use std::ops::Deref;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::driver::Driver;
use super::pace::{Due, Pace, Rate};
use super::robots::{Stopper, Workshop};
use super::trace::Clock;
use super::warden::Warden;
use crate::model::{Edit, Program};
use crate::runtime::{Command, Options, Record, Time, What};

#[derive(Clone, Debug)]
pub struct Pacing {
    pub rate: Rate,
    pub clock: Clock,
    /// Program time after which the run is over.
    pub until: Option<Time>,
}

/// Records that came together. The thread that steps as fast as it can waits for those who take them.
pub struct Batch {
    records: Vec<Record>,
    _pending: Arc<()>,
}

impl Deref for Batch {
    type Target = [Record];

    fn deref(&self) -> &[Record] {
        &self.records
    }
}

/// What comes out of the thread.
pub enum News {
    Records(Batch),
    /// A block can't be stopped: the engine waits for it, the robots were halted.
    Stuck,
    /// The run is over, or the engine can't go on.
    Ended(End),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    TimeIsUp,
    Asked,
    /// A mistake in lrp itself; the robots were stopped.
    Failed(String),
}

enum Message {
    Command(Command),
    End,
}

/// The way to an engine's thread, from any other.
#[derive(Clone)]
pub struct Commands {
    messages: Sender<Message>,
    stoppers: Arc<Mutex<Vec<Stopper>>>,
    program: Arc<Mutex<Arc<Program>>>,
}

impl Commands {
    pub fn send(&self, command: Command) {
        if command == Command::Runstop {
            self.halt();
        }
        // A thread that has ended has stopped its robots and said so.
        let _ = self.messages.send(Message::Command(command));
    }

    /// The program that runs, as of the last load: an edit can be compared with it beforehand.
    pub fn running(&self) -> Arc<Program> {
        Arc::clone(&locked(&self.program))
    }

    /// Halts every robot at once, without asking the engine.
    pub fn halt(&self) {
        halt(&self.stoppers);
    }
}

pub struct EngineThread {
    commands: Commands,
    thread: Option<JoinHandle<()>>,
    /// Closed when the thread has ended.
    ended: Receiver<()>,
}

const BATCH: Duration = Duration::from_millis(10);
/// Batches that may wait to be taken before the next step as fast as possible.
const PENDING: usize = 32;
/// How long the thread may take to end, once the robots are halted. A block that can't be stopped would take for ever.
const END: Duration = Duration::from_secs(5);
const STATUS: Duration = Duration::from_millis(500);
/// While nothing steps, robots are heard this often.
const ATTEND: Duration = Duration::from_millis(50);

/// Gives a required Lua module's text, or why there is none.
pub type Library = Box<dyn Fn(&str) -> Result<String, String> + Send>;

impl EngineThread {
    pub fn start(
        options: Options,
        workshop: Workshop,
        library: Library,
        pacing: Pacing,
        news: impl Fn(News) + Clone + Send + 'static,
    ) -> Self {
        let (messages, inbox) = channel();
        let stoppers: Arc<Mutex<Vec<Stopper>>> = Arc::default();
        let shared = Arc::clone(&stoppers);
        let program: Arc<Mutex<Arc<Program>>> = Arc::default();
        let published = Arc::clone(&program);
        let (alive, ended) = channel();
        let body = move || {
            let _alive: Sender<()> = alive;
            let run = AssertUnwindSafe(|| {
                let mut driver = Driver::new(options, workshop);
                driver.engine_mut().library(library);
                let (stoppers, tell) = (Arc::clone(&shared), news.clone());
                let _warden = Warden::watch(driver.engine().emergency(), move || {
                    halt(&stoppers);
                    tell(News::Stuck);
                });
                Loop::new(driver, pacing, Arc::clone(&shared), published, &news).run(&inbox)
            });
            let end = catch_unwind(run).unwrap_or_else(|panic| {
                halt(&shared);
                End::Failed(panic_text(&*panic))
            });
            news(News::Ended(end));
        };
        let thread =
            std::thread::Builder::new().name("engine".to_string()).spawn(body).expect("a thread can be started");
        EngineThread { commands: Commands { messages, stoppers, program }, thread: Some(thread), ended }
    }

    pub fn commands(&self) -> &Commands {
        &self.commands
    }
}

impl Drop for EngineThread {
    fn drop(&mut self) {
        self.commands.halt();
        let _ = self.commands.messages.send(Message::End);
        if self.ended.recv_timeout(END) == Err(RecvTimeoutError::Disconnected)
            && let Some(thread) = self.thread.take()
        {
            let _ = thread.join();
        }
    }
}

fn halt(stoppers: &Mutex<Vec<Stopper>>) {
    for stop in locked(stoppers).iter() {
        stop();
    }
}

fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_else(|| "unknown".to_string())
}

struct Loop<'n, N: Fn(News)> {
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
    fn new(
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
            loaded: false,
            first: None,
            status: Status::new(),
        }
    }

    fn run(&mut self, inbox: &Receiver<Message>) -> End {
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
            (true, Clock::Real) => self.pace.wait(self.started.elapsed()),
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
            Err(RecvTimeoutError::Timeout) if self.runs() && !self.is_ahead() => Next::Step,
            Err(RecvTimeoutError::Timeout) => Next::Nothing,
            Err(RecvTimeoutError::Disconnected) => Next::Message(Message::End),
        }
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
        let real = self.started.elapsed();
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
                self.pace.resume(self.started.elapsed());
            }
            // Before a block of it can hold anything up.
            self.flush();
        }
    }

    /// Whether the run is over.
    fn step(&mut self) -> bool {
        let due = match self.pacing.clock {
            Clock::Virtual => Due { now: self.pace.make(), skipped: 0, late: Duration::ZERO },
            Clock::Real => self.pace.take(self.started.elapsed()),
        };
        if self.pacing.until.is_some_and(|until| due.now > until) {
            return true;
        }
        let batch = &mut self.batch;
        if due.skipped > 0 {
            self.driver.say(What::Skip { steps: due.skipped }, &mut |record| batch.push(record));
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
