//! Which network is used, and what the environment says of it and of definitions.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use lrp_bridge::Bridge;
use lrp_bridge_ros2::Ros2;
use serde_json::{Value, json};

use crate::forms::problems;
use crate::peers;
use crate::topics::bridge;
use crate::world::{Node, enter, enter_with};

/// How long to wait for packets.
const PATIENCE: Duration = Duration::from_secs(20);

/// Beside loopback a network interface `far`, with a cable to nowhere.
fn add_far() {
    let commands = "ip link add far type veth peer name end
        ip link set end up addrgenmode none
        ip addr add 10.9.8.7/24 dev far
        ip link set far up multicast on addrgenmode none";
    for command in commands.lines() {
        let mut words = command.split_whitespace();
        let status = Command::new(words.next().expect("a program")).args(words).status().expect("iproute2");
        assert!(status.success(), "{command}");
    }
}

/// Packets that have left by an interface.
fn sent(interface: &str) -> u64 {
    let all = std::fs::read_to_string("/proc/self/net/dev").expect("interfaces");
    let counts = all.lines().find_map(|line| line.trim().strip_prefix(interface)?.strip_prefix(':'));
    // After eight numbers of what came in.
    let packets = counts.expect("an interface").split_whitespace().nth(9).expect("packets");
    packets.parse().expect("a number")
}

fn until_sent(interface: &str, count: u64) {
    let end = Instant::now() + PATIENCE;
    let goal = sent(interface) + count;
    while sent(interface) < goal {
        assert!(Instant::now() < end, "nothing leaves by {interface}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// That a bridge under a configuration uses loopback and nothing else. Only where none has used the other one yet: what it
/// has left there may still be on its way.
fn stays_at_home(config: Value) {
    let before = sent("far");
    let lrp = bridge(config.clone());
    // It announces itself on all networks at once.
    until_sent("lo", 20);
    drop(lrp);
    assert_eq!(sent("far"), before, "{config} uses the other network");
}

fn goes_far(config: Value) {
    let _lrp = bridge(config);
    until_sent("far", 3);
}

#[test]
fn an_interface_is_meant_by_its_name_or_address() {
    let Some(()) = enter("networks::an_interface_is_meant_by_its_name_or_address") else { return };
    add_far();
    stays_at_home(json!({ "interface": "lo" }));
    stays_at_home(json!({ "interface": "127.0.0.1" }));
    stays_at_home(json!({ "localhost": true }));
    goes_far(json!({}));
    goes_far(json!({ "interface": "far" }));
    goes_far(json!({ "interface": "10.9.8.7" }));
    // The other end of far has no address.
    for unknown in ["wlan7", "10.9.8.6", "end"] {
        assert_eq!(
            problems(json!({ "interface": unknown })),
            [format!("interface: there is no network interface `{unknown}` with an IPv4 address (one of: far, lo)")]
        );
    }
    let mut node = Node::start("talker");
    node.tell(json!({ "do": "publish", "topic": "/n", "type": "std_msgs/msg/Int32", "value": { "data": 1 },
        "count": 3000 }));
    for interface in ["lo", "127.0.0.1"] {
        let mut lrp = bridge(json!({ "interface": interface, "subscribe": { "n": "/n" } }));
        assert_eq!(lrp.input("n"), json!({ "data": 1 }));
    }
}

#[test]
fn ros_localhost_only_keeps_it_on_this_machine() {
    let test = "networks::ros_localhost_only_keeps_it_on_this_machine";
    let Some(()) = enter_with(test, &[("ROS_LOCALHOST_ONLY", "1")]) else { return };
    add_far();
    stays_at_home(json!({}));
    goes_far(json!({ "localhost": false }));
}

#[test]
fn a_discovery_range_of_localhost_keeps_it_on_this_machine() {
    let test = "networks::a_discovery_range_of_localhost_keeps_it_on_this_machine";
    let Some(()) = enter_with(test, &[("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")]) else { return };
    add_far();
    stays_at_home(json!({}));
    goes_far(json!({ "localhost": false }));
}

#[test]
fn ros_domain_id_is_the_domain_where_the_form_has_none() {
    let test = "networks::ros_domain_id_is_the_domain_where_the_form_has_none";
    let Some(()) = enter_with(test, &[("ROS_DOMAIN_ID", "5")]) else { return };
    let _nodes = [0, 5].map(|domain| {
        let mut program = peers::python("node.py").expect("a peer");
        let mut node = Node::of(program.arg("talker").env("ROS_DOMAIN_ID", domain.to_string()));
        node.tell(json!({ "do": "publish", "topic": "/n", "type": "std_msgs/msg/Int32",
            "value": { "data": domain }, "count": 6000 }));
        node
    });
    let mut lrp = bridge(json!({ "subscribe": { "n": "/n" } }));
    assert_eq!(lrp.input("n"), json!({ "data": 5 }));
    let mut lrp = bridge(json!({ "domain": 0, "subscribe": { "n": "/n" } }));
    assert_eq!(lrp.input("n"), json!({ "data": 0 }));
}

#[test]
fn a_wrong_ros_domain_id_is_told_unless_the_form_has_one() {
    let test = "networks::a_wrong_ros_domain_id_is_told_unless_the_form_has_one";
    let Some(()) = enter_with(test, &[("ROS_DOMAIN_ID", "500")]) else { return };
    assert_eq!(
        problems(json!({})),
        ["domain: ROS_DOMAIN_ID is `500`, which is no domain (export ROS_DOMAIN_ID=0, or `domain = 0` in the form)"]
    );
    assert!(Ros2::offer(&json!({ "domain": 7 })).is_ok());
}

#[test]
fn ament_prefix_path_says_where_definitions_are() {
    let prefix = Path::new(env!("CARGO_TARGET_TMPDIR")).join("prefix");
    let package = prefix.join("share/my_msgs/msg");
    std::fs::create_dir_all(&package).expect("a folder");
    std::fs::write(package.join("Word.msg"), "string text \"hello\"\n").expect("a definition");
    let path = format!("/nowhere:{}", prefix.display());
    let test = "networks::ament_prefix_path_says_where_definitions_are";
    let Some(()) = enter_with(test, &[("AMENT_PREFIX_PATH", &path)]) else { return };
    let offer = Ros2::offer(&json!({ "publish": { "say": "/word my_msgs/msg/Word" } })).expect("an offer");
    assert_eq!(offer.output("say").map(|port| &port.message), Some(&json!({ "text": "hello" })));
}
