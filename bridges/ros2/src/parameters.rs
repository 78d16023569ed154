//! Parameters: those of other nodes, read and set by calls; and the program's variables as parameters of our node, which
//! others read and set.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lrp_bridge::{Argument, Function, Variable, value};
use rustdds::SampleIdentity;
use serde_json::{Value, json};

use crate::client::{Clients, Request, Then};
use crate::dds::qos::Qos;
use crate::dds::{ReaderId, Writer};
use crate::names::Role;
use crate::node::{Node, decode, encode};
use crate::types::Struct;

/// How long another node may take to answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// How long the program may take to take over what was set.
const LONGEST_SET: Duration = Duration::from_secs(2);

pub const CALLS: [&str; 3] = ["get_parameter", "set_parameter", "list_parameters"];

/// Types, in `rcl_interfaces/msg/ParameterType`.
const NOT_SET: u64 = 0;
const BOOL: u64 = 1;
const INTEGER: u64 = 2;
const DOUBLE: u64 = 3;
const STRING: u64 = 4;
const BYTES: u64 = 5;
const BOOLS: u64 = 6;
const INTEGERS: u64 = 7;
const DOUBLES: u64 = 8;
const STRINGS: u64 = 9;

const NAMES: [&str; 10] =
    ["not set", "bool", "integer", "double", "string", "bytes", "bools", "integers", "doubles", "strings"];
const FIELDS: [&str; 10] = [
    "",
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "byte_array_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
];

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
    let service = format!("{of}/{}", snake(kind));
    clients.ask(
        node,
        Request {
            service: &service,
            type_name: &format!("rcl_interfaces/srv/{kind}"),
            message,
            then,
            until: Some(Instant::now() + PATIENCE),
        },
    )
}

/// `GetParameters` is `get_parameters`.
fn snake(name: &str) -> String {
    let mut snake = String::new();
    for char in name.chars() {
        if char.is_ascii_uppercase() && !snake.is_empty() {
            snake.push('_');
        }
        snake.push(char.to_ascii_lowercase());
    }
    snake
}

/// The value that another node gave.
pub fn got(name: &str, response: &Value) -> Result<Value, String> {
    let value = &response["values"][0];
    match value["type"].as_u64() {
        None | Some(NOT_SET) => Err(format!("there is no parameter `{name}`, or it has no value")),
        Some(kind) => {
            let field = FIELDS.get(kind as usize).ok_or_else(|| format!("`{name}` is of an unknown type"))?;
            Ok(value[field].clone())
        }
    }
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
        NOT_SET => parameter_value(value).ok_or_else(|| format!("{value} can't be a parameter"))?,
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

fn named(kind: u64) -> &'static str {
    NAMES.get(kind as usize).copied().unwrap_or("something else")
}

/// A `rcl_interfaces/msg/ParameterValue` of a value.
fn parameter_value(value: &Value) -> Option<Value> {
    as_type(value, type_of(value)?)
}

fn type_of(value: &Value) -> Option<u64> {
    match value {
        Value::Bool(_) => Some(BOOL),
        Value::Number(number) if number.is_f64() => Some(DOUBLE),
        Value::Number(number) => number.as_i64().map(|_| INTEGER),
        Value::String(_) => Some(STRING),
        Value::Array(items) => {
            let mut types = items.iter().map(|item| type_of(item).filter(|kind| *kind <= STRING));
            let first = types.next()??;
            types
                .try_fold(first, |kind, next| match (kind, next?) {
                    (one, other) if one == other => Some(one),
                    (INTEGER | DOUBLE, INTEGER | DOUBLE) => Some(DOUBLE),
                    _ => None,
                })
                .map(|kind| match kind {
                    BOOL => BOOLS,
                    INTEGER => INTEGERS,
                    DOUBLE => DOUBLES,
                    _ => STRINGS,
                })
        }
        other => match (value::as_number(other), value::as_bytes(other)) {
            (Some(_), _) => Some(DOUBLE),
            (None, Some(_)) => Some(BYTES),
            _ => None,
        },
    }
}

/// A `ParameterValue` of that type, where the value can be one.
fn as_type(value: &Value, kind: u64) -> Option<Value> {
    let one = |value: &Value, kind| match kind {
        BOOL => value.as_bool().map(Value::Bool),
        INTEGER => whole(value).map(Value::from),
        DOUBLE => value::as_number(value).map(value::number),
        _ => value.as_str().map(Value::from),
    };
    let all = |kind| {
        let items = match value {
            Value::Array(items) => items.iter().map(|item| one(item, kind)).collect::<Option<Vec<Value>>>()?,
            Value::Object(fields) if fields.is_empty() => Vec::new(),
            _ => return None,
        };
        Some(Value::Array(items))
    };
    let held = match kind {
        BOOL | INTEGER | DOUBLE | STRING => one(value, kind)?,
        BYTES => value::bytes(&value::as_bytes(value)?),
        BOOLS => all(BOOL)?,
        INTEGERS => all(INTEGER)?,
        DOUBLES => all(DOUBLE)?,
        STRINGS => all(STRING)?,
        _ => return None,
    };
    Some(json!({ "type": kind, (FIELDS[kind as usize]): held }))
}

