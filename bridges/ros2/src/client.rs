//! Calls of services: requests wait for their server to come up, replies find their request, and both have an end.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use serde_json::Value;

use crate::dds::qos::Qos;
use crate::dds::{ReaderId, Sample, Writer};
use crate::graph::Side;
use crate::mapping::{self, Header, Mapping};
use crate::names::Role;
use crate::node::{Node, decode, encode};
use crate::types::Struct;

#[derive(Default)]
pub struct Clients {
    clients: BTreeMap<String, Client>,
    /// What could not be sent, or has lost its client.
    failed: Vec<Outcome>,
}

/// What a reply is for.
#[derive(Clone, Debug, PartialEq)]
pub enum Then {
    /// A call of the program has its value.
    Reply { call: u64 },
    /// A goal is accepted, or isn't.
    Accept { goal: [u8; 16] },
    /// A goal is over.
    Finish { goal: [u8; 16] },
    /// A goal will be cancelled, or won't.
    Cancel { goal: [u8; 16] },
    /// A node described a type.
    Learn { type_name: String },
    /// A parameter was read.
    Get { call: u64, name: String },
    /// The type of a parameter is known, and it can be set.
    Typed { call: u64, node: String, name: String, value: Value },
    /// A parameter was set, or wasn't.
    Set { call: u64 },
    /// A node's parameters were listed.
    List { call: u64 },
}

/// What is asked, and until when it is waited for.
pub struct Request<'a> {
    pub service: &'a str,
    /// `std_srvs/srv/Trigger`
    pub type_name: &'a str,
    pub message: &'a Value,
    pub then: Then,
    pub until: Option<Instant>,
}

struct Client {
    type_name: String,
    request: Arc<Struct>,
    response: Arc<Struct>,
    writer: Writer,
    replies: ReaderId,
    /// Until the server is up.
    waiting: Vec<Waiting>,
    asked: BTreeMap<i64, Asked>,
    next: i64,
}

struct Waiting {
    bytes: Vec<u8>,
    asked: Asked,
}

struct Asked {
    then: Then,
    until: Option<Instant>,
}

pub type Outcome = (Then, Result<Value, String>);

impl Clients {
    /// So that the server and we know each other before the first request.
    pub fn prepare(&mut self, node: &mut Node, service: &str, type_name: &str) -> Result<(), String> {
        if self.clients.get(service).is_some_and(|client| client.type_name == type_name) {
            return Ok(());
        }
        let request = node.find(&format!("{type_name}_Request"))?;
        let response = node.find(&format!("{type_name}_Response"))?;
        self.close(node, service);
        let client = Client {
            type_name: type_name.to_string(),
            replies: node.reader(service, Role::Reply, &response.name, Qos::DEFAULT)?,
            writer: node.writer(service, Role::Request, &request.name, Qos::DEFAULT)?,
            request,
            response,
            waiting: Vec::new(),
            asked: BTreeMap::new(),
            next: 0,
        };
        self.clients.insert(service.to_string(), client);
        Ok(())
    }

    pub fn close(&mut self, node: &mut Node, service: &str) {
        if let Some(mut client) = self.clients.remove(service) {
            self.failed.extend(client.give_up(&format!("{service} is used as another type, or no more")));
            node.close_reader(client.replies);
            node.close_writer(client.writer);
        }
    }

    pub fn ask(&mut self, node: &mut Node, request: Request) -> Result<(), String> {
        let Request { service, type_name, message, then, until } = request;
        self.prepare(node, service, type_name)?;
        let Some(client) = self.clients.get_mut(service) else { return Ok(()) };
        let bytes = encode(&client.request, message)?;
        client.waiting.push(Waiting { bytes, asked: Asked { then, until } });
        client.send(node, service, &mut self.failed);
        Ok(())
    }

    /// Whether a reader is a client's, and what has come of its requests.
    pub fn receive(&mut self, node: &mut Node, reader: ReaderId) -> Option<Vec<Outcome>> {
        let client = self.clients.values_mut().find(|client| client.replies == reader)?;
        let mut outcomes = Vec::new();
        while let Some(sample) = node.take(reader) {
            outcomes.extend(client.reply(sample, node.mapping));
        }
        Some(outcomes)
    }

