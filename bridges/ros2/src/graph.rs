//! What is seen of others: their endpoints, which nodes those belong to, and which of ours they are matched with. A fold of
//! what discovery tells; knows nothing of messages.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use lrp_bridge::Found;
use rustdds::{DomainParticipantStatusEvent as Event, EndpointDescription, QosPolicies};

use crate::dds::qos;
use crate::names::{Role, from_dds, type_from_dds};

pub type Guid = [u8; 16];

/// The first bytes of a guid are its participant's.
const PREFIX: usize = 12;

/// And the first of those are its vendor's.
const CYCLONE: [u8; 2] = [1, 16];

/// Cyclone drops what comes before it has found who sends it, which may take this much longer than finding it took us.
const CYCLONES_DELAY: Duration = Duration::from_millis(100);

#[derive(Default)]
pub struct Graph {
    /// This participant's prefix.
    own: [u8; PREFIX],
    endpoints: BTreeMap<Guid, Endpoint>,
    /// By participant: its nodes.
    nodes: BTreeMap<[u8; PREFIX], Vec<Node>>,
    /// Endpoints of ours, and of others that they talk to, since when.
    matches: BTreeMap<Guid, BTreeMap<Guid, Instant>>,
    version: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Endpoint {
    pub name: String,
    pub role: Role,
    /// `std_msgs/msg/String`; of services and actions, that of the request or reply.
    pub type_name: String,
    pub side: Side,
    pub qos: QosPolicies,
    /// Of its type, as newer versions of ROS tell.
    pub hash: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Writes,
    Reads,
}

/// A node and the endpoints that it says are its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// `/robot/driver`
    pub name: String,
    pub endpoints: Vec<Guid>,
}

/// An endpoint of somebody else's doesn't get along with ours.
#[derive(Clone, Debug, PartialEq)]
pub struct Incompatible {
    pub ours: Guid,
    pub theirs: Guid,
    pub fault: String,
}

impl Graph {
    pub fn new(own: Guid) -> Graph {
        Graph { own: prefix(own), ..Graph::default() }
    }

    /// Takes over what discovery tells.
    pub fn hear(&mut self, event: Event) -> Option<Incompatible> {
        match event {
            Event::WriterDetected { writer } => self.found(writer, Side::Writes),
            Event::ReaderDetected { reader } => self.found(reader, Side::Reads),
            Event::ReaderLost { guid, .. } | Event::WriterLost { guid, .. } => self.lost(guid.to_bytes()),
            Event::ParticipantLost { id, .. } => self.left(prefix_of(id.as_ref())),
            Event::RemoteReaderMatched { local_writer: ours, remote_reader: theirs }
            | Event::RemoteWriterMatched { local_reader: ours, remote_writer: theirs } => {
                self.matches.entry(ours.to_bytes()).or_default().insert(theirs.to_bytes(), Instant::now());
            }
            Event::RemoteReaderQosIncompatible { local_writer, remote_reader, requested_qos, offered_qos } => {
                return Some(Incompatible {
                    ours: local_writer.to_bytes(),
                    theirs: remote_reader.to_bytes(),
                    fault: qos::fault(&offered_qos, &requested_qos),
                });
            }
            Event::RemoteWriterQosIncompatible { local_reader, remote_writer, requested_qos, offered_qos } => {
                return Some(Incompatible {
                    ours: local_reader.to_bytes(),
                    theirs: remote_writer.to_bytes(),
                    fault: qos::fault(&offered_qos, &requested_qos),
                });
            }
            _ => {}
        }
        None
    }

    /// The nodes that a participant says it has.
    pub fn nodes_of(&mut self, participant: Guid, nodes: Vec<Node>) {
        if prefix(participant) != self.own && self.nodes.insert(prefix(participant), nodes.clone()) != Some(nodes) {
            self.version += 1;
        }
    }

    fn found(&mut self, described: EndpointDescription, side: Side) {
        let guid = described.guid.to_bytes();
        let Some((name, role)) = from_dds(&described.topic_name) else { return };
        let Some(type_name) = type_from_dds(&described.type_name) else { return };
        if prefix(guid) == self.own {
            return;
        }
        let hash = hash(&described.user_data);
        self.endpoints.insert(guid, Endpoint { name, role, type_name, side, qos: described.qos, hash });
        self.version += 1;
    }

    fn lost(&mut self, guid: Guid) {
        self.matches.values_mut().for_each(|theirs| {
            theirs.remove(&guid);
        });
        if self.endpoints.remove(&guid).is_some() {
            self.version += 1;
        }
    }

    fn left(&mut self, participant: [u8; PREFIX]) {
        self.endpoints.retain(|guid, _| prefix(*guid) != participant);
        self.matches.values_mut().for_each(|theirs| theirs.retain(|guid, _| prefix(*guid) != participant));
        self.nodes.remove(&participant);
        self.version += 1;
    }

    /// Another one after each change of what others offer.
    pub fn version(&self) -> u64 {
        self.version
    }

    pub fn endpoints(&self, name: &str, role: Role) -> impl Iterator<Item = (&Guid, &Endpoint)> {
        self.endpoints.iter().filter(move |(_, endpoint)| endpoint.name == name && endpoint.role == role)
    }

