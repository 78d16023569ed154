//! The bridge in a process of its own, as lrp has it.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use lrp_bridge::{Event, Form, Health, Order};
use serde_json::{Value, json};

use crate::programs::{library, lrp};
use crate::world::{Node, enter};

/// The process that lrp would start.
pub struct Bridge {
    child: Child,
    orders: ChildStdin,
    events: BufReader<ChildStdout>,
}

impl Bridge {
    pub fn start(config: Value) -> Bridge {
        let mut child = Command::new(lrp())
            .arg("bridge-host")
            .arg(library())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the bridge");
        let (orders, events) = (child.stdin.take().expect("pipe"), child.stdout.take().expect("pipe"));
        let mut bridge = Bridge { child, orders, events: BufReader::new(events) };
        bridge.order(&Order::Configure(Form { name: "robot".into(), config, folder: ".".into() }));
        while !matches!(bridge.event(), Event::State { state: Health::Up, .. }) {}
        bridge
    }

    pub fn order(&mut self, order: &Order) {
        writeln!(self.orders, "{}", serde_json::to_string(order).expect("an order")).expect("a bridge that listens");
    }

    pub fn line(&mut self) -> String {
        let mut line = String::new();
        self.events.read_line(&mut line).expect("a bridge that speaks");
        line
    }

    pub fn event(&mut self) -> Event {
        serde_json::from_str(&self.line()).expect("an event")
    }

    pub fn input(&mut self) -> Value {
        loop {
            if let Event::Input { value, .. } = self.event() {
                return value;
            }
        }
    }

    fn signal(&self, name: &str) {
        let sent = Command::new("kill").args(["-s", name]).arg(self.child.id().to_string()).status().expect("kill");
        assert!(sent.success());
    }

    fn is_stopped(&self) -> bool {
        self.proc("stat").rsplit(')').next().is_some_and(|fields| fields.starts_with(" T"))
    }

    fn proc(&self, what: &str) -> String {
        std::fs::read_to_string(format!("/proc/{}/{what}", self.child.id())).expect("proc")
    }

    /// Seconds of processor time so far, and MB of memory.
    pub fn usage(&self) -> (f64, f64) {
        let stat = self.proc("stat");
        let fields: Vec<&str> = stat.rsplit(')').next().expect("fields").split_whitespace().collect();
        let ticks: f64 = [11, 12].iter().map(|at| fields[*at].parse::<f64>().expect("ticks")).sum();
        let status = self.proc("status");
        let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("memory");
        let resident: f64 = resident.trim().trim_end_matches(" kB").parse().expect("kB");
        (ticks / 100.0, resident / 1000.0)
    }
}

impl Drop for Bridge {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn who_was_held_up_joins_again() {
    let Some(()) = enter("process::who_was_held_up_joins_again") else { return };
    let mut node = Node::start("talker");
    let number = "std_msgs/msg/Int32";
    node.tell(
        json!({ "do": "publish", "topic": "/n", "type": number, "value": { "data": 7 }, "count": 1000, "rate": 50 }),
    );
    let mut bridge = Bridge::start(json!({ "subscribe": { "n": "/n" } }));
    let mut heard = 0;
    let why = loop {
        match bridge.event() {
            Event::State { state: Health::Connecting, message } => break message.expect("why"),
            Event::Input { .. } => heard += 1,
            _ => continue,
        }
        // Again and again, in case that its threads are at work just then.
        if heard % 10 == 5 {
            bridge.signal("STOP");
            while !bridge.is_stopped() {
                std::thread::yield_now();
            }
            bridge.signal("CONT");
        }
    };
    assert_eq!(why, "joining again: this process was held up, and its network with it");
    while !matches!(bridge.event(), Event::State { state: Health::Up, .. }) {}
    assert_eq!(bridge.input()["data"], 7);
}
