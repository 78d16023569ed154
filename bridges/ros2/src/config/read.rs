//! Reading the program's form: all that is wrong with it is told at once, each with its key.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use lrp_bridge::{Level, Problem};
use serde_json::{Map, Value};

use super::entries::{callable, topic};
use super::network::network;
use super::{Callable, Config, Topic, settings};
use crate::mapping::Mapping;
use crate::names::{Names, wrong};

/// How long a service may take to answer, or to come up.
const PATIENCE: Duration = Duration::from_secs(5);

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

pub(super) struct Reader<'a> {
    pub(super) form: &'a Map<String, Value>,
    folder: &'a Path,
    problems: Vec<Problem>,
}

impl Reader<'_> {
    fn config(&mut self) -> Config {
        self.check_keys();
        let names = self.names();
        let network = network(self);
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

    pub(super) fn wrong(&mut self, what: impl Into<String>, help: &str, key: &str) {
        self.problems.push(Problem::new(what).help(help).at(key));
    }

    pub(super) fn text(&mut self, key: &str) -> Option<String> {
        match self.form.get(key)? {
            Value::String(text) => Some(text.clone()),
            Value::Null => None,
            other => {
                self.wrong(format!("{other} is no text"), "a text in quotes", key);
                None
            }
        }
    }

    pub(super) fn flag(&mut self, key: &str) -> Option<bool> {
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
            Some(Value::String(name)) => {
                let level = Level::named(name);
                if level.is_none() {
                    self.wrong(format!("no level is called `{name}`"), "debug, info, warn, error or false", "rosout");
                }
                level
            }
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
