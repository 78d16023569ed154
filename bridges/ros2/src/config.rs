//! The program's form: what it says, what is wrong with it, and what the environment says where it doesn't.

use std::collections::BTreeMap;
use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::time::Duration;

use lrp_bridge::{Level, Problem, Setting};
use serde_json::{Map, Value};

use crate::dds::qos::{Qos, Wish};
use crate::names::{Names, full_type, wrong};

/// How long a service may take to answer, or to come up.
const PATIENCE: Duration = Duration::from_secs(5);

/// RustDDS computes its ports from it.
const HIGHEST_DOMAIN: u16 = 232;

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

/// How a request says whose it is, which vendors do differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// Beside the payload.
    FastDds,
    /// In front of it.
    Cyclone,
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
        setting("localhost", "talk to this machine only; default as ROS_LOCALHOST_ONLY says", "true"),
        setting("interface", "the network interface to use, by name or address", r#""wlan0""#),
        setting("interfaces", "folder or folders with definitions, as PACKAGE/msg/NAME.msg", r#""interfaces""#),
        setting(
            "rmw",
            "how services are mapped, fastrtps or cyclonedds; default: as the server does",
            r#""cyclonedds""#,
        ),
    ]
}

impl Config {
    /// Relative paths in it begin at a folder.
    pub fn read(config: &Value, folder: &Path) -> Result<Config, Vec<Problem>> {
        let empty = Map::new();
        let form = match config {
            Value::Object(form) => form,
            // An empty table of Lua.
            Value::Array(items) if items.is_empty() => &empty,
            Value::Null => &empty,
            _ => return Err(vec![Problem::new("the configuration is not a table")]),
        };
        let mut reader = Reader { form, folder, problems: Vec::new() };
        let config = reader.config();
        if reader.problems.is_empty() { Ok(config) } else { Err(reader.problems) }
    }
}

struct Reader<'a> {
    form: &'a Map<String, Value>,
    folder: &'a Path,
    problems: Vec<Problem>,
}

