//! The real Cyclone DDS on the other side: topics both ways, QoS, big messages, and services as rmw_cyclonedds maps them.

use std::collections::BTreeMap;

use lrp_bridge::{Event, Found, Level, Order, Peer, value};
use serde_json::{Value, json};

use crate::peers;
use crate::topics::bridge;
use crate::world::{Node, enter};

fn cyclone(name: &str) -> Node {
    Node::of(peers::python("cyclone.py").expect("a peer").arg(name))
}

const BIG: usize = 1_000_000;

#[test]
fn topics_pass_both_ways_and_the_node_is_known_by_name() {
    let Some(()) = enter("cyclone::topics_pass_both_ways_and_the_node_is_known_by_name") else { return };
    let mut node = cyclone("driver");
    node.tell(json!({ "do": "subscribe", "topic": "/said", "type": "std_msgs/msg/String" }));
    node.tell(json!({ "do": "subscribe", "topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist" }));
    let mut lrp = bridge(json!({
        "subscribe": { "word": "/word", "twist": "/twist" },
        "publish": { "say": "/said std_msgs/msg/String", "move": "/cmd_vel geometry_msgs/msg/Twist" },
    }));
    node.tell(json!({ "do": "publish", "topic": "/word", "type": "std_msgs/msg/String", "value": { "data": "hä?" },
        "count": 500 }));
    node.tell(json!({ "do": "publish", "topic": "/twist", "type": "geometry_msgs/msg/Twist",
        "value": { "linear": { "x": 1.5 }, "angular": { "z": -0.25 } }, "count": 500 }));
    assert_eq!(lrp.input("word"), json!({ "data": "hä?" }));
    let twist =
        |x: f64, z: f64| json!({ "linear": { "x": x, "y": 0.0, "z": 0.0 }, "angular": { "x": 0.0, "y": 0.0, "z": z } });
    assert_eq!(lrp.input("twist"), twist(1.5, -0.25));
    // To the first who listens a halt goes first, so it is there.
    let heard =
        |node: &mut Node, topic: &str| node.until_where("heard", |said| said["heard"] == topic)["value"].clone();
    assert_eq!(heard(&mut node, "/cmd_vel"), twist(0.0, 0.0));
    lrp.send("move", json!({ "linear": { "x": 0.2 } }));
    assert_eq!(heard(&mut node, "/cmd_vel"), twist(0.2, 0.0));
    lrp.send("say", json!({ "data": "grüß dich" }));
    assert_eq!(heard(&mut node, "/said"), json!({ "data": "grüß dich" }));
    let driver = Found { name: "/driver".into(), what: "node".into(), ..Found::default() };
    lrp.until("the node's name", |event| match event {
        Event::Found { found } => found.contains(&driver).then_some(()),
        _ => None,
    });
}

#[test]
fn qos_is_followed_and_what_does_not_fit_is_told() {
    let Some(()) = enter("cyclone::qos_is_followed_and_what_does_not_fit_is_told") else { return };
    let mut node = cyclone("driver");
    // Said once, before anybody listens.
    node.tell(json!({ "do": "publish", "topic": "/map", "type": "std_msgs/msg/String", "value": { "data": "here" },
        "qos": { "transient_local": true, "depth": 1 } }));
    node.tell(json!({ "do": "publish", "topic": "/light", "type": "std_msgs/msg/Int32", "value": { "data": 7 },
        "qos": { "best_effort": true }, "count": 3000 }));
    node.tell(json!({ "do": "subscribe", "topic": "/word", "type": "std_msgs/msg/String",
        "qos": { "transient_local": true } }));
    let mut lrp = bridge(json!({
        "subscribe": { "map": "/map", "light": "/light", "strict": "/light default" },
        "publish": { "say": "/word std_msgs/msg/String" },
    }));
    let (mut inputs, mut told) = (BTreeMap::new(), Vec::new());
    lrp.until("all of it", |event| {
        match event {
            Event::Input { name, value, .. } => {
                inputs.insert(name.clone(), value.clone());
            }
            Event::Log { level, message, .. } if message.contains("differ") => told.push((*level, message.clone())),
            _ => {}
        }
        (inputs.len() >= 2 && told.len() >= 2).then_some(())
    });
    assert_eq!(json!(inputs), json!({ "map": { "data": "here" }, "light": { "data": 7 } }));
    told.sort_by(|one, other| one.1.cmp(&other.1));
    let warned = |text: &str| (Level::Warn, text.to_string());
    assert_eq!(
        told,
        [
            warned(
                "input `strict` gets nothing from /driver on /light: they differ in reliability \
                 (offered: best effort, wanted: reliable); qos = \"match\"?"
            ),
            warned(
                "output `say` doesn't reach /driver on /word: they differ in durability \
                 (offered: volatile, wanted: transient local)"
            ),
        ]
    );
    // What is kept for those who come later reaches Cyclone as well.
    lrp.configure(json!({ "publish": { "say": "/word std_msgs/msg/String transient_local" } }));
    lrp.send("say", json!({ "data": "late" }));
    assert_eq!(node.until("heard")["value"], json!({ "data": "late" }));
}