    /// Sends what waited for a server that is up by now, and gives up what took too long or has lost its server.
    pub fn tick(&mut self, node: &mut Node, now: Instant) -> Vec<Outcome> {
        let mut outcomes = std::mem::take(&mut self.failed);
        for (service, client) in &mut self.clients {
            if client.waiting.is_empty() && client.asked.is_empty() {
                continue;
            }
            client.send(node, service, &mut outcomes);
            let is_late = |asked: &Asked| asked.until.is_some_and(|until| until <= now);
            let type_name = &client.type_name;
            let late = client.waiting.extract_if(.., |waiting| is_late(&waiting.asked));
            let missing = format!("no server of {service} ({type_name}) has come up");
            outcomes.extend(late.map(|waiting| (waiting.asked.then, Err(missing.clone()))));
            let is_gone = !client.is_matched(node);
            let late: Vec<i64> =
                client.asked.iter().filter(|(_, asked)| is_gone || is_late(asked)).map(|(id, _)| *id).collect();
            let why =
                if is_gone { format!("the server of {service} is gone") } else { format!("{service} took too long") };
            let late = late.into_iter().filter_map(|id| client.asked.remove(&id));
            outcomes.extend(late.map(|asked| (asked.then, Err(why.clone()))));
        }
        outcomes
    }

    /// Nobody waits for what a call asked any more.
    pub fn forget(&mut self, call: u64) {
        let is_other = |asked: &Asked| asked.then.call() != Some(call);
        for client in self.clients.values_mut() {
            client.waiting.retain(|waiting| is_other(&waiting.asked));
            client.asked.retain(|_, asked| is_other(asked));
        }
    }

    /// Takes back what hasn't been sent yet. Whether it hadn't.
    pub fn withdraw(&mut self, then: &Then) -> bool {
        self.clients
            .values_mut()
            .any(|client| client.waiting.extract_if(.., |waiting| waiting.asked.then == *then).count() > 0)
    }

    /// Gives up all that is still open.
    pub fn give_up(&mut self, why: &str) -> Vec<Outcome> {
        let given_up = self.clients.values_mut().flat_map(|client| client.give_up(why));
        given_up.chain(std::mem::take(&mut self.failed)).collect()
    }
}

impl Then {
    /// The call of the program that it answers at once.
    fn call(&self) -> Option<u64> {
        match self {
            Then::Reply { call }
            | Then::Get { call, .. }
            | Then::Typed { call, .. }
            | Then::Set { call }
            | Then::List { call } => Some(*call),
            Then::Accept { .. } | Then::Finish { .. } | Then::Cancel { .. } | Then::Learn { .. } => None,
        }
    }
}

impl Client {
    /// Both ways: a reply to a request that comes too early would be lost.
    fn is_matched(&self, node: &Node) -> bool {
        node.graph.is_matched(self.writer.guid()) && node.is_heard(self.replies)
    }

    fn give_up(&mut self, why: &str) -> Vec<Outcome> {
        let waiting = self.waiting.drain(..).map(|waiting| waiting.asked);
        let asked = std::mem::take(&mut self.asked).into_values();
        waiting.chain(asked).map(|asked| (asked.then, Err(why.to_string()))).collect()
    }

    fn send(&mut self, node: &Node, service: &str, failed: &mut Vec<Outcome>) {
        if !self.is_matched(node) {
            return;
        }
        let mapping = node.mapping.unwrap_or_else(|| mapping_of(node, service));
        for Waiting { bytes, mut asked } in std::mem::take(&mut self.waiting) {
            if let Then::Accept { .. } = asked.then {
                // It may be accepted however late, and is to be cancelled then: the goal looks after its time.
                asked.until = None;
            }
            match self.write(bytes, mapping) {
                Ok(number) => _ = self.asked.insert(number, asked),
                Err(why) => failed.push((asked.then, Err(why))),
            }
        }
    }

    /// The request's number, which its reply will have.
    fn write(&mut self, bytes: Vec<u8>, mapping: Mapping) -> Result<i64, String> {
        match mapping {
            Mapping::FastDds => Ok(i64::from(self.writer.write(bytes)?.sequence_number)),
            Mapping::Cyclone => {
                self.next += 1;
                self.writer.write(Header::new(self.writer.guid(), self.next).before(&bytes))?;
                Ok(self.next)
            }
        }
    }

    fn reply(&mut self, sample: Sample, mapping: Option<Mapping>) -> Option<Outcome> {
        let (number, raw) = mapping::reply(sample, self.writer.guid(), mapping)?;
        let asked = self.asked.remove(&number)?;
        Some((asked.then, decode(&self.response, raw)))
    }
}

/// As the server does it, which its vendor tells.
fn mapping_of(node: &Node, service: &str) -> Mapping {
    let mut servers = node.graph.endpoints(service, Role::Request).filter(|(_, endpoint)| endpoint.side == Side::Reads);
    match servers.any(|(guid, _)| Mapping::of(*guid) == Mapping::Cyclone) {
        true => Mapping::Cyclone,
        false => Mapping::FastDds,
    }
}
