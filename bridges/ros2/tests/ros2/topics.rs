//! Topics with a real ROS on the other side: both ways, found types, QoS, and what goes wrong with them.

use std::time::{Duration, SystemTime};

use lrp_bridge::{Event, Level, Peer};
use lrp_bridge_ros2::Ros2;
use serde_json::{Value, json};

use crate::world::{Node, enter};

/// The bridge, up under a configuration.
pub fn bridge(config: Value) -> Peer {
    let mut lrp = Peer::of::<Ros2>();
    lrp.configure(config);
    lrp.until_up();
    lrp
}

/// The next line of the log that has these words in it.
pub fn logged(lrp: &mut Peer, words: &str) -> (Level, String) {
    lrp.until(&format!("log with `{words}`"), |event| match event {
        Event::Log { level, message, .. } if message.contains(words) => Some((*level, message.clone())),
        _ => None,
    })
}

#[test]
fn a_topic_is_enough_to_subscribe() {
    let Some(()) = enter("topics::a_topic_is_enough_to_subscribe") else { return };
    let mut lrp = bridge(json!({ "subscribe": { "odom": "/odom", "word": "/word" } }));
    let mut node = Node::start("driver");
    let odometry = json!({ "header": { "frame_id": "odom" }, "pose": { "pose": { "position": { "x": 1.5 } } } });
    node.tell(json!({ "do": "publish", "topic": "/odom", "type": "nav_msgs/msg/Odometry", "value": odometry,
        "count": 500 }));
    let seen = lrp.input("odom");
    assert_eq!(seen["pose"]["pose"]["position"], json!({ "x": 1.5, "y": 0.0, "z": 0.0 }));
    assert_eq!(seen["header"]["frame_id"], json!("odom"));
    // One of which only the last word counts: its QoS is followed.
    node.tell(json!({ "do": "publish", "topic": "/word", "type": "std_msgs/msg/String", "value": { "data": "hä?" },
        "qos": { "transient_local": true, "depth": 1 } }));
    assert_eq!(lrp.input("word"), json!({ "data": "hä?" }));
}

#[test]
fn what_is_published_arrives_and_our_node_is_seen() {
    let Some(()) = enter("topics::what_is_published_arrives_and_our_node_is_seen") else { return };
    let mut node = Node::start("base");
    node.tell(json!({ "do": "subscribe", "topic": "/robot/cmd_vel", "type": "geometry_msgs/msg/Twist" }));
    let mut lrp = bridge(json!({
        "namespace": "/robot",
        "node": "greeter",
        "publish": { "move": "velocity geometry_msgs/Twist" },
        "remap": { "velocity": "/robot/cmd_vel" },
    }));
    // To the first who listens a halt goes first.
    let zero = json!({ "linear": { "x": 0.0, "y": 0.0, "z": 0.0 }, "angular": { "x": 0.0, "y": 0.0, "z": 0.0 } });
    assert_eq!(node.until("heard")["value"], zero);
    lrp.send("move", json!({ "linear": { "x": 0.2 } }));
    assert_eq!(node.until("heard")["value"]["linear"]["x"], json!(0.2));
    lrp.order(lrp_bridge::Order::Stop);
    assert_eq!(node.until("heard")["value"], zero);
    lrp.send("move", json!({ "linear": { "w": 0.2 } }));
    let (level, said) = logged(&mut lrp, "output");
    assert_eq!(level, Level::Error);
    assert_eq!(said, "output `move`: `linear`: geometry_msgs/msg/Vector3 has no field `w`, its fields are: x, y, z");
}