fn whole(value: &Value) -> Option<i64> {
    let from_float = || value.as_f64().filter(|number| number.fract() == 0.0 && number.abs() < 9e15);
    value.as_i64().or_else(|| from_float().map(|number| number as i64))
}

/// What others may ask of our parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Describe,
    Types,
    Get,
    List,
    Set,
    SetAtomically,
}

const KINDS: [(Kind, &str); 6] = [
    (Kind::Describe, "DescribeParameters"),
    (Kind::Types, "GetParameterTypes"),
    (Kind::Get, "GetParameters"),
    (Kind::List, "ListParameters"),
    (Kind::Set, "SetParameters"),
    (Kind::SetAtomically, "SetParametersAtomically"),
];

/// Our node's parameters.
#[derive(Default)]
pub struct Parameters {
    variables: BTreeMap<String, Known>,
    services: Vec<Service>,
    setting: Vec<Setting>,
    next: u64,
}

struct Known {
    /// As lrp calls it.
    path: String,
    value: Value,
}

struct Service {
    kind: Kind,
    request: Arc<Struct>,
    response: Arc<Struct>,
    reader: ReaderId,
    writer: Writer,
}

/// A request whose variables are being set.
struct Setting {
    kind: Kind,
    to: SampleIdentity,
    until: Instant,
    /// For each parameter: what the program is asked, or what came of it.
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq)]
enum Part {
    Asked(u64),
    Done(Result<(), String>),
}

impl Parameters {
    pub fn open(&mut self, node: &mut Node) -> Result<(), String> {
        if !self.services.is_empty() {
            return Ok(());
        }
        for (kind, name) in KINDS {
            let service = format!("{}/{}", node.names.full_node(), snake(name));
            let request = node.find(&format!("rcl_interfaces/srv/{name}_Request"))?;
            let response = node.find(&format!("rcl_interfaces/srv/{name}_Response"))?;
            let reader = node.reader(&service, Role::Request, &request.name, Qos::PARAMETERS)?;
            let writer = node.writer(&service, Role::Reply, &response.name, Qos::PARAMETERS)?;
            self.services.push(Service { kind, request, response, reader, writer });
        }
        Ok(())
    }

    pub fn close(&mut self, node: &mut Node) {
        for service in self.services.drain(..) {
            node.close_reader(service.reader);
            node.close_writer(service.writer);
        }
    }

    /// Variables that changed. Those that can't be parameters, as tables with names, are left out.
    pub fn learn(&mut self, variables: Vec<Variable>) {
        for Variable { path, value } in variables {
            let name = path.replace('/', ".");
            match type_of(&value) {
                Some(_) => self.variables.insert(name, Known { path, value }),
                None => self.variables.remove(&name),
            };
        }
    }

    /// Whether a reader is of these services; then what came has been answered, or will be.
    pub fn receive(&mut self, node: &mut Node, reader: ReaderId) -> bool {
        let Some(at) = self.services.iter().position(|service| service.reader == reader) else { return false };
        while let Some(sample) = node.take(reader) {
            let to = answer_to(&sample);
            let kind = self.services[at].kind;
            let Ok(request) = decode(&self.services[at].request, sample.sample) else { continue };
            match kind {
                Kind::Set | Kind::SetAtomically => self.set(node, kind, to, &request),
                _ => {
                    let response = self.read(kind, &request);
                    self.services[at].answer(&response, to);
                }
            }
        }
        true
    }

