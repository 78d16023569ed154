//! One process of a bridge while it lasts: greets it, obeys its keeper, notices when it hangs, ends or talks nonsense.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Level, Order, PROTOCOL};

use super::folders::Plugin;
use super::incoming::Said;
use super::keeper::{LOOK_EVERY, Loss, Note, Work};
use super::process::{Heard, Process, how_it_ended};
use crate::runtime::record::Health;
use crate::session::robots::Halt;
use crate::session::watch::stamp::Stamp;

/// How long a bridge may take to say hello.
const HELLO: Duration = Duration::from_secs(10);
const PING_EVERY: Duration = Duration::from_secs(1);
/// How long a bridge may take to answer a ping before it counts as hung.
const ANSWER: Duration = Duration::from_secs(3);
/// How long it may take to stop its robot and end when it is told to.
const FAREWELL: Duration = Duration::from_millis(2500);
const LAST_WORDS: Duration = Duration::from_millis(200);
/// Longer than any time between two looks, unless this process was stopped, or gets no time to run.
const HELD_UP: Duration = Duration::from_secs(1);
/// Lines that are no events, before the process counts as one that doesn't speak the protocol.
const GARBAGE: u32 = 100;
/// Lines of its standard error that go to the log, a second.
const COMPLAINTS: u32 = 10;

/// One process, from hello to goodbye.
pub(super) struct Life {
    process: Process,
    path: PathBuf,
    stamp: Option<Stamp>,
    /// The file as it was last seen, where that is another one: taken up once it stays the same.
    seen: Option<Stamp>,
    pub since: Instant,
    greeted: bool,
    pings: u64,
    pinged: Instant,
    /// Since when an answer to a ping or a stop is due.
    unanswered: Option<Instant>,
    looked: Instant,
    /// When that was last asked: a long time ago means that this process was held up.
    awake: Instant,
    garbage: u32,
    complaints: u32,
    /// For the report of its end.
    last_words: Option<String>,
}

impl Life {
    pub fn new(process: Process, plugin: &Plugin, stamp: Option<Stamp>) -> Life {
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
            awake: now,
            garbage: 0,
            complaints: 0,
            last_words: None,
        }
    }

    /// Until it has to go.
    pub fn last(&mut self, work: &mut Work, inbox: &Receiver<Note>) -> Loss {
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
        work.line.connect(Some(Arc::clone(orders)));
        work.line.halt();
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
            Event::Stopped => return work.line.stopped(),
            Event::Hello { .. } | Event::Input { .. } | Event::Time { .. } => return,
        };
        work.line.incoming.say(said);
    }

    /// What time alone brings to light.
    fn look(&mut self) -> Option<Loss> {
        let now = Instant::now();
        self.pardon(now);
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

    /// While this process was held up, nobody could hear what the bridge answered.
    fn pardon(&mut self, now: Instant) {
        let passed = now - std::mem::replace(&mut self.awake, now);
        if passed > HELD_UP {
            self.since += passed;
            self.unanswered = self.unanswered.map(|since| since + passed);
        }
    }

    /// Lets the process go: it stops its robot, unless it hangs.
    pub fn end(mut self, loss: Loss, work: &mut Work, inbox: &Receiver<Note>) -> Loss {
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
