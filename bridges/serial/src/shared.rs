//! What the bridge's thread, which sends, and the port's, which hears, have in common. Nothing is waited for under its
//! lock.

use std::io;
use std::sync::{Condvar, Mutex, MutexGuard};
use std::thread::sleep;
use std::time::{Duration, Instant};

use lrp_bridge::{Call, Found, Level, Robot};
use serde_json::Value;

use crate::codec::{Begun, Codec, Heard};
use crate::complaints::Complaints;
use crate::settings::{Line, Settings};
use crate::wire::Wire;

/// How long the last words may take where the robot doesn't read.
const LAST_WORDS: Duration = Duration::from_millis(300);
const TELL_DROPPED: Duration = Duration::from_secs(1);

const NOT_THERE: &str = "the robot isn't there";

pub struct Shared {
    pub robot: Robot,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    settings: Settings,
    codec: Box<dyn Codec>,
    wire: Option<Wire>,
    /// The robot said that it listens.
    is_up: bool,
    /// The port is to be opened anew, since it is another.
    is_moved: bool,
    is_over: bool,
    unreadable: Complaints,
    unsendable: Complaints,
    dropped: u64,
    told_dropped: Instant,
    fields: Vec<Found>,
}

/// Why a visit to a port ends.
#[derive(Debug, PartialEq)]
pub enum End {
    /// The form names another one.
    Moved,
    Over,
    Lost(String),
}

impl Shared {
    pub fn new(settings: Settings, robot: Robot) -> Shared {
        let state = State {
            codec: settings.protocol.codec(),
            settings,
            wire: None,
            is_up: false,
            is_moved: false,
            is_over: false,
            unreadable: Complaints::default(),
            unsendable: Complaints::default(),
            dropped: 0,
            told_dropped: Instant::now(),
            fields: Vec::new(),
        };
        Shared { robot, state: Mutex::new(state), changed: Condvar::new() }
    }

    pub fn configure(&self, settings: Settings) {
        let mut state = self.state();
        let adopted = state.codec.adopt(&settings.protocol);
        match adopted {
            Some(bytes) => state.push(bytes),
            None => {
                state.halt();
                state.end_calls("the form was edited", &self.robot);
                state.codec = settings.protocol.codec();
                state.is_up = false;
                state.is_moved = true;
            }
        }
        if settings.line != state.settings.line {
            state.halt();
            state.is_up = false;
            state.is_moved = true;
        }
        state.settings = settings;
        drop(state);
        self.changed.notify_all();
    }

    pub fn send(&self, output: &str, message: &Value) {
        let mut state = self.state();
        // lrp knows that it isn't, and counts.
        if !state.is_up {
            return;
        }
        match state.codec.send(output, message) {
            Ok(bytes) => {
                if let Some(wire) = &mut state.wire {
                    wire.output(output, bytes);
                }
            }
            Err(why) => state.unsendable.note(format!("`{output}` wasn't sent: {why}")),
        }
    }

    pub fn call(&self, call: &Call) {
        let mut state = self.state();
        let result = match state.is_up {
            true => state.codec.call(call, Instant::now()),
            false => Err(NOT_THERE.into()),
        };
        match result {
            Err(why) => self.robot.reply(call.id, Err(why)),
            Ok(Begun { bytes, waits }) => match (state.say(bytes), waits) {
                (true, true) => {}
                (true, false) => self.robot.reply(call.id, Ok(Value::Null)),
                (false, _) => {
                    state.codec.cancel(call.id);
                    self.robot.reply(call.id, Err("the robot doesn't take what is sent to it".into()));
                }
            },
        }
    }

    pub fn cancel(&self, id: u64) {
        self.state().codec.cancel(id);
    }

    pub fn flush(&self) {
        // A port that fails is noticed where it is read.
        let _ = self.state().write();
    }

    pub fn stop(&self) {
        let mut state = self.state();
        state.halt();
        state.end_calls("stopped", &self.robot);
    }

    /// Waits, though not for long, until everything is written, and has the port's thread end.
    pub fn end(&self) {
        let until = Instant::now() + LAST_WORDS;
        while self.state().has_words_left() && Instant::now() < until {
            sleep(Duration::from_millis(2));
        }
        self.state().is_over = true;
        self.changed.notify_all();
    }

    /// The line to visit; none: it is over.
    pub fn line(&self) -> Option<Line> {
        let mut state = self.state();
        state.is_moved = false;
        (!state.is_over).then(|| state.settings.line.clone())
    }

