//! Behaviours that drive by Nav2's action, on a robot of rclpy that has it.

use std::process::Command;

use serde_json::{Value, json};

use crate::peers;
use crate::programs::Program;
use crate::world::{Node, enter};

const STRING: &str = "std_msgs/msg/String";

const SEND: &str = "/navigate_to_pose/_action/send_goal";

/// As `enter`, where there is such a robot.
fn drive(test: &str) -> Option<()> {
    peers::navigation()?;
    enter(&format!("navigation::{test}"))
}

/// A behaviour as it is in its file.
fn source(name: &str) -> String {
    let text = std::fs::read_to_string(peers::behavior(name)).expect("a behaviour");
    // It runs in another folder.
    let there = peers::behavior("ros2/interfaces");
    changed(&text, r#"interfaces = "interfaces""#, &format!("interfaces = {there:?}"))
}

fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "`{from}` is gone");
    text.replace(from, to)
}

/// The robot, and the program that drives it once both have found each other.
fn both(text: &str) -> (Node, Program) {
    let mut robot = Node::of(peers::navigation().expect("a robot").arg("robot"));
    robot.tell(json!({ "do": "subscribe", "topic": "/say", "type": STRING }));
    let lrp = Program::start(text);
    robot.graph_where("lrp", |seen| has(seen, "publishers", "/say") && has(seen, "clients", SEND));
    (robot, lrp)
}

fn has(seen: &Value, key: &str, name: &str) -> bool {
    seen[key].as_array().is_some_and(|pairs| pairs.iter().any(|pair| pair[0] == name))
}

/// What a person says, to whoever listens now or later.
fn tell(robot: &mut Node, topic: &str, word: &str) {
    robot.tell(json!({ "do": "publish", "topic": topic, "type": STRING, "value": { "data": word },
        "qos": { "transient_local": true, "depth": 1 } }));
}

fn block(robot: &mut Node, x: f64, y: f64) {
    robot.tell(json!({ "do": "block", "x": x, "y": y }));
}

fn said(robot: &mut Node) -> String {
    robot.until("heard")["value"]["data"].as_str().expect("a word").to_string()
}

fn goal(robot: &mut Node) -> Value {
    let said = robot.until("goal");
    assert_eq!(said["accepted"], true, "{said}");
    said["goal"].clone()
}

fn trip(robot: &mut Node, to: Value) {
    assert_eq!(goal(robot), to);
    assert_eq!(robot.until("reached")["reached"], to);
}

#[test]
fn somebody_is_greeted_at_the_place_that_a_person_names() {
    let Some(()) = drive("somebody_is_greeted_at_the_place_that_a_person_names") else { return };
    let (mut robot, mut lrp) = both(&source("ros2/greet.lrp"));
    tell(&mut robot, "/place", "kitchen");
    lrp.until_in("greeter/driving");
    assert_eq!(goal(&mut robot), json!([2.0, 1.0]));
    // The program sees how far it still is.
    let left = |lrp: &mut Program, most: f64| {
        let is_left =
            |record: &Value| record["var"] == "left" && record["value"].as_f64().is_some_and(|left| left < most);
        lrp.until("set", is_left)["value"].as_f64().expect("a distance")
    };
    let first = left(&mut lrp, 5_f64.sqrt());
    left(&mut lrp, first);
    assert_eq!(robot.until("reached")["reached"], json!([2.0, 1.0]));
    lrp.until_in("greeter/greeting");
    assert_eq!(said(&mut robot), "Hello!");
    trip(&mut robot, json!([0.0, 0.0]));
    lrp.until_in("greeter/waiting");
}

#[test]
fn who_can_not_be_reached_is_told_of_and_the_robot_comes_home() {
    let Some(()) = drive("who_can_not_be_reached_is_told_of_and_the_robot_comes_home") else { return };
    // Further away than the map goes.
    let text = changed(&source("ros2/greet.lrp"), "home = {", "moon = { 384e6, 0.0 }, home = {");
    let (mut robot, mut lrp) = both(&text);
    block(&mut robot, 5.5, -1.0);
    tell(&mut robot, "/place", "office");
    for _ in 0..3 {
        assert_eq!(goal(&mut robot), json!([5.5, -1.0]));
        robot.until("stuck");
        let error = lrp.until("reply", |record| record["done"] == true)["error"].clone();
        assert_eq!(error, "/navigate_to_pose gave up: {\"error_code\":9003,\"error_msg\":\"something is in the way\"}");
    }
    assert_eq!(said(&mut robot), "I can't get to the office");
    trip(&mut robot, json!([0.0, 0.0]));
    lrp.until_in("greeter/waiting");
    tell(&mut robot, "/place", "moon");
    for _ in 0..3 {
        assert_eq!(robot.until("goal"), json!({ "goal": [384e6, 0.0], "accepted": false }));
        let error = lrp.until("reply", |record| record["done"] == true)["error"].clone();
        assert_eq!(error, "/navigate_to_pose rejected the goal");
    }
    assert_eq!(said(&mut robot), "I can't get to the moon");
    trip(&mut robot, json!([0.0, 0.0]));
}

#[test]
fn a_message_goes_to_all_that_can_be_reached_and_to_one_who_is_added_on_the_way() {
    let Some(()) = drive("a_message_goes_to_all_that_can_be_reached_and_to_one_who_is_added_on_the_way") else {
        return;
    };
    let text = source("ros2/deliver.lrp");
    let (mut robot, mut lrp) = both(&text);
    block(&mut robot, 5.5, -1.0);
    tell(&mut robot, "/order", "lunch!");
    lrp.until_in("courier/driving");
    // Carl is hungry, too.
    lrp.save(&changed(&text, r#"{ "home","#, r#"{ "Carl", 3.0, 3.0 }, { "home","#));
    assert_eq!(lrp.until("load", |_| true)["restarted"], false);
    trip(&mut robot, json!([2.0, 1.0]));
    assert_eq!(said(&mut robot), "Anna: lunch!");
    assert_eq!(goal(&mut robot), json!([5.5, -1.0]));
    robot.until("stuck");
    trip(&mut robot, json!([3.0, 3.0]));
    assert_eq!(said(&mut robot), "Carl: lunch!");
    trip(&mut robot, json!([0.0, 0.0]));
    assert_eq!(said(&mut robot), "I missed Ben");
    lrp.until_in("courier/waiting");
}

#[test]
fn the_robot_halts_on_the_way_when_the_program_begins_again_lrp_ends_or_is_killed() {
    let Some(()) = drive("the_robot_halts_on_the_way_when_the_program_begins_again_lrp_ends_or_is_killed") else {
        return;
    };
    let text = source("ros2/deliver.lrp");
    for end in ["an edit", "TERM", "KILL"] {
        println!("by {end}");
        let (mut robot, mut lrp) = both(&text);
        // So slow that it doesn't get there.
        robot.tell(json!({ "do": "drive_at", "velocity": 0.01 }));
        tell(&mut robot, "/order", "lunch!");
        let far = goal(&mut robot);
        lrp.until("reply", |record| record["done"] == false);
        if end == "an edit" {
            lrp.save(&changed(&text, "stop = stop + 1", "stop = 1 + stop"));
            lrp.until("restart", |_| true);
        } else {
            let sent = Command::new("kill").args(["-s", end]).arg(lrp.id().to_string()).status().expect("kill");
            assert!(sent.success());
        }
        assert_eq!(robot.until("cancel")["cancel"], far);
        robot.until("halted");
    }
}