    fn read(&self, kind: Kind, request: &Value) -> Value {
        let names = request["names"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let value = |name: &str| self.variables.get(name).and_then(|known| parameter_value(&known.value));
        let kind_of = |name: &str| self.variables.get(name).and_then(|known| type_of(&known.value)).unwrap_or(NOT_SET);
        match kind {
            Kind::Get => json!({ "values": names.map(|name| value(name).unwrap_or(json!({}))).collect::<Vec<_>>() }),
            Kind::Types => json!({ "types": names.map(|name| json!(kind_of(name))).collect::<Vec<_>>() }),
            Kind::List => json!({ "result": { "names": self.listed(request) } }),
            _ => {
                let description = "a variable of the program";
                let describe = |name| json!({ "name": name, "type": kind_of(name), "description": description });
                json!({ "descriptors": names.map(describe).collect::<Vec<_>>() })
            }
        }
    }

    fn listed(&self, request: &Value) -> Vec<&String> {
        let prefixes: Vec<&str> =
            request["prefixes"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let below = |name: &str, prefix: &str| {
            name.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let wanted = |name: &&String| prefixes.is_empty() || prefixes.iter().any(|prefix| below(name, prefix));
        self.variables.keys().filter(wanted).collect()
    }

    /// Asks the program to take values over; it is answered when the program has answered.
    fn set(&mut self, node: &Node, kind: Kind, to: SampleIdentity, request: &Value) {
        let parameters: Vec<&Value> = request["parameters"].as_array().into_iter().flatten().collect();
        let checked: Vec<_> = parameters.iter().map(|parameter| self.check(parameter)).collect();
        // All or none.
        let is_refused = kind == Kind::SetAtomically && checked.iter().any(Result::is_err);
        let parts = checked.into_iter().map(|checked| match checked {
            Ok(_) if is_refused => Part::Done(Err("another one of them can't be set".to_string())),
            Ok((path, value)) => {
                self.next += 1;
                node.robot.set(self.next, path, value);
                Part::Asked(self.next)
            }
            Err(why) => Part::Done(Err(why)),
        });
        let parts = parts.collect();
        self.setting.push(Setting { kind, to, until: Instant::now() + LONGEST_SET, parts });
        self.finish();
    }

    /// The variable and the value that a parameter stands for.
    fn check(&self, parameter: &Value) -> Result<(String, Value), String> {
        let name = parameter["name"].as_str().unwrap_or_default();
        let known = self.variables.get(name).ok_or_else(|| format!("the program has no variable `{name}`"))?;
        let value = got(name, &json!({ "values": [parameter["value"]] }))?;
        let (old, new) = (type_of(&known.value), type_of(&value));
        let fits = match (old, new) {
            // Lua has numbers.
            (Some(INTEGER | DOUBLE), Some(INTEGER | DOUBLE)) => true,
            (Some(INTEGERS | DOUBLES), Some(INTEGERS | DOUBLES)) => true,
            (old, new) => old == new,
        };
        match fits {
            true => Ok((known.path.clone(), value)),
            false => {
                let kind = |kind: Option<u64>| named(kind.unwrap_or(NOT_SET));
                Err(format!("`{name}` is {}, not {}", kind(old), kind(new)))
            }
        }
    }

    /// What the program made of a variable that was to be set.
    pub fn answered(&mut self, id: u64, error: Option<String>) {
        for part in self.setting.iter_mut().flat_map(|setting| &mut setting.parts) {
            if *part == Part::Asked(id) {
                *part = Part::Done(error.map_or(Ok(()), Err));
                break;
            }
        }
        self.finish();
    }

    pub fn tick(&mut self, now: Instant) {
        for setting in self.setting.iter_mut().filter(|setting| setting.until <= now) {
            for part in &mut setting.parts {
                if let Part::Asked(_) = part {
                    *part = Part::Done(Err("the program doesn't answer".to_string()));
                }
            }
        }
        self.finish();
    }

    /// Answers the requests all of whose parts are done.
    fn finish(&mut self) {
        let is_done = |setting: &mut Setting| setting.parts.iter().all(|part| matches!(part, Part::Done(_)));
        for Setting { kind, to, parts, .. } in self.setting.extract_if(.., is_done) {
            let result = |part: &Part| match part {
                Part::Done(Err(why)) => json!({ "successful": false, "reason": why }),
                _ => json!({ "successful": true }),
            };
            let response = match kind {
                Kind::SetAtomically => {
                    let failed = parts.iter().find(|part| matches!(part, Part::Done(Err(_))));
                    json!({ "result": failed.map_or(json!({ "successful": true }), result) })
                }
                _ => json!({ "results": parts.iter().map(result).collect::<Vec<_>>() }),
            };
            if let Some(service) = self.services.iter().find(|service| service.kind == kind) {
                service.answer(&response, to);
            }
        }
    }
}

impl Service {
    fn answer(&self, response: &Value, to: SampleIdentity) {
        if let Ok(bytes) = encode(&self.response, response) {
            // Who asked may be gone.
            let _ = self.writer.write_related(bytes, Some(to));
        }
    }
}

/// Whom a reply is for: some clients say that it is another one than who wrote.
fn answer_to(sample: &crate::dds::Sample) -> SampleIdentity {
    let own = SampleIdentity { writer_guid: sample.writer_guid(), sequence_number: sample.sequence_number };
    match sample.related_sample_identity() {
        Some(related) if related.writer_guid.to_bytes() != [0; 16] => {
            SampleIdentity { writer_guid: related.writer_guid, ..own }
        }
        _ => own,
    }
}
