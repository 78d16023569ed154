//! The program's form: what it may say, and what is said of mistakes in it.

use lrp_bridge::{Bridge, Problem};
use lrp_bridge_ros2::Ros2;
use serde_json::{Value, json};

pub fn problems(config: Value) -> Vec<String> {
    let told = |problem: Problem| {
        format!("{}: {} ({})", problem.key.unwrap_or_default(), problem.message, problem.help.unwrap_or_default())
    };
    Ros2::offer(&config).expect_err("problems").into_iter().map(told).collect()
}

#[test]
fn what_is_offered_has_the_shape_of_its_types() {
    let offer = Ros2::offer(&json!({
        "subscribe": { "light": "/light std_msgs/msg/Int32", "odom": "/odom" },
        "publish": { "move": { "topic": "/cmd_vel", "type": "geometry_msgs/Twist", "qos": { "depth": 1 } } },
        "services": { "reset": "/reset std_srvs/srv/SetBool" },
        "actions": { "go": "/navigate_to_pose" },
    }))
    .expect("an offer");
    assert_eq!(offer.input("light").map(|port| &port.message), Some(&json!({ "data": 0 })));
    assert_eq!(offer.input("odom").map(|port| &port.message), Some(&Value::Null));
    let vector = json!({ "x": 0.0, "y": 0.0, "z": 0.0 });
    let twist = json!({ "linear": vector, "angular": vector });
    assert_eq!(offer.output("move").map(|port| &port.message), Some(&twist));
    assert_eq!(offer.function("reset").map(|call| &call.arguments[0].message), Some(&json!({ "data": false })));
    assert!(offer.function("go").is_some());
    assert!(offer.function("set_parameter").is_some());
}

#[test]
fn mistakes_name_the_key_and_what_would_do() {
    assert_eq!(
        problems(json!({ "subscribe": { "a": "/a", "b": "/b/" } })),
        ["subscribe.b: `/b/` has an empty part ()"]
    );
    assert_eq!(
        problems(json!({ "publish": { "m": "/cmd_vel geometry_msgs/msg/Twits" } })),
        ["publish.m: there is no type geometry_msgs/msg/Twits (geometry_msgs/msg has no Twits; Twist?)"]
    );
    assert_eq!(
        problems(json!({ "publish": { "m": "/cmd_vel twist" } })),
        ["publish.m: `twist` is neither a type nor a QoS profile (\"/topic package/msg/Type profile\")"]
    );
    assert_eq!(
        problems(json!({ "subscribe": { "s": { "topic": "/s", "qos": { "reliability": "some" } } } })),
        ["subscribe.s: no QoS has `reliability = \"some\"` \
         (one of: profile, reliability, durability, depth, deadline, lifespan, lease)"]
    );
    assert_eq!(
        problems(json!({ "services": { "get_parameter": "/x" } })),
        ["services.get_parameter: `get_parameter` is already called so (another name)"]
    );
    assert_eq!(problems(json!({ "domain": 300 })), ["domain: 300 is no domain (a number from 0 to 232)"]);
    let told = problems(json!({ "suscribe": {} }));
    assert!(told[0].starts_with("suscribe: ros2 has no setting `suscribe` (one of: subscribe, publish, "), "{told:?}");
}
