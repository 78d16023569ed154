//! Keeps a bridge alive on a thread of its own: starts its process, notices when that hangs, crashes or talks nonsense,
//! says so, and starts it anew after a while; also when the plugin's file was built anew.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Form, Level, Order, PROTOCOL};

use super::Plugins;
use super::folders::{Folders, Plugin};
use super::incoming::Said;
use super::line::Line;
use super::process::{Heard, Process, how_it_ended};
use crate::runtime::record::Health;
use crate::session::watch::stamp::Stamp;

/// How long a bridge may take to say hello.
const HELLO: Duration = Duration::from_secs(10);
const PING_EVERY: Duration = Duration::from_secs(1);
/// How long a bridge may take to answer a ping before it counts as hung.
const ANSWER: Duration = Duration::from_secs(3);
/// How long it may take to stop its robot and end when it is told to.
const FAREWELL: Duration = Duration::from_millis(2500);
/// Between a loss and the next start: doubled each time, up to the second.
const BACK_OFF: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(10)];
/// A process that lived this long is no part of a series of losses.
const STEADY: Duration = Duration::from_secs(30);
const LAST_WORDS: Duration = Duration::from_millis(200);
const LOOK_EVERY: Duration = Duration::from_millis(500);
/// Lines that are no events, before the process counts as one that doesn't speak the protocol.
const GARBAGE: u32 = 100;
/// Lines of its standard error that go to the log, a second.
const COMPLAINTS: u32 = 10;
const NOTES: usize = 256;

/// Ends when dropped: the bridge stops its robot and goes.
pub struct Keeper {
    line: Arc<Line>,
    notes: SyncSender<Note>,
    thread: Option<JoinHandle<()>>,
}

enum Note {
    /// From the process with this number.
    Heard(u64, Heard),
    Form(Form),
    End,
}

impl Keeper {
    /// Fails only where no thread can be started.
    pub fn start(plugins: Plugins, kind: String, form: Form) -> std::io::Result<Keeper> {
        let (notes, inbox) = sync_channel(NOTES);
        let line = Arc::<Line>::default();
        let mut work = Work {
            line: Arc::clone(&line),
            plugins,
            kind,
            form,
            notes: notes.clone(),
            processes: 0,
            losses: 0,
            // What a bridge is from the moment it is made.
            heard_of: Some((Health::Connecting, None)),
        };
        let thread = Builder::new().name("bridge".into()).stack_size(256 << 10).spawn(move || work.run(&inbox))?;
        Ok(Keeper { line, notes, thread: Some(thread) })
    }

    pub fn line(&self) -> &Arc<Line> {
        &self.line
    }

    /// The form was edited.
    pub fn configure(&self, form: Form) {
        // A keeper that has ended has nothing to configure.
        let _ = self.notes.send(Note::Form(form));
    }

    /// Lets the bridge go without waiting for it; gives what to wait on before this process ends.
    pub fn end(mut self) -> Option<JoinHandle<()>> {
        self.thread.take().inspect(|_| drop(self.notes.send(Note::End)))
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = self.notes.send(Note::End);
            let _ = thread.join();
        }
    }
}

struct Work {
    line: Arc<Line>,
    plugins: Plugins,
    kind: String,
    form: Form,
    notes: SyncSender<Note>,
    /// Started so far.
    processes: u64,
    /// In a row.
    losses: u32,
    /// The last state told, so that the same isn't told again.
    heard_of: Option<(Health, Option<String>)>,
}

/// Why a process is no longer there.
enum Loss {
    /// Nobody needs it any more.
    Ended,
    /// The plugin's file is another one now.
    Rebuilt,
    /// It closed its output; how it ended is still to be learnt.
    Closed,
    Failed(String),
    /// Starting it again makes no difference before its file changes.
    Refused(String),
}

impl Work {
    fn run(&mut self, inbox: &Receiver<Note>) {
        loop {
            let (loss, stamp) = match self.plugins.folders.find(&self.kind) {
                Some(plugin) => {
                    let stamp = Stamp::of(&plugin.path);
                    (self.life(inbox, &plugin, stamp), Some((plugin.path, stamp)))
                }
                None => (Loss::Refused(missing(&self.kind, &self.plugins.folders)), None),
            };
            self.line.connect(None);
            let wait = match loss {
                Loss::Ended => return,
                Loss::Rebuilt => continue,
                Loss::Closed => Some(self.failed("it has closed its output")),
                Loss::Failed(why) => Some(self.failed(&why)),
                Loss::Refused(why) => {
                    self.tell(Health::Lost, Some(why));
                    None
                }
            };
            if self.wait(inbox, wait, stamp) == Wait::Ended {
                return;
            }
        }
    }

    /// How long to wait before it is started again.
    fn failed(&mut self, why: &str) -> Duration {
        let wait = (BACK_OFF[0] * 2u32.pow(self.losses.min(8))).min(BACK_OFF[1]);
        self.losses += 1;
        self.tell(Health::Lost, Some(format!("{why}; started again in {} s", wait.as_secs_f64())));
        wait
    }