#[test]
fn a_halt_with_a_header_tells_the_time() {
    let Some(()) = enter("topics::a_halt_with_a_header_tells_the_time") else { return };
    let mut node = Node::start("base");
    node.tell(json!({ "do": "subscribe", "topic": "/cmd_vel", "type": "geometry_msgs/msg/TwistStamped" }));
    let config = |simulated: bool| json!({ "use_sim_time": simulated, "publish": { "move": "/cmd_vel geometry_msgs/msg/TwistStamped" } });
    let mut lrp = bridge(config(false));
    let zero = json!({ "linear": { "x": 0.0, "y": 0.0, "z": 0.0 }, "angular": { "x": 0.0, "y": 0.0, "z": 0.0 } });
    let is_halt = |heard: &Value| heard["value"]["twist"] == zero;
    let today = |heard: &Value| {
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).expect("a clock").as_secs();
        let stamp = heard["value"]["header"]["stamp"]["sec"].as_u64().expect("a stamp");
        is_halt(heard) && stamp + 60 > now && stamp <= now
    };
    let first = node.until("heard");
    assert!(today(&first), "{first}");
    lrp.send("move", json!({ "twist": { "angular": { "z": 0.2 } } }));
    assert_eq!(node.until("heard")["value"]["twist"]["angular"]["z"], json!(0.2));
    lrp.order(lrp_bridge::Order::Stop);
    let halt = node.until("heard");
    assert!(today(&halt), "{halt}");
    // A simulator's, where its clock counts.
    lrp.configure(config(true));
    let time = (0..100).find_map(|_| {
        node.tell(json!({ "do": "clock", "sec": 12, "nanosec": 500_000_000 }));
        lrp.event(Duration::from_millis(50)).filter(|event| matches!(event, Event::Time { .. }))
    });
    assert!(time.is_some(), "no time");
    lrp.order(lrp_bridge::Order::Stop);
    let halt = node.until("heard");
    assert!(is_halt(&halt), "{halt}");
    assert_eq!(halt["value"]["header"]["stamp"], json!({ "sec": 12, "nanosec": 500_000_000 }));
}

#[test]
fn a_profile_that_does_not_fit_is_told_with_the_policy() {
    let Some(()) = enter("topics::a_profile_that_does_not_fit_is_told_with_the_policy") else { return };
    let mut node = Node::start("driver");
    let value = json!({ "data": 7 });
    let sensor = json!({ "do": "publish", "topic": "/light", "type": "std_msgs/msg/Int32", "value": value,
        "qos": { "best_effort": true }, "count": 1000 });
    node.tell(sensor);
    node.tell(json!({ "do": "subscribe", "topic": "/word", "type": "std_msgs/msg/String",
        "qos": { "transient_local": true } }));
    let mut lrp = bridge(json!({
        "subscribe": { "light": "/light default" },
        "publish": { "say": "/word std_msgs/msg/String" },
    }));
    let told = [logged(&mut lrp, "differ").1, logged(&mut lrp, "differ").1];
    assert!(
        told.contains(
            &"input `light` gets nothing from /driver on /light: they differ in reliability \
          (offered: best effort, wanted: reliable); qos = \"match\"?"
                .to_string()
        ),
        "{told:?}"
    );
    assert!(
        told.contains(
            &"output `say` doesn't reach /driver on /word: they differ in durability \
          (offered: volatile, wanted: transient local)"
                .to_string()
        ),
        "{told:?}"
    );
    // The form is edited: only what differs is made anew, and now it fits.
    lrp.configure(json!({
        "subscribe": { "light": "/light" },
        "publish": { "say": { "topic": "/word", "type": "std_msgs/String", "qos": "match" } },
    }));
    assert_eq!(lrp.input("light"), value);
    lrp.send("say", json!({ "data": "late" }));
    assert_eq!(node.until("heard")["value"], json!({ "data": "late" }));
}

#[test]
fn another_type_and_broken_bytes_are_told_and_harm_nothing() {
    let Some(()) = enter("topics::another_type_and_broken_bytes_are_told_and_harm_nothing") else { return };
    let mut node = Node::start("driver");
    let mut lrp = bridge(json!({ "subscribe": {
        "scan": "/scan sensor_msgs/msg/Range",
        "word": "/word std_msgs/msg/String",
    } }));
    node.tell(json!({ "do": "raw", "topic": "/scan", "type": "sensor_msgs/msg/LaserScan", "payload": "00010000" }));
    assert_eq!(
        logged(&mut lrp, "/scan is").1,
        "input `scan`: /scan is sensor_msgs/msg/LaserScan there, and sensor_msgs/msg/Range in the form"
    );
    node.tell(json!({ "do": "publish", "topic": "/word", "type": "std_msgs/msg/String", "value": { "data": "a" } }));
    assert_eq!(logged(&mut lrp, "/word is").1, "input `word`: /word is published");
    for payload in ["00010000ffffffff", "0001000005000000616263", "00010000"] {
        node.tell(json!({ "do": "raw", "topic": "/word", "type": "std_msgs/msg/String", "payload": payload }));
    }
    let (level, said) = logged(&mut lrp, "malformed");
    assert_eq!(level, Level::Warn);
    assert!(said.starts_with("input `word` (/word): a malformed std_msgs/msg/String of "), "{said}");
    node.tell(json!({ "do": "publish", "topic": "/word", "type": "std_msgs/msg/String", "value": { "data": "b" } }));
    lrp.input_where("word", |value| value == &json!({ "data": "b" }));
}

