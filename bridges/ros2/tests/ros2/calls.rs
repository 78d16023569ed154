//! Services, actions and parameters with a real ROS on the other side.

use std::time::Duration;

use lrp_bridge::{Event, Order, Peer};
use serde_json::{Value, json};

use crate::peers;
use crate::topics::bridge;
use crate::world::{Node, enter};

#[test]
fn services_answer_are_late_or_are_not_there_yet() {
    let Some(()) = enter("calls::services_answer_are_late_or_are_not_there_yet") else { return };
    let mut lrp = bridge(json!({ "services": {
        "light": "/light std_srvs/srv/SetBool",
        "slow": { "service": "/slow", "type": "std_srvs/Trigger", "timeout": 300 },
        "found": "/light",
    } }));
    let slow = lrp.call("slow", vec![json!({})]);
    assert_eq!(lrp.reply(slow), Err("no server of /slow (std_srvs/srv/Trigger) has come up".into()));
    // Asked before the server is up.
    let early = lrp.call("light", vec![json!({ "data": true })]);
    let wrong = lrp.call("light", vec![json!({ "on": true })]);
    assert_eq!(lrp.reply(wrong), Err("std_srvs/srv/SetBool_Request has no field `on`, its fields are: data".into()));
    let mut node = Node::start("lamp");
    node.tell(json!({ "do": "serve", "service": "/light", "type": "std_srvs/srv/SetBool",
        "reply": { "success": true, "message": "shines" } }));
    assert_eq!(node.until("asked")["value"], json!({ "data": true }));
    assert_eq!(lrp.reply(early), Ok(json!({ "success": true, "message": "shines" })));
    // The type was found by now.
    let found = lrp.call("found", vec![json!({})]);
    assert_eq!(lrp.reply(found), Ok(json!({ "success": true, "message": "shines" })));
    node.tell(json!({ "do": "serve", "service": "/slow", "type": "std_srvs/srv/Trigger", "reply": {}, "delay": 1.0 }));
    let slow = lrp.call("slow", vec![json!({})]);
    let said = lrp.reply(slow).expect_err("a late reply");
    assert!(said == "/slow took too long" || said.contains("has come up"), "{said}");
}

/// With the definitions of what isn't bundled.
fn actions(actions: Value) -> Value {
    json!({ "actions": actions, "interfaces": peers::share() })
}

/// Until the type of an action has been found.
fn known(lrp: &mut Peer, action: &str) {
    lrp.until("the action's type", |event| match event {
        Event::Offer { description, .. } => {
            let message = &description.function(action)?.arguments[0].message;
            (message == &json!({ "order": 0 })).then_some(())
        }
        _ => None,
    });
}

fn feedback(lrp: &mut Peer, call: u64) -> Value {
    lrp.until("feedback", |event| match event {
        Event::Feedback { id, value } if *id == call => Some(value.clone()),
        _ => None,
    })
}

#[test]
fn actions_have_feedback_and_end_in_all_ways() {
    let Some(()) = enter("calls::actions_have_feedback_and_end_in_all_ways") else { return };
    let mut lrp = bridge(actions(json!({ "count": "/count" })));
    let mut node = Node::start("counter");
    let act = |how: &str| {
        json!({ "do": "act", "action": "/count", "type": "test_msgs/action/Fibonacci", "how": how,
        "feedback": [{ "sequence": [0, 1] }], "result": { "sequence": [0, 1, 1] } })
    };
    node.tell(act("succeed"));
    known(&mut lrp, "count");
    let call = lrp.call("count", vec![json!({ "order": 3 })]);
    assert_eq!(node.until("goal")["value"]["order"], json!(3));
    assert_eq!(feedback(&mut lrp, call), json!({ "sequence": [0, 1] }));
    assert_eq!(lrp.reply(call), Ok(json!({ "sequence": [0, 1, 1] })));
    for (action, how, outcome) in [
        ("abort", "abort", "/abort gave up: {\"sequence\":[0,1,1]}"),
        ("reject", "reject", "/reject rejected the goal"),
    ] {
        let mut order = act(how);
        order["action"] = json!(format!("/{action}"));
        node.tell(order);
        lrp.configure(actions(json!({ "count": format!("/{action}") })));
        known(&mut lrp, "count");
        let call = lrp.call("count", vec![json!({ "order": 3 })]);
        assert_eq!(lrp.reply(call), Err(outcome.to_string()));
    }
}

