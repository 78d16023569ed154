//! What the bridge costs, measured against rclpy: `cargo test --release --workspace --test ros2 figures -- --ignored
//! --nocapture`.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use lrp_bridge::{Event, Form, Health, Item, Order, Output};
use serde_json::{Value, json};

use crate::programs::{library, lrp};
use crate::world::{Node, enter};

const COUNT: usize = 300;

#[test]
#[ignore = "it measures"]
fn figures() {
    let Some(()) = enter("figures::figures") else { return };
    println!();
    latency();
    round_trip();
    cost("20 topics with 50 small messages a second each", 20, json!({ "data": 7 }), None, 50.0);
    cost("images of 1 MB at 30 Hz", 1, json!({}), Some(1_000_000), 30.0);
}

/// The process that lrp would start.
struct Bridge {
    child: Child,
    orders: ChildStdin,
    events: BufReader<ChildStdout>,
}

impl Bridge {
    fn start(config: Value) -> Bridge {
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

    fn order(&mut self, order: &Order) {
        writeln!(self.orders, "{}", serde_json::to_string(order).expect("an order")).expect("a bridge that listens");
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.events.read_line(&mut line).expect("a bridge that speaks");
        line
    }

    fn event(&mut self) -> Event {
        serde_json::from_str(&self.line()).expect("an event")
    }

    fn input(&mut self) -> Value {
        loop {
            if let Event::Input { value, .. } = self.event() {
                return value;
            }
        }
    }

    /// Seconds of processor time so far, and MB of memory.
    fn usage(&self) -> (f64, f64) {
        let read = |what: &str| std::fs::read_to_string(format!("/proc/{}/{what}", self.child.id())).expect("proc");
        let stat = read("stat");
        let fields: Vec<&str> = stat.rsplit(')').next().expect("fields").split_whitespace().collect();
        let ticks: f64 = [11, 12].iter().map(|at| fields[*at].parse::<f64>().expect("ticks")).sum();
        let status = read("status");
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

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

/// From a peer's stamp until lrp reads the line.
fn latency() {
    let mut bridge = Bridge::start(json!({ "subscribe": { "stamp": "/stamp" } }));
    let mut node = Node::start("stamper");
    node.tell(json!({ "do": "stamp", "topic": "/stamp", "count": COUNT, "rate": 100.0 }));
    let mut took = Vec::new();
    while took.len() < COUNT / 2 {
        let stamped = bridge.input()["data"].as_i64().expect("a stamp");
        took.push((now() - stamped) as f64 / 1e6);
    }
    let send = node.until("stamped")["median"].as_f64().expect("a time") / 1e6;
    let all = median(took);
    println!("latency: {all:.2} ms from stamp to lrp, {send:.2} ms of them the peer's own send: {:.2} ms", all - send);
}

/// Both clocks are the system's.
fn now() -> i64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).expect("a clock").as_nanos() as i64
}

/// There and back through an echo of rclpy, beside another node of rclpy that does the same.
fn round_trip() {
    let mut echo = Node::start("echo");
    let mut other = Node::start("other");
    echo.tell(json!({ "do": "echo", "source": "/out", "target": "/back", "type": "std_msgs/msg/Int64" }));
    echo.tell(json!({ "do": "echo", "source": "/out2", "target": "/back2", "type": "std_msgs/msg/Int64" }));
    other.tell(json!({ "do": "ping", "out": "/out2", "back": "/back2", "count": COUNT }));
    let theirs = other.until("pinged")["median"].as_f64().expect("a time") / 1e6;
    let mut bridge = Bridge::start(json!({
        "subscribe": { "back": "/back std_msgs/msg/Int64" },
        "publish": { "out": "/out std_msgs/msg/Int64" },
    }));
    std::thread::sleep(Duration::from_secs(2));
    let mut took = Vec::new();
    for number in 0..COUNT {
        let began = Instant::now();
        let value = json!({ "data": number });
        bridge.order(&Order::Send { items: vec![Item::Output(Output { output: "out".into(), value })] });
        while bridge.input()["data"] != number {}
        took.push(began.elapsed().as_secs_f64() * 1e3);
    }
    let ours = median(took);
    println!(
        "round trip through rclpy: {ours:.2} ms, of another rclpy node {theirs:.2} ms: {:.2} times",
        ours / theirs
    );
}

/// Memory and processor time of the bridge's process.
fn cost(what: &str, topics: usize, value: Value, size: Option<usize>, rate: f64) {
    let type_name = if size.is_some() { "sensor_msgs/msg/Image" } else { "std_msgs/msg/Int32" };
    let inputs = (0..topics).map(|number| (format!("t{number}"), json!(format!("/t{number} {type_name}"))));
    let mut bridge = Bridge::start(json!({ "subscribe": Value::Object(inputs.collect()) }));
    let mut node = Node::start("talker");
    for number in 0..topics {
        node.tell(json!({ "do": "publish", "topic": format!("/t{number}"), "type": type_name, "value": value,
            "size": size, "count": 2000, "rate": rate }));
    }
    let settled = Instant::now() + Duration::from_secs(2);
    while Instant::now() < settled {
        bridge.line();
    }
    let ((before, _), began, mut lines) = (bridge.usage(), Instant::now(), 0);
    while began.elapsed() < Duration::from_secs(5) {
        bridge.line();
        lines += 1;
    }
    let ((after, resident), seconds) = (bridge.usage(), began.elapsed().as_secs_f64());
    let (share, rate) = ((after - before) / seconds * 100.0, f64::from(lines) / seconds);
    println!("{what}: {resident:.1} MB resident, {share:.1} % of a core at {rate:.0} messages/s");
}