    /// The types that others have under a name, those of writers first.
    pub fn types(&self, name: &str, role: Role) -> Vec<String> {
        let of = |side| self.endpoints(name, role).filter(move |(_, endpoint)| endpoint.side == side);
        let mut types = Vec::new();
        for (_, endpoint) in of(Side::Writes).chain(of(Side::Reads)) {
            if !types.contains(&endpoint.type_name) {
                types.push(endpoint.type_name.clone());
            }
        }
        types
    }

    /// Whether an endpoint of ours has somebody to talk to.
    pub fn is_matched(&self, ours: Guid) -> bool {
        self.ready(ours).next().is_some()
    }

    /// Whether an endpoint of ours can talk to the participant that has one of others', whichever of its endpoints hears.
    pub fn is_matched_with(&self, ours: Guid, theirs: Guid) -> bool {
        self.ready(ours).any(|guid| prefix(*guid) == prefix(theirs))
    }

    fn ready(&self, ours: Guid) -> impl Iterator<Item = &Guid> {
        let is_ready = |(guid, since): &(&Guid, &Instant)| !is_cyclone(guid) || since.elapsed() >= CYCLONES_DELAY;
        self.matches.get(&ours).into_iter().flatten().filter(is_ready).map(|(guid, _)| guid)
    }

    /// The node that an endpoint belongs to.
    pub fn node_of(&self, guid: Guid) -> Option<&str> {
        let nodes = self.nodes.get(&prefix(guid))?;
        nodes.iter().find(|node| node.endpoints.contains(&guid)).map(|node| node.name.as_str())
    }

    /// Who has a topic of a type, with the type's hash: to be asked what it is. Of services nodes don't tell.
    pub fn offering(&self, type_name: &str) -> impl Iterator<Item = (&str, &str)> {
        let is_it = move |endpoint: &Endpoint| endpoint.role == Role::Topic && endpoint.type_name == type_name;
        let offering = self.endpoints.iter().filter(move |(_, endpoint)| is_it(endpoint));
        offering.filter_map(|(guid, endpoint)| Some((self.node_of(*guid)?, endpoint.hash.as_deref()?)))
    }

    /// What a program could use.
    pub fn list(&self) -> Vec<Found> {
        let mut topics: BTreeMap<(&str, &str), (usize, usize)> = BTreeMap::new();
        let mut others = Vec::new();
        for endpoint in self.endpoints.values() {
            match (endpoint.role, endpoint.side) {
                (Role::Topic, side) if !is_internal(&endpoint.name) => {
                    let (writers, readers) = topics.entry((&endpoint.name, &endpoint.type_name)).or_default();
                    *if side == Side::Writes { writers } else { readers } += 1;
                }
                (Role::Request, Side::Reads) => others.extend(service_or_action(endpoint)),
                _ => {}
            }
        }
        let topics = topics.into_iter().map(|((name, type_name), (writers, readers))| Found {
            name: name.to_string(),
            what: "topic".to_string(),
            type_name: type_name.to_string(),
            doc: format!("{writers} publishing, {readers} subscribed"),
            setting: Some(entry(if writers > 0 { "subscribe" } else { "publish" }, name)),
        });
        let mut list: Vec<Found> = topics.chain(others).collect();
        let names: BTreeSet<&str> = self.nodes.values().flatten().map(|node| node.name.as_str()).collect();
        let node = |name: &str| Found { name: name.to_string(), what: "node".to_string(), ..Found::default() };
        list.extend(names.into_iter().map(node));
        list.sort_by(|one, other| (&one.what, &one.name).cmp(&(&other.what, &other.name)));
        list.dedup();
        list
    }
}

/// Of a table of the form: the last part of the name, as Lua can have it.
fn entry(table: &str, name: &str) -> String {
    let last = name.rsplit('/').next().unwrap_or_default();
    let plain: String = last.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    format!("{table}.{plain}")
}

fn service_or_action(endpoint: &Endpoint) -> Option<Found> {
    let found = |name: &str, what: &str, type_name: &str| Found {
        name: name.to_string(),
        what: what.to_string(),
        type_name: type_name.to_string(),
        doc: String::new(),
        setting: Some(entry(&format!("{what}s"), name)),
    };
    let (name, type_name) = (&endpoint.name, &endpoint.type_name);
    if let Some(action) = name.strip_suffix("/_action/send_goal") {
        return Some(found(action, "action", type_name.strip_suffix("_SendGoal_Request")?));
    }
    if is_internal(name) {
        return None;
    }
    Some(found(name, "service", type_name.strip_suffix("_Request")?))
}

/// What each node has, and what actions are made of.
fn is_internal(name: &str) -> bool {
    const OF_EACH_NODE: [&str; 7] = [
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
        "get_type_description",
    ];
    let last = name.rsplit('/').next().unwrap_or_default();
    name.contains("/_action/") || OF_EACH_NODE.contains(&last) || ["/rosout", "/parameter_events"].contains(&name)
}

/// `typehash=RIHS01_..;` after a length, or at once.
fn hash(user_data: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(user_data);
    let start = text.find("typehash=")? + "typehash=".len();
    let hash: String = text[start..].chars().take_while(|char| char.is_ascii_alphanumeric() || *char == '_').collect();
    hash.starts_with("RIHS01_").then_some(hash)
}

pub fn is_cyclone(guid: &Guid) -> bool {
    guid.starts_with(&CYCLONE)
}

fn prefix(guid: Guid) -> [u8; PREFIX] {
    prefix_of(&guid)
}

fn prefix_of(bytes: &[u8]) -> [u8; PREFIX] {
    let mut prefix = [0; PREFIX];
    prefix.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
    prefix
}