    /// Until it is time to start again, or the plugin's file is another one.
    fn wait(
        &mut self,
        inbox: &Receiver<Note>,
        wait: Option<Duration>,
        known: Option<(PathBuf, Option<Stamp>)>,
    ) -> Wait {
        let until = wait.map(|wait| Instant::now() + wait);
        loop {
            let left =
                until.map_or(LOOK_EVERY, |until| until.saturating_duration_since(Instant::now()).min(LOOK_EVERY));
            match inbox.recv_timeout(left) {
                Ok(Note::End) | Err(RecvTimeoutError::Disconnected) => return Wait::Ended,
                Ok(Note::Form(form)) => self.form = form,
                Ok(Note::Heard(..)) => continue,
                Err(RecvTimeoutError::Timeout) => {}
            }
            let file = self.plugins.folders.find(&self.kind).map(|plugin| (Stamp::of(&plugin.path), plugin.path));
            let changed = file.map(|(stamp, path)| (path, stamp)) != known;
            if changed || until.is_some_and(|until| until <= Instant::now()) {
                return Wait::Over;
            }
        }
    }

    /// From the start of a process to its end.
    fn life(&mut self, inbox: &Receiver<Note>, plugin: &Plugin, stamp: Option<Stamp>) -> Loss {
        self.processes += 1;
        let (number, notes) = (self.processes, self.notes.clone());
        // When the keeper is gone, so is whoever would hear it.
        let heard = move |heard| drop(notes.send(Note::Heard(number, heard)));
        let line = Arc::clone(&self.line);
        let sorted = move |what: Heard| match what {
            Heard::Event(Event::Input { name, value, .. }, length) => line.incoming.input(name, value, length),
            Heard::Event(Event::Time { ms }, _) => line.incoming.time(ms),
            other => heard(other),
        };
        let process = match Process::start(plugin, &self.plugins.host, sorted) {
            Ok(process) => process,
            Err(error) => return Loss::Failed(format!("{} can't be started: {error}", plugin.path.display())),
        };
        let mut life = Life::new(process, plugin, stamp);
        let loss = life.last(self, inbox);
        if life.since.elapsed() >= STEADY {
            self.losses = 0;
        }
        life.end(loss, self, inbox)
    }

    fn tell(&mut self, state: Health, message: Option<String>) {
        let now = Some((state, message));
        if self.heard_of != now
            && let Some((state, message)) = now.clone()
        {
            self.line.incoming.say(Said::State { state, message });
            self.heard_of = now;
        }
    }

    fn log(&self, level: Level, message: String) {
        self.line.incoming.say(Said::Log { level, message, from: None });
    }
}

#[derive(PartialEq, Eq)]
enum Wait {
    Over,
    Ended,
}

/// `there is no bridge of kind `ev4``, and where one was looked for.
fn missing(kind: &str, folders: &Folders) -> String {
    let looked = folders.paths().iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ");
    format!("there is no bridge of kind `{kind}` in {looked}")
}

/// One process, from hello to goodbye.
struct Life {
    process: Process,
    path: PathBuf,
    stamp: Option<Stamp>,
    /// The file as it was last seen, where that is another one: taken up once it stays the same.
    seen: Option<Stamp>,
    since: Instant,
    greeted: bool,
    pings: u64,
    pinged: Instant,
    /// Since when an answer to a ping or a stop is due.
    unanswered: Option<Instant>,
    looked: Instant,
    garbage: u32,
    complaints: u32,
    /// For the report of its end.
    last_words: Option<String>,
}

impl Life {
    fn new(process: Process, plugin: &Plugin, stamp: Option<Stamp>) -> Life {
        let now = Instant::now();
        Life {
            process,
            path: plugin.path.clone(),
            stamp,
            seen: None,
            since: now,
            greeted: false,
            pings: 0,
            pinged: now,
            unanswered: None,
            looked: now,
            garbage: 0,
            complaints: 0,
            last_words: None,
        }
    }

    fn last(&mut self, work: &mut Work, inbox: &Receiver<Note>) -> Loss {
        work.tell(Health::Connecting, None);
        loop {
            let loss = match inbox.recv_timeout(LOOK_EVERY) {
                Ok(Note::End) | Err(RecvTimeoutError::Disconnected) => Some(Loss::Ended),
                Ok(Note::Form(form)) => {
                    work.form = form.clone();
                    if self.greeted {
                        self.process.orders().put(Order::Configure(form));
                    }
                    None
                }
                Ok(Note::Heard(number, heard)) if number == work.processes => self.hear(work, heard),
                Ok(Note::Heard(..)) | Err(RecvTimeoutError::Timeout) => None,
            };
            if let Some(loss) = loss.or_else(|| self.look()) {
                return loss;
            }
        }
    }

