//! The program's form: what it can say, and the help for it.

mod entries;
mod network;
mod read;

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::path::PathBuf;
use std::time::Duration;

use lrp_bridge::{Level, Setting};

use crate::dds::qos::Wish;
use crate::mapping::Mapping;
use crate::names::Names;

#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    pub network: Network,
    pub names: Names,
    pub subscribe: BTreeMap<String, Topic>,
    pub publish: BTreeMap<String, Topic>,
    pub services: BTreeMap<String, Callable>,
    pub actions: BTreeMap<String, Callable>,
    /// Whether the program's variables are parameters of our node.
    pub parameters: bool,
    /// The least of others' log messages that are shown.
    pub rosout: Option<Level>,
    /// The topic that tells the machines' states.
    pub states: Option<String>,
    pub use_sim_time: bool,
    pub mapping: Option<Mapping>,
    /// Folders with definitions of types, each as PACKAGE/msg/NAME.msg below them.
    pub interfaces: Vec<PathBuf>,
}

/// What can't be changed without leaving and joining anew.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    pub domain: u16,
    /// None: all networks.
    pub only: Option<Vec<IpAddr>>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Topic {
    pub name: String,
    pub type_name: Option<String>,
    pub qos: Wish,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Callable {
    pub name: String,
    pub type_name: Option<String>,
    /// Of an action none: it takes as long as it takes.
    pub timeout: Option<Duration>,
}

pub fn settings() -> Vec<Setting> {
    let setting = |name: &str, doc: &str, example: &str| Setting::new(name, doc).example(example);
    vec![
        setting("subscribe", "inputs: name = topic; type and QoS are found where not given", r#"{ odom = "/odom" }"#),
        setting("publish", "outputs: name = topic and type", r#"{ move = "/cmd_vel geometry_msgs/msg/Twist" }"#),
        setting("services", "calls: name = service, and its type where it isn't up yet", r#"{ reset = "/reset" }"#),
        setting("actions", "calls with feedback: name = action", r#"{ go = "/navigate_to_pose" }"#),
        setting("parameters", "offer the program's variables as parameters of our node; default true", "false"),
        setting("rosout", "least level of others' logs to show, or false; default info", r#""warn""#),
        setting("states", "topic that tells the machines' states, or false; default ~/states", r#""~/states""#),
        setting("use_sim_time", "program time follows /clock; default false", "true"),
        setting("node", "our node's name; default lrp", r#""greeter""#),
        setting("namespace", "where relative names begin; default /", r#""/robot""#),
        setting("remap", "names that stand for others", r#"{ ["/cmd_vel"] = "/base/cmd_vel" }"#),
        setting("domain", "DDS domain, 0..232; default ROS_DOMAIN_ID or 0", "7"),
        setting(
            "localhost",
            "talk to this machine only; default as ROS_LOCALHOST_ONLY or ROS_AUTOMATIC_DISCOVERY_RANGE says",
            "true",
        ),
        setting("interface", "the network interface to use, by name or address", r#""wlan0""#),
        setting("interfaces", "folder or folders with definitions, as PACKAGE/msg/NAME.msg", r#""interfaces""#),
        setting(
            "rmw",
            "how services are mapped, fastrtps or cyclonedds; default: as the other side does",
            r#""cyclonedds""#,
        ),
    ]
}
