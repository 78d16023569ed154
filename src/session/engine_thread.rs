//! The thread that owns the engine: paces it by the clock, takes commands between steps, passes records on in batches.

mod turns;

use std::ops::Deref;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use self::turns::Loop;
use super::driver::Driver;
use super::pace::Rate;
use super::robots::{Stopper, Workshop};
use super::trace::Clock;
use super::warden::Warden;
use crate::model::Program;
use crate::runtime::{Command, Options, Record, Time};

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

    /// Does something, as stopping this process, while every robot stands still, which it waits for, though not for long.
    /// Nothing that the program sends meanwhile reaches them.
    pub fn at_rest<T>(&self, body: impl FnOnce() -> T) -> T {
        let stoppers = locked(&self.stoppers).clone();
        stoppers.iter().for_each(|robot| robot.hold());
        let until = Instant::now() + REST;
        stoppers.iter().for_each(|robot| robot.wait(until));
        let result = body();
        stoppers.iter().for_each(|robot| robot.release());
        result
    }
}

/// How long robots may take to say that they stand still.
const REST: Duration = Duration::from_secs(1);

pub struct EngineThread {
    commands: Commands,
    thread: Option<JoinHandle<()>>,
    /// Closed when the thread has ended.
    ended: Receiver<()>,
}

/// How long the thread may take to end, once the robots are halted. A block that can't be stopped would take for ever.
const END: Duration = Duration::from_secs(5);

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
    locked(stoppers).iter().for_each(|robot| robot.halt());
}

fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_else(|| "unknown".to_string())
}