    fn hear(&mut self, work: &mut Work, heard: Heard) -> Option<Loss> {
        match heard {
            Heard::Event(Event::Hello { protocol, .. }, _) if !self.greeted => return self.hello(work, protocol),
            Heard::Event(..) if !self.greeted => {
                return Some(Loss::Refused("it doesn't begin with `hello`".to_string()));
            }
            Heard::Event(event, _) => self.event(work, event),
            Heard::Garbage(line) if !self.greeted => {
                return Some(Loss::Refused(format!("it doesn't speak lrp's protocol: `{line}`")));
            }
            Heard::Garbage(line) => {
                self.garbage += 1;
                match self.garbage {
                    1 => work.log(Level::Warn, format!("the bridge says what is no event: `{line}`")),
                    GARBAGE.. => return Some(Loss::Failed(format!("it says what is no event: `{line}`"))),
                    _ => {}
                }
            }
            Heard::TooLong => return Some(Loss::Failed("it says a line without an end".to_string())),
            Heard::Complaint(line) => {
                self.complaints += 1;
                if self.complaints <= COMPLAINTS {
                    work.log(Level::Debug, line.clone());
                }
                self.last_words = Some(line).filter(|line| !line.is_empty()).or(self.last_words.take());
            }
            Heard::Mute => {}
            Heard::Closed => return Some(Loss::Closed),
        }
        None
    }

    fn hello(&mut self, work: &mut Work, protocol: u32) -> Option<Loss> {
        if protocol != PROTOCOL {
            let which = if protocol > PROTOCOL { "update lrp" } else { "build it anew with this lrp's `lrp-bridge`" };
            return Some(Loss::Refused(format!(
                "{} speaks version {protocol} of the protocol, this lrp version {PROTOCOL}: {which}",
                self.path.display()
            )));
        }
        self.greeted = true;
        let orders = self.process.orders();
        orders.put(Order::Configure(work.form.clone()));
        orders.put(Order::Stop);
        work.line.connect(Some(Arc::clone(orders)));
        None
    }

    fn event(&mut self, work: &mut Work, event: Event) {
        let said = match event {
            Event::Offer { problems, .. } if !problems.is_empty() => Said::Problems(problems),
            Event::Offer { description, .. } => Said::Offer(description),
            Event::State { state, message } => return work.tell(state, message),
            Event::Reply { id, value, error } => Said::Reply { id, name: Arc::default(), done: true, value, error },
            Event::Feedback { id, value } => Said::Reply { id, name: Arc::default(), done: false, value, error: None },
            Event::Log { level, message, from } => Said::Log { level, message, from },
            Event::Found { found } => Said::Found(found),
            Event::Set { id, variable, value } => Said::Set { id, variable, value },
            Event::Dropped { what, count } => {
                let message = format!("{count} {what} were lost, as they came too fast");
                Said::Log { level: Level::Warn, message, from: None }
            }
            Event::Pong { .. } => {
                self.unanswered = None;
                return;
            }
            Event::Stopped | Event::Hello { .. } | Event::Input { .. } | Event::Time { .. } => return,
        };
        work.line.incoming.say(said);
    }

    /// What time alone brings to light.
    fn look(&mut self) -> Option<Loss> {
        let now = Instant::now();
        if !self.greeted {
            return (now - self.since > HELLO)
                .then(|| Loss::Failed(format!("it hasn't said hello within {} s", HELLO.as_secs())));
        }
        if self.unanswered.is_some_and(|since| now - since > ANSWER) {
            return Some(Loss::Failed(format!("it hangs: it hasn't answered for {} s", ANSWER.as_secs())));
        }
        if now - self.pinged >= PING_EVERY {
            self.pinged = now;
            self.pings += 1;
            self.complaints = 0;
            self.unanswered.get_or_insert(now);
            self.process.orders().put(Order::Ping { id: self.pings });
        }
        if now - self.looked >= LOOK_EVERY {
            self.looked = now;
            let stamp = Stamp::of(&self.path);
            // A file that is being written isn't taken up before it stays the same.
            if stamp.is_some() && stamp != self.stamp && std::mem::replace(&mut self.seen, stamp) == stamp {
                return Some(Loss::Rebuilt);
            }
        }
        None
    }

    /// Lets the process go: it stops its robot, unless it hangs.
    fn end(mut self, loss: Loss, work: &mut Work, inbox: &Receiver<Note>) -> Loss {
        self.process.close();
        let patience = if matches!(loss, Loss::Failed(_)) { FAREWELL / 10 } else { FAREWELL };
        match (loss, self.process.ended_within(patience)) {
            (Loss::Closed, Some(status)) => {
                self.listen_to_the_end(work, inbox);
                Loss::Failed(match self.last_words.take() {
                    Some(words) => format!("{}: {words}", how_it_ended(status)),
                    None => how_it_ended(status),
                })
            }
            (loss, _) => loss,
        }
    }

    /// What it complained of last may still be on its way.
    fn listen_to_the_end(&mut self, work: &mut Work, inbox: &Receiver<Note>) {
        while let Ok(note) = inbox.recv_timeout(LAST_WORDS) {
            match note {
                Note::Heard(number, Heard::Mute) if number == work.processes => return,
                Note::Heard(number, heard @ Heard::Complaint(_)) if number == work.processes => {
                    self.hear(work, heard);
                }
                Note::Heard(..) => {}
                Note::Form(form) => work.form = form,
                // Left to be found again.
                Note::End => return drop(work.notes.try_send(Note::End)),
            }
        }
    }
}