impl Reader<'_> {
    fn config(&mut self) -> Config {
        self.check_keys();
        let names = self.names();
        let network = self.network();
        let subscribe = self.topics("subscribe", &names);
        let publish = self.topics("publish", &names);
        let services = self.callables("services", "srv", Some(PATIENCE), &names);
        let actions = self.callables("actions", "action", None, &names);
        let config = Config {
            subscribe,
            publish,
            services,
            actions,
            parameters: self.flag("parameters").unwrap_or(true),
            rosout: self.rosout(),
            states: self.states(&names),
            use_sim_time: self.flag("use_sim_time").unwrap_or(false),
            mapping: self.mapping(),
            interfaces: self.interfaces(),
            network,
            names,
        };
        self.check_names(&config);
        config
    }

    fn check_keys(&mut self) {
        let known: Vec<String> = settings().into_iter().map(|setting| setting.name).collect();
        for key in self.form.keys().filter(|key| !known.contains(key)) {
            let help = format!("one of: {}", known.join(", "));
            self.problems.push(Problem::new(format!("ros2 has no setting `{key}`")).help(help).at(key));
        }
    }

    /// What an input, output or call is called must be one thing only.
    fn check_names(&mut self, config: &Config) {
        let mut seen: Vec<&str> = crate::parameters::CALLS.to_vec();
        let groups = [
            ("publish", config.publish.keys().collect::<Vec<_>>()),
            ("services", config.services.keys().collect()),
            ("actions", config.actions.keys().collect()),
        ];
        for (group, names) in &groups {
            for name in names {
                if seen.contains(&name.as_str()) {
                    self.wrong(format!("`{name}` is already called so"), "another name", &format!("{group}.{name}"));
                }
                seen.push(name);
            }
        }
    }

    fn wrong(&mut self, what: impl Into<String>, help: &str, key: &str) {
        self.problems.push(Problem::new(what).help(help).at(key));
    }

    fn text(&mut self, key: &str) -> Option<String> {
        match self.form.get(key)? {
            Value::String(text) => Some(text.clone()),
            Value::Null => None,
            other => {
                self.wrong(format!("{other} is no text"), "a text in quotes", key);
                None
            }
        }
    }

    fn flag(&mut self, key: &str) -> Option<bool> {
        match self.form.get(key)? {
            Value::Bool(flag) => Some(*flag),
            Value::Null => None,
            other => {
                self.wrong(format!("{other} is neither true nor false"), "true or false", key);
                None
            }
        }
    }

    fn table(&mut self, key: &str) -> Map<String, Value> {
        match self.form.get(key) {
            Some(Value::Object(table)) => table.clone(),
            Some(Value::Array(items)) if items.is_empty() => Map::new(),
            None | Some(Value::Null) => Map::new(),
            Some(_) => {
                self.wrong(format!("`{key}` is not a table with names"), r#"{ name = "/topic" }"#, key);
                Map::new()
            }
        }
    }

    fn names(&mut self) -> Names {
        let node = self.text("node").unwrap_or_else(|| "lrp".to_string());
        if node.contains('/') || wrong(&node).is_some() {
            self.wrong(format!("`{node}` is no name for a node"), "letters, digits and _", "node");
        }
        let namespace = self.text("namespace").unwrap_or_default();
        let namespace = namespace.trim_matches('/');
        if let Some(wrong) = wrong(namespace).filter(|_| !namespace.is_empty()) {
            self.wrong(wrong, "letters, digits and _, with / between", "namespace");
        }
        let mut remaps = Vec::new();
        for (from, to) in self.table("remap") {
            match to.as_str() {
                Some(to) if wrong(to).is_none() && wrong(&from).is_none() => remaps.push((from, to.to_string())),
                _ => self.wrong(format!("`{from}` can't stand for {to}"), "names of topics", &format!("remap.{from}")),
            }
        }
        Names::new(namespace, &node, remaps)
    }

    fn network(&mut self) -> Network {
        let domain = match self.form.get("domain") {
            None | Some(Value::Null) => domain_of_environment().unwrap_or_else(|wrong| {
                self.wrong(wrong, "export ROS_DOMAIN_ID=0, or `domain = 0` in the form", "domain");
                0
            }),
            Some(value) => {
                let domain = value.as_f64().filter(|domain| domain.fract() == 0.0 && *domain >= 0.0);
                match domain.filter(|domain| *domain <= HIGHEST_DOMAIN.into()) {
                    Some(domain) => domain as u16,
                    None => {
                        self.wrong(format!("{value} is no domain"), "a number from 0 to 232", "domain");
                        0
                    }
                }
            }
        };
        let localhost = self.flag("localhost").unwrap_or_else(localhost_of_environment);
        let only = match self.text("interface") {
            Some(interface) => match addresses(&interface) {
                addresses if addresses.is_empty() => {
                    self.wrong(
                        format!("there is no network interface `{interface}`"),
                        &format!("one of: {}", interfaces().join(", ")),
                        "interface",
                    );
                    None
                }
                addresses => Some(addresses),
            },
            None => localhost.then(|| vec![IpAddr::V4(Ipv4Addr::LOCALHOST)]),
        };
        Network { domain, only }
    }

    fn topics(&mut self, key: &str, names: &Names) -> BTreeMap<String, Topic> {
        let mut topics = BTreeMap::new();
        for (name, value) in self.table(key) {
            let place = format!("{key}.{name}");
            match topic(&value, names, &place, key == "publish") {
                Ok(topic) => {
                    topics.insert(name, topic);
                }
                Err(problem) => self.problems.push(problem),
            }
        }
        topics
    }

    fn callables(
        &mut self,
        key: &str,
        family: &str,
        patience: Option<Duration>,
        names: &Names,
    ) -> BTreeMap<String, Callable> {
        let mut callables = BTreeMap::new();
        for (name, value) in self.table(key) {
            let place = format!("{key}.{name}");
            match callable(&value, family, patience, names, &place) {
                Ok(callable) => {
                    callables.insert(name, callable);
                }
                Err(problem) => self.problems.push(problem),
            }
        }
        callables
    }

    fn rosout(&mut self) -> Option<Level> {
        match self.form.get("rosout") {
            None | Some(Value::Null | Value::Bool(true)) => Some(Level::Info),
            Some(Value::Bool(false)) => None,
            Some(Value::String(level)) => match level.as_str() {
                "debug" => Some(Level::Debug),
                "info" => Some(Level::Info),
                "warn" => Some(Level::Warn),
                "error" => Some(Level::Error),
                _ => {
                    self.wrong(format!("no level is called `{level}`"), "debug, info, warn, error or false", "rosout");
                    None
                }
            },
            Some(other) => {
                self.wrong(format!("{other} is no level"), "debug, info, warn, error or false", "rosout");
                None
            }
        }
    }

    fn states(&mut self, names: &Names) -> Option<String> {
        match self.form.get("states") {
            None | Some(Value::Null | Value::Bool(true)) => Some(names.resolve("~/states")),
            Some(Value::Bool(false)) => None,
            Some(Value::String(topic)) => match wrong(topic) {
                Some(wrong) => {
                    self.wrong(wrong, "a topic, or false", "states");
                    None
                }
                None => Some(names.resolve(topic)),
            },
            Some(other) => {
                self.wrong(format!("{other} is no topic"), "a topic, or false", "states");
                None
            }
        }
    }

    fn interfaces(&mut self) -> Vec<PathBuf> {
        let said = match self.form.get("interfaces") {
            None | Some(Value::Null) => return Vec::new(),
            Some(Value::Array(said)) => said.iter().collect(),
            Some(said) => vec![said],
        };
        let folders: Option<Vec<PathBuf>> = said.iter().map(|said| Some(self.folder.join(said.as_str()?))).collect();
        if folders.is_none() {
            self.wrong("`interfaces` names no folders", "a path, or a list of paths", "interfaces");
        }
        folders.unwrap_or_default()
    }

    fn mapping(&mut self) -> Option<Mapping> {
        match self.text("rmw")?.trim_start_matches("rmw_").trim_end_matches("_cpp") {
            "fastrtps" => Some(Mapping::FastDds),
            "cyclonedds" => Some(Mapping::Cyclone),
            other => {
                let what = format!("services of `{other}` are not known here");
                self.wrong(what, "fastrtps or cyclonedds, or leave it away", "rmw");
                None
            }
        }
    }
}