#[test]
fn goals_are_cancelled_by_the_program_by_stop_and_by_time() {
    let Some(()) = enter("calls::goals_are_cancelled_by_the_program_by_stop_and_by_time") else { return };
    let mut node = Node::start("counter");
    node.tell(json!({ "do": "act", "action": "/count", "type": "test_msgs/action/Fibonacci", "how": "run",
        "feedback": [{ "sequence": [0] }] }));
    let mut lrp = bridge(actions(json!({ "count": "/count", "short": { "action": "/count", "timeout": 600 } })));
    known(&mut lrp, "short");
    let call = lrp.call("count", vec![json!({ "order": 1 })]);
    feedback(&mut lrp, call);
    lrp.order(Order::Cancel { id: call });
    node.until("cancel");
    assert_eq!(lrp.reply(call), Err("cancelled by the program".into()));
    let call = lrp.call("count", vec![json!({ "order": 2 })]);
    feedback(&mut lrp, call);
    lrp.order(Order::Stop);
    node.until("cancel");
    assert_eq!(lrp.reply(call), Err("the robot was stopped".into()));
    let call = lrp.call("short", vec![json!({ "order": 3 })]);
    node.until("cancel");
    assert_eq!(lrp.reply(call), Err("the goal took too long".into()));
    // A server that goes leaves no call open.
    let call = lrp.call("count", vec![json!({ "order": 4 })]);
    feedback(&mut lrp, call);
    node.leave();
    let said = lrp.until("reply", |event| match event {
        Event::Reply { id, error: Some(error), .. } if *id == call => Some(error.clone()),
        _ => None,
    });
    assert_eq!(said, "the server of /count/_action/get_result is gone");
}

#[test]
fn parameters_of_others_are_read_and_set() {
    let Some(()) = enter("calls::parameters_of_others_are_read_and_set") else { return };
    let mut node = Node::start("driver");
    node.tell(json!({ "do": "declare", "name": "speed", "value": 0.5 }));
    node.tell(json!({ "do": "declare", "name": "names", "value": ["a", "b"] }));
    let mut lrp = bridge(json!({}));
    let ask = |lrp: &mut Peer, name: &str, arguments: Value| {
        let Value::Array(arguments) = arguments else { panic!("no arguments") };
        let call = lrp.call(name, arguments);
        lrp.reply(call)
    };
    assert_eq!(ask(&mut lrp, "get_parameter", json!(["/driver", "speed"])), Ok(json!(0.5)));
    assert_eq!(ask(&mut lrp, "get_parameter", json!(["driver", "names"])), Ok(json!(["a", "b"])));
    assert_eq!(
        ask(&mut lrp, "get_parameter", json!(["/driver", "sped"])),
        Err("there is no parameter `sped`, or it has no value".into())
    );
    // A whole number for a double.
    assert_eq!(ask(&mut lrp, "set_parameter", json!(["/driver", "speed", 2])), Ok(json!(true)));
    node.tell(json!({ "do": "read", "name": "speed" }));
    assert_eq!(node.until("parameter")["value"], json!(2.0));
    assert_eq!(
        ask(&mut lrp, "set_parameter", json!(["/driver", "speed", "fast"])),
        Err("`speed` is double, not \"fast\"".into())
    );
    let names = ask(&mut lrp, "list_parameters", json!(["/driver"])).expect("names");
    assert!(names.as_array().is_some_and(|names| names.contains(&json!("speed"))), "{names}");
}

