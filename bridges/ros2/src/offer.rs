//! What the bridge offers under a configuration, as far as types are known.

use std::collections::BTreeMap;
use std::sync::Arc;

use lrp_bridge::{Argument, Description, Function, Port, Problem};
use serde_json::Value;

use crate::config::{Callable, Config, Topic};
use crate::parameters;
use crate::types::{Registry, Struct};

/// Types by the names that the program has for what has them.
#[derive(Default)]
pub struct Types {
    pub inputs: BTreeMap<String, Arc<Struct>>,
    pub outputs: BTreeMap<String, Arc<Struct>>,
    pub services: BTreeMap<String, Arc<Struct>>,
    pub actions: BTreeMap<String, Arc<Struct>>,
}

/// What is known before anything is connected, and which types can't be.
pub fn before_connecting(config: &Config) -> Result<Description, Vec<Problem>> {
    let mut registry = Registry::of_environment();
    registry.look_in(config.interfaces.clone());
    let mut problems = Vec::new();
    let mut find = |group: &str, name: &str, type_name: Option<String>| {
        let type_name = type_name?;
        let found = registry.find(&type_name).ok();
        if found.is_none()
            && let Some(help) = registry.would_know(&type_name)
        {
            let problem = Problem::new(format!("there is no type {type_name}"));
            problems.push(problem.help(help).at(format!("{group}.{name}")));
        }
        Some((name.to_string(), found?))
    };
    let of_topic = |topic: &Topic| topic.type_name.clone();
    let part = |callable: &Callable, part: &str| Some(format!("{}{part}", callable.type_name.as_ref()?));
    let types = Types {
        inputs: config.subscribe.iter().filter_map(|(name, topic)| find("subscribe", name, of_topic(topic))).collect(),
        outputs: config.publish.iter().filter_map(|(name, topic)| find("publish", name, of_topic(topic))).collect(),
        services: {
            let services = config.services.iter();
            services.filter_map(|(name, service)| find("services", name, part(service, "_Request"))).collect()
        },
        actions: {
            let actions = config.actions.iter();
            actions.filter_map(|(name, action)| find("actions", name, part(action, "_Goal"))).collect()
        },
    };
    if problems.is_empty() { Ok(description(config, &types)) } else { Err(problems) }
}

pub fn description(config: &Config, types: &Types) -> Description {
    let port = |(name, topic): (&String, &Topic), types: &BTreeMap<String, Arc<Struct>>, verb: &str| {
        let (message, type_name) = match types.get(name) {
            Some(kind) => (kind.blank(), kind.name.clone()),
            None => (Value::Null, topic.type_name.clone().unwrap_or_default()),
        };
        Port::new(name, message, format!("{verb} {}", topic.name)).of_type(type_name)
    };
    let function = |(name, callable): (&String, &Callable), kind: Option<&Arc<Struct>>, what: &str, argument: &str| {
        let argument = Argument::new(argument).or(serde_json::json!({}));
        let argument = argument.message(kind.map_or(Value::Null, |kind| kind.blank()));
        let type_name = callable.type_name.clone().unwrap_or_default();
        Function::new(name, vec![argument], format!("{what} {} {type_name}", callable.name).trim_end())
    };
    let services = config.services.iter();
    let services = services.map(|entry| function(entry, types.services.get(entry.0), "service", "request"));
    let actions = config.actions.iter();
    let actions = actions.map(|entry| function(entry, types.actions.get(entry.0), "action", "goal"));
    Description {
        inputs: config.subscribe.iter().map(|entry| port(entry, &types.inputs, "subscribes to")).collect(),
        outputs: config.publish.iter().map(|entry| port(entry, &types.outputs, "publishes")).collect(),
        calls: services.chain(actions).chain(parameters::calls()).collect(),
        ..Description::default()
    }
}