/// `"/scan"`, `"/scan sensor_msgs/msg/LaserScan sensor_data"`, or a table with `topic`, `type` and `qos`.
fn topic(value: &Value, names: &Names, key: &str, publishes: bool) -> Result<Topic, Problem> {
    let said = said(value, "topic", key, &["topic", "type", "qos"])?;
    let qos = match &said.qos {
        Some(qos) => Wish::read(qos, key)?,
        None if publishes => Wish::Exactly(Qos::DEFAULT),
        None => Wish::Match { depth: Qos::DEFAULT.depth },
    };
    Ok(Topic { name: names.resolve(&said.name), type_name: said.type_name("msg", key)?, qos })
}

fn callable(
    value: &Value,
    family: &str,
    patience: Option<Duration>,
    names: &Names,
    key: &str,
) -> Result<Callable, Problem> {
    let word = if family == "srv" { "service" } else { "action" };
    let said = said(value, word, key, &[word, "type", "timeout"])?;
    let timeout = match value.get("timeout") {
        None | Some(Value::Null) => patience,
        Some(timeout) => match timeout.as_f64().filter(|timeout| *timeout > 0.0 && *timeout < 1e12) {
            Some(timeout) => Some(Duration::from_millis(timeout as u64)),
            None => {
                let problem = Problem::new(format!("{timeout} is no time-out")).at(key);
                return Err(problem.help("milliseconds, as `timeout = 2000`"));
            }
        },
    };
    Ok(Callable { name: names.resolve(&said.name), type_name: said.type_name(family, key)?, timeout })
}