#[test]
fn a_talker_that_is_killed_and_comes_back_is_heard_again() {
    let Some(()) = enter("topics::a_talker_that_is_killed_and_comes_back_is_heard_again") else { return };
    let mut lrp = bridge(json!({ "subscribe": { "n": "/n" } }));
    for turn in 1..=2 {
        let mut node = Node::start("talker");
        let talk = json!({ "do": "publish", "topic": "/n", "type": "std_msgs/msg/Int32", "value": { "data": turn },
            "count": 1000 });
        node.tell(talk);
        lrp.input_where("n", |value| value["data"] == turn);
        node.kill();
    }
}

#[test]
fn much_comes_through() {
    let Some(()) = enter("topics::much_comes_through") else { return };
    let mut inputs = serde_json::Map::new();
    for number in 0..200 {
        inputs.insert(format!("t{number}"), json!(format!("/t{number} std_msgs/msg/Int32")));
    }
    inputs.insert("image".into(), json!("/image sensor_data"));
    inputs.insert("flood".into(), json!("/flood"));
    let mut lrp = bridge(json!({ "subscribe": inputs }));
    let mut node = Node::start("many");
    for number in [0, 77, 199] {
        node.tell(json!({ "do": "publish", "topic": format!("/t{number}"), "type": "std_msgs/msg/Int32",
            "value": { "data": number }, "count": 200 }));
        assert_eq!(lrp.input(&format!("t{number}")), json!({ "data": number }));
    }
    let image = json!({ "height": 1000, "width": 1000, "encoding": "mono8", "step": 1000 });
    node.tell(json!({ "do": "publish", "topic": "/image", "type": "sensor_msgs/msg/Image", "value": image,
        "size": 1_000_000, "qos": { "best_effort": true }, "count": 60, "rate": 30.0 }));
    node.tell(json!({ "do": "publish", "topic": "/flood", "type": "std_msgs/msg/String",
        "value": { "data": "x" }, "count": 20_000, "rate": 1e6 }));
    for _ in 0..5 {
        let image = lrp.input("image");
        assert_eq!(lrp_bridge::value::as_bytes(&image["data"]).map(|data| data.len()), Some(1_000_000));
    }
    lrp.input("flood");
    // It answers while it is flooded.
    lrp.order(lrp_bridge::Order::Ping { id: 7 });
    lrp.until("pong", |event| matches!(event, Event::Pong { id: 7 }).then_some(()));
}

#[test]
fn another_domain_is_another_world() {
    let Some(()) = enter("topics::another_domain_is_another_world") else { return };
    let mut node = Node::start("talker");
    node.tell(json!({ "do": "publish", "topic": "/n", "type": "std_msgs/msg/Int32", "value": { "data": 1 },
        "count": 3000 }));
    let config = |domain| json!({ "domain": domain, "localhost": true, "subscribe": { "n": "/n" } });
    let mut lrp = bridge(config(5));
    // Joins anew, and the name goes on standing for the topic.
    lrp.configure(config(0));
    lrp.until_up();
    assert_eq!(lrp.input("n"), json!({ "data": 1 }));
}

#[test]
fn a_type_that_nobody_knows_here_is_told_by_its_node() {
    let Some(()) = enter("topics::a_type_that_nobody_knows_here_is_told_by_its_node") else { return };
    let mut lrp = bridge(json!({ "subscribe": { "odd": "/odd" } }));
    let mut node = Node::start("odd");
    node.tell(json!({ "do": "publish", "topic": "/odd", "type": "test_msgs/msg/Nested",
        "value": { "basic_types_value": { "int16_value": -3 } }, "count": 1000 }));
    assert_eq!(lrp.input("odd")["basic_types_value"]["int16_value"], json!(-3));
}

/// The first time it may not have found us yet.
#[test]
fn who_has_just_come_is_halted_twice() {
    let Some(()) = enter("topics::who_has_just_come_is_halted_twice") else { return };
    let mut node = Node::start("base");
    node.tell(json!({ "do": "subscribe", "topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist" }));
    let _lrp = bridge(json!({ "publish": { "move": "/cmd_vel geometry_msgs/msg/Twist" } }));
    for _ in 0..2 {
        assert_eq!(node.until("heard")["value"]["linear"]["x"], 0.0);
    }
}