    /// Waits until it is time to try again, or the form was edited.
    pub fn pause(&self, pause: Duration) {
        let state = self.state();
        let goes_on = |state: &mut State| !state.is_over && !state.is_moved;
        let _ = self.changed.wait_timeout_while(state, pause, goes_on);
    }

    pub fn opened(&self, wire: Wire) {
        let mut state = self.state();
        state.wire = Some(wire);
        let first = state.codec.open(Instant::now());
        state.push(first);
        let _ = state.write();
    }

    pub fn closed(&self) {
        let mut state = self.state();
        state.wire = None;
        state.is_up = false;
        state.end_calls("the robot was lost", &self.robot);
    }

    /// What came in, perhaps nothing; and whether the visit is over.
    pub fn hear(&self, bytes: &[u8]) -> Option<End> {
        let mut state = self.state();
        let now = Instant::now();
        let mut heard = if bytes.is_empty() { Vec::new() } else { state.codec.hear(bytes, now) };
        heard.extend(state.codec.tick(now));
        let lost = heard.into_iter().filter_map(|heard| state.take(heard, &self.robot)).last();
        let write = state.write();
        state.complain(now, &self.robot);
        match (lost, write) {
            _ if state.is_over => Some(End::Over),
            _ if state.is_moved => Some(End::Moved),
            (Some(why), _) => Some(End::Lost(why)),
            (None, Err(error)) => Some(End::Lost(format!("it can't be written to any more: {error}"))),
            (None, Ok(())) => None,
        }
    }

    pub fn is_up(&self) -> bool {
        self.state().is_up
    }

    /// Tells what there is beside the messages: ports, and fields that no input takes.
    pub fn tell_found(&self, ports: Vec<Found>) {
        let fields = self.state().fields.clone();
        self.robot.found(ports.into_iter().chain(fields).collect());
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl State {
    /// Why the connection is given up, if it is.
    fn take(&mut self, heard: Heard, robot: &Robot) -> Option<String> {
        match heard {
            Heard::Ready => {
                if self.is_up {
                    robot.log(Level::Warn, "the robot began anew: it is stopped first");
                }
                // Behind what sets it up.
                let stop = self.codec.stop();
                if let Some(wire) = &mut self.wire {
                    wire.forget_outputs();
                }
                self.push(stop);
                self.is_up = true;
                robot.up();
            }
            Heard::Input(name, value) => robot.input(&name, value),
            Heard::Reply(id, result) => robot.reply(id, result),
            Heard::Unreadable(what) => self.unreadable.note(what),
            Heard::Fields(fields) => {
                self.fields = fields;
                robot.found(crate::port::found().into_iter().chain(self.fields.clone()).collect());
            }
            Heard::Log(level, message) => robot.log_from("robot", level, message),
            Heard::Send(bytes) => self.push(bytes),
            Heard::Lost(why) => return Some(why),
        }
        None
    }

    fn push(&mut self, bytes: Vec<u8>) {
        if let Some(wire) = &mut self.wire {
            wire.push(None, bytes);
        }
    }

    /// Whether there was room for it.
    fn say(&mut self, bytes: Vec<u8>) -> bool {
        self.wire.as_mut().is_none_or(|wire| wire.put(None, bytes))
    }

    fn write(&mut self) -> io::Result<()> {
        self.wire.as_mut().map_or(Ok(()), Wire::write)
    }

    fn halt(&mut self) {
        let (cut, bytes) = (self.codec.end_of_message(), self.codec.stop());
        if let Some(wire) = &mut self.wire {
            let _ = wire.stop(cut, bytes);
        }
    }

    fn end_calls(&mut self, why: &str, robot: &Robot) {
        for id in self.codec.forget_calls() {
            robot.reply(id, Err(why.to_string()));
        }
    }

    fn has_words_left(&mut self) -> bool {
        let failed = self.write().is_err();
        !failed && self.wire.as_ref().is_some_and(|wire| !wire.is_idle())
    }

    fn complain(&mut self, now: Instant, robot: &Robot) {
        let complaints = [self.unreadable.take(now), self.unsendable.take(now)];
        complaints.into_iter().flatten().for_each(|complaint| robot.log(Level::Warn, complaint));
        self.dropped += self.wire.as_mut().map_or(0, Wire::take_dropped);
        if self.dropped > 0 && now.duration_since(self.told_dropped) >= TELL_DROPPED {
            robot.dropped("outputs", std::mem::take(&mut self.dropped));
            self.told_dropped = now;
        }
    }
}
