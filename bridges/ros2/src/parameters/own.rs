//! Parameters of our node: the program's variables, which others read and set.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lrp_bridge::{Level, Variable};
use serde_json::{Value, json};

use super::values::{self, DOUBLE, DOUBLES, INTEGER, INTEGERS, NOT_SET, named, type_of};
use crate::dds::qos::Qos;
use crate::dds::{ReaderId, Sample, Writer};
use crate::mapping::{self, Asker, Mapping};
use crate::names::Role;
use crate::node::{Node, decode, encode};
use crate::types::Struct;

/// How long the program may take to take over what was set.
const LONGEST_SET: Duration = Duration::from_secs(2);

/// How long an answer waits for somebody who hears it.
const LONGEST_WAIT: Duration = Duration::from_secs(1);

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
    /// To those who can't hear yet.
    answers: Vec<Answer>,
}

struct Answer {
    to: Asker,
    bytes: Vec<u8>,
    until: Instant,
}

/// A request whose variables are being set.
struct Setting {
    kind: Kind,
    to: Asker,
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
            let service = super::service(&node.names.full_node(), name);
            let request = node.find(&format!("rcl_interfaces/srv/{name}_Request"))?;
            let response = node.find(&format!("rcl_interfaces/srv/{name}_Response"))?;
            let reader = node.reader(&service, Role::Request, &request.name, Qos::PARAMETERS)?;
            let writer = node.writer(&service, Role::Reply, &response.name, Qos::PARAMETERS)?;
            self.services.push(Service { kind, request, response, reader, writer, answers: Vec::new() });
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
            let service = &self.services[at];
            let (kind, asked) = (service.kind, service.understand(sample, node.mapping));
            let (to, request) = match asked {
                Ok(asked) => asked,
                Err(why) => {
                    let what = "a request for our parameters can't be read";
                    node.complain(Level::Warn, format!("{what}: {why}; where `rmw` is set, is it right?"));
                    continue;
                }
            };
            match kind {
                Kind::Set | Kind::SetAtomically => self.set(node, kind, to, &request),
                _ => {
                    let response = self.read(kind, &request);
                    self.services[at].answer(node, &response, to);
                }
            }
        }
        true
    }

    fn read(&self, kind: Kind, request: &Value) -> Value {
        let names = request["names"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let value = |name: &str| self.variables.get(name).and_then(|known| values::write(&known.value));
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
    fn set(&mut self, node: &Node, kind: Kind, to: Asker, request: &Value) {
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
        self.finish(node);
    }

    /// The variable and the value that a parameter stands for.
    fn check(&self, parameter: &Value) -> Result<(String, Value), String> {
        let name = parameter["name"].as_str().unwrap_or_default();
        let known = self.variables.get(name).ok_or_else(|| format!("the program has no variable `{name}`"))?;
        let value = values::read(name, &parameter["value"])?;
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
    pub fn answered(&mut self, node: &Node, id: u64, error: Option<String>) {
        for part in self.setting.iter_mut().flat_map(|setting| &mut setting.parts) {
            if *part == Part::Asked(id) {
                *part = Part::Done(error.map_or(Ok(()), Err));
                break;
            }
        }
        self.finish(node);
    }

    pub fn tick(&mut self, node: &Node, now: Instant) {
        for setting in self.setting.iter_mut().filter(|setting| setting.until <= now) {
            for part in &mut setting.parts {
                if let Part::Asked(_) = part {
                    *part = Part::Done(Err("the program doesn't answer".to_string()));
                }
            }
        }
        self.finish(node);
        self.services.iter_mut().for_each(|service| service.send(node, now));
    }

    /// Answers the requests all of whose parts are done.
    fn finish(&mut self, node: &Node) {
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
            if let Some(service) = self.services.iter_mut().find(|service| service.kind == kind) {
                service.answer(node, &response, to);
            }
        }
    }
}

impl Service {
    /// Who asks, and what.
    fn understand(&self, sample: Sample, mapping: Option<Mapping>) -> Result<(Asker, Value), String> {
        let (to, raw) = mapping::request(sample, mapping).ok_or("it is too short")?;
        Ok((to, decode(&self.request, raw)?))
    }

    fn answer(&mut self, node: &Node, response: &Value, to: Asker) {
        let Ok(bytes) = encode(&self.response, response) else { return };
        let now = Instant::now();
        self.answers.push(Answer { to, bytes, until: now + LONGEST_WAIT });
        self.send(node, now);
    }

    /// A request may come before who hears the answer is found; what is sent then is lost.
    fn send(&mut self, node: &Node, now: Instant) {
        let own = self.writer.guid();
        let is_due = |answer: &mut Answer| node.graph.is_matched_with(own, answer.to.guid) || answer.until <= now;
        for Answer { to, bytes, .. } in self.answers.extract_if(.., is_due) {
            // Who asked may be gone.
            let _ = to.answer(&self.writer, bytes);
        }
    }
}
