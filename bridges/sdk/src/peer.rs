//! lrp's side of the conversation, for tests of bridges: the bridge runs on a thread, orders go in, events come out.

use std::io::{BufRead, BufReader, PipeWriter, Write, pipe};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{JoinHandle, spawn};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::Bridge;
use crate::message::{Call, Event, Form, Health, Item, Order, Output};
use crate::offer::Description;
use crate::run::Conversation;

/// How long a test waits for an event before it fails.
const PATIENCE: Duration = Duration::from_secs(20);

pub struct Peer {
    orders: Option<PipeWriter>,
    events: Receiver<Event>,
    bridge: Option<JoinHandle<i32>>,
    calls: u64,
}

impl Peer {
    /// A bridge in this process. Panics, as all of these functions do, where the test can't go on.
    pub fn of<B: Bridge>() -> Peer {
        let (input, orders) = pipe().expect("a pipe");
        let (said, output) = pipe().expect("a pipe");
        let bridge = spawn(move || Conversation::new(|| ()).speak::<B>(input, output));
        let (sender, events) = channel();
        spawn(move || {
            for line in BufReader::new(said).lines() {
                let line = line.expect("the bridge's words");
                let event = serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line}"));
                if sender.send(event).is_err() {
                    break;
                }
            }
        });
        Peer { orders: Some(orders), events, bridge: Some(bridge), calls: 0 }
    }

    pub fn order(&mut self, order: Order) {
        self.line(&serde_json::to_string(&order).expect("an order"));
    }

    /// Whatever it may be.
    pub fn line(&mut self, line: &str) {
        writeln!(self.orders.as_mut().expect("an open conversation"), "{line}").expect("a bridge that listens");
    }

    pub fn configure(&mut self, config: Value) {
        self.order(Order::Configure(Form { name: "robot".into(), config, folder: ".".into() }));
    }

    pub fn send(&mut self, output: &str, value: Value) {
        self.order(Order::Send { items: vec![Item::Output(Output { output: output.into(), value })] });
    }

    /// Begins a call, and gives its id.
    pub fn call(&mut self, name: &str, arguments: Vec<Value>) -> u64 {
        self.calls += 1;
        let call = Call { call: name.into(), id: self.calls, arguments };
        self.order(Order::Send { items: vec![Item::Call(call)] });
        self.calls
    }

    /// The next event, whatever it is; none: nothing came in time.
    pub fn event(&mut self, patience: Duration) -> Option<Event> {
        self.events.recv_timeout(patience).ok()
    }

    /// The first thing found in the events to come; events before it are gone.
    pub fn until<T>(&mut self, what: &str, mut find: impl FnMut(&Event) -> Option<T>) -> T {
        let (end, mut seen) = (Instant::now() + PATIENCE, Vec::new());
        while let Some(event) = self.event(end.saturating_duration_since(Instant::now())) {
            if let Some(found) = find(&event) {
                return found;
            }
            seen.push(event);
        }
        panic!("no {what} came; these did: {seen:#?}")
    }

    pub fn until_up(&mut self) {
        self.until("`up`", |event| matches!(event, Event::State { state: Health::Up, .. }).then_some(()));
    }

    /// Why it is lost.
    pub fn until_lost(&mut self) -> String {
        self.until("`lost`", |event| match event {
            Event::State { state: Health::Lost, message } => Some(message.clone().unwrap_or_default()),
            _ => None,
        })
    }

    pub fn offer(&mut self) -> Description {
        self.until("offer", |event| match event {
            Event::Offer { description, problems } => {
                assert!(problems.is_empty(), "{problems:?}");
                Some(description.clone())
            }
            _ => None,
        })
    }

    /// The next message of an input.
    pub fn input(&mut self, wanted: &str) -> Value {
        self.until(&format!("input `{wanted}`"), |event| match event {
            Event::Input { name, value, .. } if name == wanted => Some(value.clone()),
            _ => None,
        })
    }

    /// The messages of an input until one is as wanted.
    pub fn input_where(&mut self, wanted: &str, fits: impl Fn(&Value) -> bool) -> Value {
        self.until(&format!("input `{wanted}` as wanted"), |event| match event {
            Event::Input { name, value, .. } if name == wanted && fits(value) => Some(value.clone()),
            _ => None,
        })
    }

    /// What became of a call.
    pub fn reply(&mut self, wanted: u64) -> Result<Value, String> {
        self.until(&format!("reply {wanted}"), |event| match event {
            Event::Reply { id, value, error: None } if *id == wanted => Some(Ok(value.clone())),
            Event::Reply { id, error: Some(error), .. } if *id == wanted => Some(Err(error.clone())),
            _ => None,
        })
    }

    /// Closes the conversation, as an lrp that is gone does, and gives the bridge's exit code.
    pub fn close(&mut self) -> i32 {
        self.orders = None;
        self.bridge.take().expect("not closed before").join().expect("a bridge that ends")
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(bridge) = self.bridge.take()
            && !std::thread::panicking()
        {
            let _ = bridge.join();
        }
    }
}
