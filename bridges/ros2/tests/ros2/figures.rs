//! What the bridge costs, measured against rclpy: `cargo test --release --workspace --test ros2 figures -- --ignored
//! --nocapture`.

use std::thread;
use std::time::{Duration, Instant, SystemTime};

use serde_json::{Value, json};

use crate::bare::{Bare, Listener};
use crate::peers;
use crate::process::Bridge;
use crate::world::{Node, enter};

const COUNT: usize = 300;

/// Until all have found each other, and how long is measured then.
const SETTLED: Duration = Duration::from_secs(2);
const MEASURED: Duration = Duration::from_secs(5);

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

/// From a peer's stamp until lrp reads the line.
#[test]
#[ignore = "it measures"]
fn latency() {
    let Some(()) = enter("figures::latency") else { return };
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

/// There and back through an echo of rclpy: from lrp through the bridge, and from a bare participant of DDS.
#[test]
#[ignore = "it measures"]
fn round_trip() {
    let Some(()) = enter("figures::round_trip") else { return };
    let pairs = ["/out", "/back", "/bare/out", "/bare/back"];
    let _echo = Node::of(peers::python("echo.py").expect("a peer").args(pairs));
    let mut bridge = Bridge::start(json!({
        "subscribe": { "back": "/back std_msgs/msg/Int64" },
        "publish": { "out": "/out std_msgs/msg/Int64" },
    }));
    let bare = Bare::new("rt/bare/out", "rt/bare/back");
    thread::sleep(SETTLED);
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    // In turns, so that both meet the same machine.
    for number in 0..COUNT {
        let began = Instant::now();
        let value = json!({ "data": number });
        bridge.send("out", value);
        while bridge.input()["data"] != number {}
        ours.push(began.elapsed().as_secs_f64() * 1e3);
        let began = Instant::now();
        bare.ping(number as i64);
        theirs.push(began.elapsed().as_secs_f64() * 1e3);
    }
    let (ours, theirs) = (median(ours), median(theirs));
    println!(
        "round trip through rclpy: {ours:.2} ms, of bare DDS through the same {theirs:.2} ms: {:.2} times",
        ours / theirs
    );
}

#[test]
#[ignore = "it measures"]
fn small_messages() {
    let Some(()) = enter("figures::small_messages") else { return };
    let ours = cost("20 topics with 50 small messages a second each", 20, "std_msgs/msg/Int64", None, 50.0);
    let listener = Listener::start((0..20).map(|number| format!("rt/t{number}")));
    let _node = talk(20, "std_msgs/msg/Int64", None, 50.0);
    thread::sleep(SETTLED);
    let before = listener.usage();
    thread::sleep(MEASURED);
    let bare = (listener.usage() - before) / MEASURED.as_secs_f64() * 100.0;
    println!("of bare DDS that listens to the same: {bare:.1} %; the bridge takes {:.2} times as much", ours / bare);
}

#[test]
#[ignore = "it measures"]
fn idle() {
    let Some(()) = enter("figures::idle") else { return };
    let bridge = Bridge::start(json!({}));
    thread::sleep(SETTLED);
    let (before, _) = bridge.usage();
    thread::sleep(MEASURED);
    let (after, resident) = bridge.usage();
    let share = (after - before) / MEASURED.as_secs_f64() * 100.0;
    println!("idle: {resident:.1} MB resident, {share:.1} % of a core");
}

#[test]
#[ignore = "it measures"]
fn images() {
    let Some(()) = enter("figures::images") else { return };
    cost("images of 1 MB at 30 Hz", 1, "sensor_msgs/msg/Image", Some(1_000_000), 30.0);
}

/// Memory and processor time of the bridge's process; gives the latter, % of a core.
fn cost(what: &str, topics: usize, type_name: &str, size: Option<usize>, rate: f64) -> f64 {
    let inputs = (0..topics).map(|number| (format!("t{number}"), json!(format!("/t{number} {type_name}"))));
    let mut bridge = Bridge::start(json!({ "subscribe": Value::Object(inputs.collect()) }));
    let _node = talk(topics, type_name, size, rate);
    let settled = Instant::now() + SETTLED;
    while Instant::now() < settled {
        bridge.input();
    }
    let ((before, _), began, mut inputs) = (bridge.usage(), Instant::now(), 0);
    while began.elapsed() < MEASURED {
        bridge.input();
        inputs += 1;
    }
    let ((after, resident), seconds) = (bridge.usage(), began.elapsed().as_secs_f64());
    let (share, rate) = ((after - before) / seconds * 100.0, f64::from(inputs) / seconds);
    println!("{what}: {resident:.1} MB resident, {share:.1} % of a core at {rate:.0} messages/s");
    share
}

/// A node that publishes on `/t0`, `/t1` and so on.
fn talk(topics: usize, type_name: &str, size: Option<usize>, rate: f64) -> Node {
    let mut node = Node::start("talker");
    for number in 0..topics {
        node.tell(json!({ "do": "publish", "topic": format!("/t{number}"), "type": type_name, "value": {},
            "size": size, "count": 2000, "rate": rate }));
    }
    node
}