/// The parts of an entry.
struct Said {
    name: String,
    type_name: Option<String>,
    qos: Option<Value>,
}

impl Said {
    fn type_name(&self, family: &str, key: &str) -> Result<Option<String>, Problem> {
        let full = self.type_name.as_ref().map(|name| full_type(name, family)).transpose();
        full.map_err(|wrong| Problem::new(wrong).at(key))
    }
}

fn said(value: &Value, word: &str, key: &str, keys: &[&str]) -> Result<Said, Problem> {
    let said = match value {
        Value::String(text) => said_in_words(text, key)?,
        Value::Object(table) => {
            if let Some(unknown) = table.keys().find(|name| !keys.contains(&name.as_str())) {
                let problem = Problem::new(format!("no {word} has a `{unknown}`")).at(key);
                return Err(problem.help(format!("one of: {}", keys.join(", "))));
            }
            let text = |name| table.get(name).and_then(Value::as_str).map(str::to_string);
            Said { name: text(word).unwrap_or_default(), type_name: text("type"), qos: table.get("qos").cloned() }
        }
        _ => Said { name: String::new(), type_name: None, qos: None },
    };
    if said.name.is_empty() {
        let problem = Problem::new(format!("which {word}?")).at(key);
        return Err(problem.help(format!(r#""/name" or {{ {word} = "/name" }}"#)));
    }
    match wrong(&said.name) {
        Some(wrong) => Err(Problem::new(wrong).at(key)),
        None => Ok(said),
    }
}

fn said_in_words(text: &str, key: &str) -> Result<Said, Problem> {
    let mut words = text.split_whitespace();
    let mut said = Said { name: words.next().unwrap_or_default().to_string(), type_name: None, qos: None };
    for word in words {
        if word.contains('/') && said.type_name.is_none() {
            said.type_name = Some(word.to_string());
        } else if Qos::named(word).is_some() && said.qos.is_none() {
            said.qos = Some(Value::String(word.to_string()));
        } else {
            let problem = Problem::new(format!("`{word}` is neither a type nor a QoS profile")).at(key);
            return Err(problem.help("\"/topic package/msg/Type profile\""));
        }
    }
    Ok(said)
}

fn domain_of_environment() -> Result<u16, String> {
    match std::env::var("ROS_DOMAIN_ID") {
        Ok(text) if !text.trim().is_empty() => {
            let domain = text.trim().parse().ok().filter(|domain| *domain <= HIGHEST_DOMAIN);
            domain.ok_or(format!("ROS_DOMAIN_ID is `{text}`, which is no domain"))
        }
        _ => Ok(0),
    }
}

fn localhost_of_environment() -> bool {
    let range = std::env::var("ROS_AUTOMATIC_DISCOVERY_RANGE").unwrap_or_default();
    let only = std::env::var("ROS_LOCALHOST_ONLY").unwrap_or_default();
    matches!(range.as_str(), "LOCALHOST" | "OFF") || only == "1"
}

/// Of an interface by its name, or an address itself.
fn addresses(interface: &str) -> Vec<IpAddr> {
    if let Ok(address) = interface.parse() {
        return vec![address];
    }
    let known = netdev::get_interfaces().into_iter().filter(|known| known.name == interface);
    known.flat_map(|known| known.ipv4).map(|network| IpAddr::V4(network.addr())).collect()
}

fn interfaces() -> Vec<String> {
    netdev::get_interfaces().into_iter().map(|known| known.name).collect()
}
