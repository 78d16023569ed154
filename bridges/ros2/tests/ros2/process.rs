//! The bridge in a process of its own, as lrp has it.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{spawn, yield_now};

use lrp_bridge::{Call, Event, Form, Health, Item, Order, Output};
use serde_json::{Value, json};

use crate::peers;
use crate::programs::{library, lrp};
use crate::world::{Node, PATIENCE, enter};

/// The process that lrp would start.
pub struct Bridge {
    child: Child,
    orders: ChildStdin,
    lines: Receiver<String>,
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
        let (sender, lines) = channel();
        spawn(move || BufReader::new(events).lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let mut bridge = Bridge { child, orders, lines };
        bridge.order(&Order::Configure(Form { name: "robot".into(), config, folder: ".".into() }));
        while !matches!(bridge.event(), Event::State { state: Health::Up, .. }) {}
        bridge
    }

    pub fn order(&mut self, order: &Order) {
        writeln!(self.orders, "{}", serde_json::to_string(order).expect("an order")).expect("a bridge that listens");
    }

    fn item(&mut self, item: Item) {
        self.order(&Order::Send { items: vec![item] });
    }

    pub fn send(&mut self, output: &str, value: Value) {
        self.item(Item::Output(Output { output: output.into(), value }));
    }

    fn call(&mut self, call: &str, id: u64, argument: Value) {
        self.item(Item::Call(Call { call: call.into(), id, arguments: vec![argument] }));
    }

    fn line(&mut self) -> String {
        self.lines.recv_timeout(PATIENCE).expect("a bridge that speaks")
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

    /// Stops the process for a moment, until it joins again, and gives what it says of it. Some input must come often.
    fn hold_up(&mut self) -> String {
        let mut heard = 0;
        loop {
            match self.event() {
                Event::State { state: Health::Connecting, message } => return message.expect("why"),
                Event::Input { .. } => heard += 1,
                _ => continue,
            }
            // Again and again, in case that its threads are at work just then.
            if heard % 10 == 5 {
                self.signal("STOP");
                while !self.is_stopped() {
                    yield_now();
                }
                self.signal("CONT");
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
    node.tell(json!({ "do": "publish", "topic": "/n", "type": "std_msgs/msg/Int32", "value": { "data": 7 },
        "count": 6000, "rate": 50 }));
    node.tell(json!({ "do": "serve", "service": "/slow", "type": "std_srvs/srv/Trigger", "reply": {}, "delay": 60.0 }));
    node.tell(json!({ "do": "act", "action": "/count", "type": "test_msgs/action/Fibonacci", "how": "run",
        "feedback": [{ "sequence": [0] }], "steps": 6000 }));
    node.tell(json!({ "do": "subscribe", "topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist" }));
    let mut bridge = Bridge::start(json!({
        "subscribe": { "n": "/n" },
        "publish": { "move": "/cmd_vel geometry_msgs/msg/Twist" },
        "services": { "slow": { "service": "/slow", "type": "std_srvs/srv/Trigger", "timeout": 60000 } },
        "actions": { "count": "/count test_msgs/action/Fibonacci" },
        "interfaces": peers::share(),
    }));
    bridge.call("slow", 1, json!({}));
    bridge.call("count", 2, json!({ "order": 1 }));
    node.until("asked");
    while !matches!(bridge.event(), Event::Feedback { id: 2, .. }) {}
    bridge.send("move", json!({ "linear": { "x": 0.5 } }));
    node.until_where("heard", |heard| heard["value"]["linear"]["x"] == 0.5);
    let why = bridge.hold_up();
    assert_eq!(why, "joining again: this process was held up, and its network with it");
    let mut ended = BTreeMap::new();
    while ended.len() < 2 {
        if let Event::Reply { id, error, .. } = bridge.event() {
            ended.insert(id, error);
        }
    }
    assert_eq!(ended, BTreeMap::from([(1, Some(why.clone())), (2, Some(why))]));
    while !matches!(bridge.event(), Event::State { state: Health::Up, .. }) {}
    assert_eq!(bridge.input()["data"], 7);
    node.until("cancel");
    assert_eq!(node.until("heard")["value"]["linear"]["x"], 0.0);
}

/// Cyclone has the port that is kept from RustDDS.
#[test]
fn messages_are_not_to_be_sent_to_a_group_beside_cyclone_either() {
    let Some(()) = enter("process::messages_are_not_to_be_sent_to_a_group_beside_cyclone_either") else { return };
    let _cyclone = Node::of(peers::python("cyclone.py").expect("a peer").arg("driver"));
    let sockets = || std::fs::read_to_string("/proc/net/udp").expect("sockets").matches(":1CE9 ").count();
    let before = sockets();
    let _bridge = Bridge::start(json!({}));
    assert!(before > 0 && sockets() == before, "{before}, then {}", sockets());
}
