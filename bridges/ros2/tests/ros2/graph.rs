//! What is seen of a system, and what it sees of us: the graph, logs, the clock, the machines' states.

use lrp_bridge::{Active, Event, Found, Level, Order};
use serde_json::{Value, json};

use crate::topics::bridge;
use crate::world::{Node, enter};

#[test]
fn the_graph_is_found_and_we_are_in_it() {
    let Some(()) = enter("graph::the_graph_is_found_and_we_are_in_it") else { return };
    let mut node = Node::start("driver");
    node.tell(json!({ "do": "publish", "topic": "/odom", "type": "nav_msgs/msg/Odometry", "value": {} }));
    node.tell(json!({ "do": "subscribe", "topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist" }));
    node.tell(json!({ "do": "serve", "service": "/reset", "type": "std_srvs/srv/Empty", "reply": {} }));
    node.tell(json!({ "do": "act", "action": "/count", "type": "test_msgs/action/Fibonacci", "how": "succeed" }));
    let mut lrp = bridge(json!({
        "node": "greeter",
        "subscribe": { "odom": "/odom" },
        "publish": { "move": "/cmd_vel" },
        "services": { "reset": "/reset" },
    }));
    let found = |name: &str, what: &str, type_name: &str, setting: Option<&str>| Found {
        name: name.into(),
        what: what.into(),
        type_name: type_name.into(),
        doc: String::new(),
        setting: setting.map(str::to_string),
    };
    let wanted = [
        found("/count", "action", "test_msgs/action/Fibonacci", Some("actions.count")),
        found("/driver", "node", "", None),
        found("/reset", "service", "std_srvs/srv/Empty", Some("services.reset")),
        found("/cmd_vel", "topic", "geometry_msgs/msg/Twist", Some("publish.cmd_vel")),
        found("/odom", "topic", "nav_msgs/msg/Odometry", Some("subscribe.odom")),
    ];
    lrp.until("the whole graph", |event| match event {
        Event::Found { found } => {
            let bare: Vec<Found> = found.iter().map(|found| Found { doc: String::new(), ..found.clone() }).collect();
            wanted.iter().all(|wanted| bare.contains(wanted)).then_some(())
        }
        _ => None,
    });
    let seen = node.graph_where("greeter", |seen| {
        let has = |key: &str, name: &str, kind: &str| {
            seen[key].as_array().is_some_and(|pairs| pairs.contains(&json!([name, kind])))
        };
        has("publishers", "/cmd_vel", "geometry_msgs/msg/Twist")
            && has("subscribers", "/odom", "nav_msgs/msg/Odometry")
            && has("clients", "/reset", "std_srvs/srv/Empty")
            && has("services", "/greeter/set_parameters", "rcl_interfaces/srv/SetParameters")
    });
    println!("{seen}");
}

#[test]
fn logs_the_clock_and_states_pass() {
    let Some(()) = enter("graph::logs_the_clock_and_states_pass") else { return };
    let mut node = Node::start("driver");
    let mut lrp = bridge(json!({ "rosout": "warn", "use_sim_time": true }));
    node.tell(json!({ "do": "subscribe", "topic": "/lrp/states", "type": "diagnostic_msgs/msg/DiagnosticArray",
        "qos": { "transient_local": true } }));
    // A subscriber of logs is there only once it has been found.
    let (level, from) = loop {
        node.tell(json!({ "do": "log", "level": "info", "message": "never mind" }));
        node.tell(json!({ "do": "log", "level": "error", "message": "no wheel" }));
        if let Some(found) = (0..5).find_map(|_| match lrp.event(std::time::Duration::from_millis(50)) {
            Some(Event::Log { level, message, from: Some(from) }) => {
                assert_eq!(message, "no wheel");
                Some((level, from))
            }
            _ => None,
        }) {
            break found;
        }
    };
    assert_eq!((level, from.as_str()), (Level::Error, "driver"));
    lrp.order(Order::States {
        t: 1500.0,
        machines: vec![Active { machine: "follower".into(), state: "follower/looking".into(), since: 1200.0 }],
    });
    let is_told = |said: &Value| said["heard"] == "/lrp/states" && said["value"]["status"] != json!([]);
    let seen = node.until_where("heard", is_told);
    let status = &seen["value"]["status"][0];
    assert_eq!((&status["name"], &status["message"]), (&json!("follower"), &json!("looking")));
    assert_eq!(status["values"][0], json!({ "key": "state", "value": "follower/looking" }));
    assert_eq!(status["values"][1], json!({ "key": "since", "value": "1200" }));
    node.tell(json!({ "do": "subscribe", "topic": "/rosout", "type": "rcl_interfaces/msg/Log",
        "qos": { "transient_local": true } }));
    let state = Some("follower/looking".to_string());
    lrp.order(Order::Log { level: Level::Warn, message: "the line is gone".into(), state });
    let seen = node.until_where("heard", |said| said["heard"] == "/rosout" && said["value"]["name"] == "lrp");
    assert_eq!((&seen["value"]["msg"], &seen["value"]["level"]), (&json!("the line is gone"), &json!(30)));
    // Published until it is heard.
    for _ in 0..100 {
        node.tell(json!({ "do": "clock", "sec": 12, "nanosec": 500_000_000 }));
        if let Some(Event::Time { ms }) = lrp.event(std::time::Duration::from_millis(50)) {
            assert_eq!(ms, 12_500.0);
            return;
        }
    }
    panic!("no time");
}

/// To a group, each message would come twice: to it, and to us.
#[test]
fn messages_are_not_to_be_sent_to_a_group() {
    let Some(()) = enter("graph::messages_are_not_to_be_sent_to_a_group") else { return };
    let ports = |domain: u16| {
        let _lrp = bridge(json!({ "domain": domain }));
        let sockets = std::fs::read_to_string("/proc/net/udp").expect("sockets");
        let port = |line: &str| u16::from_str_radix(line.split_whitespace().nth(1)?.rsplit(':').next()?, 16).ok();
        sockets.lines().filter_map(port).collect::<Vec<u16>>()
    };
    for domain in [0, 7] {
        let (ports, first) = (ports(domain), 7400 + 250 * domain);
        let [found, messages] = [first, first + 1].map(|port| ports.contains(&port));
        assert!(found && !messages, "{ports:?}");
    }
}
