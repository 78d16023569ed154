//! Parameters of other nodes: the program's calls that read, set and list them.

use std::time::{Duration, Instant};

use lrp_bridge::{Argument, Function, value};
use serde_json::{Value, json};

use super::service;
use super::values::{self, NOT_SET, as_type, named};
use crate::client::{Clients, Request, Then};
use crate::node::Node;

/// How long another node may take to answer.
const PATIENCE: Duration = Duration::from_secs(5);

pub const CALLS: [&str; 3] = ["get_parameter", "set_parameter", "list_parameters"];

/// The calls that the program has for the parameters of other nodes.
pub fn calls() -> Vec<Function> {
    let node = || Argument::new("node");
    let name = || Argument::new("name");
    vec![
        Function::new("get_parameter", vec![node(), name()], "the value of another node's parameter"),
        Function::new("set_parameter", vec![node(), name(), Argument::new("value")], "sets another node's parameter"),
        Function::new("list_parameters", vec![node()], "the names of another node's parameters"),
    ]
}

/// Begins one of these calls. None: it is another one.
pub fn call(
    node: &mut Node,
    clients: &mut Clients,
    name: &str,
    call: u64,
    arguments: &[Value],
) -> Option<Result<(), String>> {
    let text = |at: usize, what: &str| {
        let text = arguments.get(at).and_then(Value::as_str).filter(|text| !text.is_empty());
        text.map(str::to_string).ok_or_else(|| format!("{name}: which {what}?"))
    };
    if !CALLS.contains(&name) {
        return None;
    }
    let of = match text(0, "node") {
        Ok(of) => node.names.resolve(&of),
        Err(why) => return Some(Err(why)),
    };
    let parameter = match (name, text(1, "parameter")) {
        ("list_parameters", _) => String::new(),
        (_, Ok(parameter)) => parameter,
        (_, Err(why)) => return Some(Err(why)),
    };
    let names = json!({ "names": [parameter] });
    Some(match name {
        "get_parameter" => ask(node, clients, &of, "GetParameters", &names, Then::Get { call, name: parameter }),
        "list_parameters" => ask(node, clients, &of, "ListParameters", &json!({}), Then::List { call }),
        _ => {
            let value = arguments.get(2).cloned().unwrap_or_default();
            let then = Then::Typed { call, node: of.clone(), name: parameter, value };
            ask(node, clients, &of, "GetParameterTypes", &names, then)
        }
    })
}

fn ask(
    node: &mut Node,
    clients: &mut Clients,
    of: &str,
    kind: &str,
    message: &Value,
    then: Then,
) -> Result<(), String> {
    clients.ask(
        node,
        Request {
            service: &service(of, kind),
            type_name: &format!("rcl_interfaces/srv/{kind}"),
            message,
            then,
            until: Some(Instant::now() + PATIENCE),
        },
    )
}

/// The value that another node gave.
pub fn got(name: &str, response: &Value) -> Result<Value, String> {
    values::read(name, &response["values"][0])
}

pub fn listed(response: &Value) -> Value {
    response["result"]["names"].clone()
}

/// Sets a parameter whose type is known by now: a whole number is a double where the node wants one.
pub fn set(
    node: &mut Node,
    clients: &mut Clients,
    then: (u64, &str, &str, &Value),
    response: &Value,
) -> Result<(), String> {
    let (call, of, name, value) = then;
    let kind = value::as_bytes(&response["types"]).and_then(|types| types.first().copied()).map_or(NOT_SET, u64::from);
    let value = match kind {
        // Perhaps the node takes it all the same.
        NOT_SET => values::write(value).ok_or_else(|| format!("{value} can't be a parameter"))?,
        kind => as_type(value, kind).ok_or_else(|| format!("`{name}` is {}, not {value}", named(kind)))?,
    };
    let message = json!({ "parameters": [{ "name": name, "value": value }] });
    ask(node, clients, of, "SetParameters", &message, Then::Set { call })
}

/// Whether a node took what was to be set.
pub fn was_set(response: &Value) -> Result<Value, String> {
    let result = &response["results"][0];
    match result["successful"] == true {
        true => Ok(Value::Bool(true)),
        false => Err(match result["reason"].as_str().unwrap_or_default() {
            "" => "the node refused".to_string(),
            reason => reason.to_string(),
        }),
    }
}