#[test]
fn the_programs_variables_are_parameters_of_our_node() {
    let Some(()) = enter("calls::the_programs_variables_are_parameters_of_our_node") else { return };
    let mut lrp = bridge(json!({}));
    let variable = |path: &str, value: Value| lrp_bridge::Variable { path: path.into(), value };
    lrp.order(Order::Variables {
        variables: vec![
            variable("speed", json!(0.5)),
            variable("follower/seen", json!(true)),
            variable("follower/table", json!({ "x": 1 })),
        ],
    });
    let mut node = Node::start("tuner");
    let call = |node: &mut Node, service: &str, kind: &str, value: Value| {
        let service = format!("/lrp/{service}");
        node.tell(json!({ "do": "call", "service": service, "type": format!("rcl_interfaces/srv/{kind}"),
            "value": value }));
        service
    };
    let answer =
        |node: &mut Node, service: &str| node.until_where("answer", |said| said["answer"] == service)["value"].clone();
    let list = call(&mut node, "list_parameters", "ListParameters", json!({}));
    assert_eq!(answer(&mut node, &list)["result"]["names"], json!(["follower.seen", "speed"]));
    let get = call(&mut node, "get_parameters", "GetParameters", json!({ "names": ["speed", "none"] }));
    let values = answer(&mut node, &get)["values"].clone();
    assert_eq!((&values[0]["type"], &values[0]["double_value"]), (&json!(3), &json!(0.5)));
    assert_eq!(values[1]["type"], json!(0));
    // What is set goes to the program, which takes or refuses it.
    let parameter = |name: &str, value: Value| json!({ "name": name, "value": value });
    let set = call(
        &mut node,
        "set_parameters",
        "SetParameters",
        json!({ "parameters": [
        parameter("speed", json!({ "type": 3, "double_value": 0.75 })),
        parameter("speed", json!({ "type": 4, "string_value": "fast" })),
        parameter("follower.seen", json!({ "type": 1, "bool_value": false })),
        parameter("none", json!({ "type": 1 })),
    ] }),
    );
    for (wanted, error) in [(("speed", json!(0.75)), None), (("follower/seen", json!(false)), Some("it isn't running"))]
    {
        let (id, variable, value) = lrp.until("set", |event| match event {
            Event::Set { id, variable, value } => Some((*id, variable.clone(), value.clone())),
            _ => None,
        });
        assert_eq!((variable.as_str(), value), wanted);
        lrp.order(Order::Answer { id, error: error.map(str::to_string) });
    }
    let results = answer(&mut node, &set)["results"].clone();
    let result = |at: usize| (results[at]["successful"].clone(), results[at]["reason"].clone());
    assert_eq!(result(0), (json!(true), json!("")));
    assert_eq!(result(1), (json!(false), json!("`speed` is double, not string")));
    assert_eq!(result(2), (json!(false), json!("it isn't running")));
    assert_eq!(result(3), (json!(false), json!("the program has no variable `none`")));
    assert!(lrp.event(Duration::from_millis(1)).is_none_or(|event| !matches!(event, Event::Set { .. })));
}

#[test]
fn a_goal_that_is_given_up_before_it_is_accepted_is_cancelled() {
    let Some(()) = enter("calls::a_goal_that_is_given_up_before_it_is_accepted_is_cancelled") else { return };
    let mut node = Node::start("counter");
    node.tell(json!({ "do": "act", "action": "/count", "type": "test_msgs/action/Fibonacci", "how": "run",
        "feedback": [{ "sequence": [0] }], "judging": 1.0 }));
    let hasty = json!({ "action": "/count", "timeout": 500 });
    let mut lrp = bridge(actions(json!({ "count": "/count", "hasty": hasty })));
    known(&mut lrp, "hasty");
    let call = lrp.call("count", vec![json!({ "order": 1 })]);
    node.until("goal");
    lrp.order(Order::Stop);
    node.until("cancel");
    assert_eq!(lrp.reply(call), Err("the robot was stopped".into()));
    let late = lrp.call("hasty", vec![json!({ "order": 1 })]);
    node.until("goal");
    assert_eq!(lrp.reply(late), Err("/count/_action/send_goal took too long".into()));
    node.until("cancel");
}