#[test]
fn a_megabyte_passes_both_ways() {
    let Some(()) = enter("cyclone::a_megabyte_passes_both_ways") else { return };
    let mut node = cyclone("camera");
    let mut lrp = bridge(json!({
        "subscribe": { "image": "/image" },
        "publish": { "show": "/shown sensor_msgs/msg/Image transient_local" },
    }));
    let image = json!({ "height": 1000, "width": 1000, "encoding": "mono8", "step": 1000 });
    node.tell(json!({ "do": "publish", "topic": "/image", "type": "sensor_msgs/msg/Image", "value": image,
        "size": BIG, "qos": { "transient_local": true, "depth": 1 } }));
    let seen = lrp.input("image");
    assert_eq!(seen["encoding"], json!("mono8"));
    assert_eq!(value::as_bytes(&seen["data"]).map(|data| data.len()), Some(BIG));
    let mut ours = image;
    let data: Vec<u8> = (0..BIG).map(|at| at as u8).collect();
    ours["data"] = value::bytes(&data);
    lrp.send("show", ours);
    node.tell(json!({ "do": "subscribe", "topic": "/shown", "type": "sensor_msgs/msg/Image",
        "qos": { "transient_local": true, "depth": 1 } }));
    let heard = node.until("heard")["value"].take();
    assert_eq!(heard["encoding"], json!("mono8"));
    assert!(heard["data"] == json!(data), "{} other bytes", heard["data"].as_array().map_or(0, Vec::len));
}

#[test]
fn a_service_of_cyclone_is_called() {
    let Some(()) = enter("cyclone::a_service_of_cyclone_is_called") else { return };
    // Where much else is going on, finding each other takes its time.
    let light = json!({ "service": "/light", "type": "std_srvs/srv/SetBool", "timeout": 30_000 });
    let reset = json!({ "service": "/reset", "timeout": 30_000 });
    let mut lrp = bridge(json!({ "services": { "light": light, "reset": reset } }));
    // Asked before it is known whose the server is.
    let early = lrp.call("light", vec![json!({ "data": true })]);
    let mut node = cyclone("lamp");
    let asked =
        |node: &mut Node, service: &str| node.until_where("asked", |said| said["asked"] == service)["value"].clone();
    // A type that is found, and a request that has nothing in it.
    node.tell(json!({ "do": "serve", "service": "/reset", "type": "std_srvs/srv/Trigger",
        "reply": { "success": false, "message": "no" } }));
    lrp.until("the type of /reset", |event| match event {
        Event::Offer { description, .. } => {
            (description.function("reset")?.arguments[0].message == json!({})).then_some(())
        }
        _ => None,
    });
    let reset = lrp.call("reset", vec![json!({})]);
    assert_eq!(asked(&mut node, "/reset"), json!({}));
    assert_eq!(lrp.reply(reset), Ok(json!({ "success": false, "message": "no" })));
    node.tell(json!({ "do": "serve", "service": "/light", "type": "std_srvs/srv/SetBool",
        "reply": { "success": true, "message": "shines" } }));
    assert_eq!(asked(&mut node, "/light"), json!({ "data": true }));
    assert_eq!(lrp.reply(early), Ok(json!({ "success": true, "message": "shines" })));
    // Several at once.
    let calls = [true, false, true].map(|data| lrp.call("light", vec![json!({ "data": data })]));
    for (call, data) in calls.into_iter().zip([true, false, true]) {
        assert_eq!(asked(&mut node, "/light"), json!({ "data": data }));
        assert_eq!(lrp.reply(call), Ok(json!({ "success": true, "message": "shines" })));
    }
}

