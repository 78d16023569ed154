//! What the bridge costs, measured against rclpy: `cargo test --release --workspace --test ros2 figures -- --ignored
//! --nocapture`.

use std::sync::Arc;
use std::task::{Wake, Waker};
use std::thread::{self, Thread};
use std::time::{Duration, Instant, SystemTime};

use lrp_bridge::{Item, Order, Output};
use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::policy::{History, Reliability};
use rustdds::{CDRDeserializerAdapter, CDRSerializerAdapter, DomainParticipant, QosPolicyBuilder, TopicKind};
use serde_json::{Value, json};

use crate::peers;
use crate::process::Bridge;
use crate::world::{Node, enter};

const COUNT: usize = 300;

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
    thread::sleep(Duration::from_secs(2));
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    // In turns, so that both meet the same machine.
    for number in 0..COUNT {
        let began = Instant::now();
        let value = json!({ "data": number });
        bridge.order(&Order::Send { items: vec![Item::Output(Output { output: "out".into(), value })] });
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

/// A writer and a reader without a bridge around them.
struct Bare {
    writer: DataWriter<i64, CDRSerializerAdapter<i64>>,
    reader: SimpleDataReader<i64, CDRDeserializerAdapter<i64>>,
    _participant: DomainParticipant,
}

impl Bare {
    fn new(out: &str, back: &str) -> Bare {
        let participant = DomainParticipant::new(0).expect("a participant");
        let qos = QosPolicyBuilder::new()
            .reliability(Reliability::Reliable { max_blocking_time: rustdds::Duration::from_millis(50) })
            .history(History::KeepLast { depth: 10 })
            .build();
        let topic = |name: &str| {
            let kind = "std_msgs::msg::dds_::Int64_".to_string();
            participant.create_topic(name.into(), kind, &qos, TopicKind::NoKey).expect("a topic")
        };
        let publisher = participant.create_publisher(&qos).expect("a publisher");
        let subscriber = participant.create_subscriber(&qos).expect("a subscriber");
        Bare {
            writer: publisher.create_datawriter_no_key(&topic(out), None).expect("a writer"),
            reader: subscriber.create_simple_datareader_no_key(&topic(back), None).expect("a reader"),
            _participant: participant,
        }
    }

    fn ping(&self, number: i64) {
        self.writer.write(number, None).expect("written");
        while self.take() != number {}
    }

    fn take(&self) -> i64 {
        loop {
            self.reader.drain_read_notifications();
            self.reader.set_waker(Some(Waker::from(Arc::new(Unpark(thread::current())))));
            if let Some(sample) = self.reader.try_take_one().expect("a sample") {
                return sample.sample;
            }
            thread::park();
        }
    }
}

struct Unpark(Thread);

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

#[test]
#[ignore = "it measures"]
fn small_messages() {
    let Some(()) = enter("figures::small_messages") else { return };
    cost("20 topics with 50 small messages a second each", 20, json!({ "data": 7 }), None, 50.0);
}

#[test]
#[ignore = "it measures"]
fn images() {
    let Some(()) = enter("figures::images") else { return };
    cost("images of 1 MB at 30 Hz", 1, json!({}), Some(1_000_000), 30.0);
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