fn call(node: &mut Node, service: &str, kind: &str, value: Value) {
    node.tell(
        json!({ "do": "call", "service": format!("/lrp/{service}"), "type": format!("rcl_interfaces/srv/{kind}"),
        "value": value }),
    );
}

fn answer(node: &mut Node, service: &str) -> Value {
    let service = format!("/lrp/{service}");
    node.until_where("answer", |said| said["answer"] == service)["value"].clone()
}

#[test]
fn clients_of_both_vendors_read_and_set_our_parameters() {
    let Some(()) = enter("cyclone::clients_of_both_vendors_read_and_set_our_parameters") else { return };
    let mut lrp = bridge(json!({}));
    let variable = lrp_bridge::Variable { path: "speed".into(), value: json!(0.5) };
    lrp.order(Order::Variables { variables: vec![variable] });
    let (mut theirs, mut ros) = (cyclone("tuner"), Node::start("other"));
    let read = |node: &mut Node| {
        call(node, "get_parameters", "GetParameters", json!({ "names": ["speed", "none"] }));
        let values = answer(node, "get_parameters")["values"].clone();
        assert_eq!((&values[0]["type"], &values[0]["double_value"]), (&json!(3), &json!(0.5)));
        assert_eq!(values[1]["type"], json!(0));
    };
    read(&mut theirs);
    read(&mut ros);
    read(&mut theirs);
    let set = |lrp: &mut Peer, node: &mut Node, value: f64, error: Option<&str>| {
        let value = json!({ "type": 3, "double_value": value });
        let parameters = json!({ "parameters": [{ "name": "speed", "value": value }] });
        call(node, "set_parameters", "SetParameters", parameters);
        let (id, set) = lrp.until("set", |event| match event {
            Event::Set { id, value, .. } => Some((*id, value.clone())),
            _ => None,
        });
        assert_eq!(set, value["double_value"]);
        lrp.order(Order::Answer { id, error: error.map(str::to_string) });
        answer(node, "set_parameters")["results"][0].clone()
    };
    let taken = json!({ "successful": true, "reason": "" });
    let refused = json!({ "successful": false, "reason": "too slow" });
    assert_eq!(set(&mut lrp, &mut theirs, 0.75, None), taken);
    assert_eq!(set(&mut lrp, &mut ros, 1.25, None), taken);
    assert_eq!(set(&mut lrp, &mut theirs, 0.01, Some("too slow")), refused);
}

#[test]
fn the_form_can_say_the_mapping() {
    let Some(()) = enter("cyclone::the_form_can_say_the_mapping") else { return };
    let mut node = cyclone("lamp");
    node.tell(json!({ "do": "serve", "service": "/light", "type": "std_srvs/srv/SetBool",
        "reply": { "success": true, "message": "shines" } }));
    let config = |rmw: &str, timeout: u64| {
        let light = json!({ "service": "/light", "type": "std_srvs/srv/SetBool", "timeout": timeout });
        json!({ "services": { "light": light }, "rmw": rmw })
    };
    let mut lrp = bridge(config("rmw_cyclonedds_cpp", 30_000));
    let light = lrp.call("light", vec![json!({ "data": true })]);
    assert_eq!(lrp.reply(light), Ok(json!({ "success": true, "message": "shines" })));
    call(&mut node, "list_parameters", "ListParameters", json!({}));
    assert_eq!(answer(&mut node, "list_parameters")["result"]["names"], json!([]));
    // The other one is not understood.
    lrp.configure(config("fastrtps", 500));
    let light = lrp.call("light", vec![json!({ "data": true })]);
    assert_eq!(lrp.reply(light), Err("/light took too long".into()));
}
