//! Our node: opens readers and writers under ROS's names, tells others that they are ours, and keeps what is known of
//! types and of the graph.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use lrp_bridge::{Level, Robot};
use serde_json::{Value, json};

use crate::cdr::{Order, read, write};
use crate::dds::qos::Qos;
use crate::dds::{Link, Raw, ReaderId, Sample, Writer};
use crate::graph::{self, Graph, Guid};
use crate::mapping::Mapping;
use crate::names::{Names, Role, join, to_dds, type_to_dds};
use crate::types::{Registry, Struct};
use crate::wanted::Wanted;

const DISCOVERY_TOPIC: &str = "ros_discovery_info";
const DISCOVERY_TYPE: &str = "rmw_dds_common/msg/ParticipantEntitiesInfo";

/// Of others' participants: each tells its nodes on the same topic, and the last word of each counts.
const DISCOVERY: Qos = Qos { depth: 500, ..Qos::TRANSIENT_LOCAL };

pub struct Node {
    pub robot: Robot,
    pub names: Names,
    pub graph: Graph,
    pub types: Registry,
    /// How requests and replies are told apart, where the form says it; else as the other side does it.
    pub mapping: Option<Mapping>,
    /// Types that nobody here knows, to be asked for.
    pub wanted: BTreeMap<String, Wanted>,
    link: Link,
    /// Guids of our readers and of our writers.
    readers: BTreeMap<Guid, ReaderId>,
    writers: BTreeSet<Guid>,
    nodes_reader: ReaderId,
    nodes_writer: Writer,
    nodes_type: Arc<Struct>,
    is_told: bool,
    /// Of each thing that went wrong repeatedly, how often.
    complaints: BTreeMap<String, u64>,
}

impl Node {
    pub fn new(robot: Robot, names: Names, mut link: Link) -> Result<Node, String> {
        let mut types = Registry::of_environment();
        let nodes_type = types.find(DISCOVERY_TYPE)?;
        let dds_type = type_to_dds(DISCOVERY_TYPE);
        Ok(Node {
            nodes_reader: link.read(DISCOVERY_TOPIC, &dds_type, DISCOVERY)?,
            nodes_writer: link.write(DISCOVERY_TOPIC, &dds_type, Qos::TRANSIENT_LOCAL)?,
            graph: Graph::new(link.guid()),
            robot,
            names,
            types,
            mapping: None,
            wanted: BTreeMap::new(),
            link,
            readers: BTreeMap::new(),
            writers: BTreeSet::new(),
            nodes_type,
            is_told: false,
            complaints: BTreeMap::new(),
        })
    }

    pub fn reader(&mut self, name: &str, role: Role, type_name: &str, qos: Qos) -> Result<ReaderId, String> {
        let id = self.link.read(&to_dds(name, role), &type_to_dds(type_name), qos)?;
        self.readers.extend(self.link.reader_guid(id).map(|guid| (guid, id)));
        self.is_told = false;
        Ok(id)
    }

    pub fn writer(&mut self, name: &str, role: Role, type_name: &str, qos: Qos) -> Result<Writer, String> {
        let writer = self.link.write(&to_dds(name, role), &type_to_dds(type_name), qos)?;
        self.writers.insert(writer.guid());
        self.is_told = false;
        Ok(writer)
    }

    pub fn close_reader(&mut self, id: ReaderId) {
        self.readers.retain(|_, known| *known != id);
        self.link.close_reader(id);
        self.is_told = false;
    }

    pub fn close_writer(&mut self, writer: Writer) {
        self.writers.remove(&writer.guid());
        self.is_told = false;
    }

    pub fn reader_of(&self, guid: Guid) -> Option<ReaderId> {
        self.readers.get(&guid).copied()
    }

    /// Whether a reader of ours has somebody who writes.
    pub fn is_heard(&self, reader: ReaderId) -> bool {
        self.link.reader_guid(reader).is_some_and(|guid| self.graph.is_matched(guid))
    }

    /// The next message of a reader; none: no more for now.
    pub fn take(&mut self, reader: ReaderId) -> Option<Sample> {
        loop {
            match self.link.take(reader)? {
                Ok(sample) => return Some(sample),
                Err(error) => self.complain(Level::Warn, format!("a message could not be taken: {error}")),
            }
        }
    }

    /// A type, if it is known; else nodes will be asked for it.
    pub fn find(&mut self, name: &str) -> Result<Arc<Struct>, String> {
        let found = self.types.find(name);
        match &found {
            Ok(_) => {
                self.wanted.remove(name);
            }
            Err(_) => {
                self.wanted.entry(name.to_string()).or_insert_with(Wanted::new);
            }
        }
        found
    }

    pub fn is_alive(&self) -> bool {
        self.link.is_alive()
    }

    /// What discovery has to tell. Gives the endpoints that don't get along with ours.
    pub fn discover(&mut self) -> Vec<graph::Incompatible> {
        let mut incompatible = Vec::new();
        while let Some(event) = self.link.discover() {
            incompatible.extend(self.graph.hear(event));
        }
        incompatible
    }

    /// Whether a reader is the one for the nodes of others; then its news have been taken over.
    pub fn hear_of_nodes(&mut self, reader: ReaderId) -> bool {
        if reader != self.nodes_reader {
            return false;
        }
        while let Some(sample) = self.take(reader) {
            // Versions before Iron have longer ids; their nodes have no names here.
            if let Ok(info) = decode(&self.nodes_type, sample.sample) {
                let participant = guid(&info["gid"]);
                let nodes = info["node_entities_info_seq"].as_array().into_iter().flatten().map(node).collect();
                self.graph.nodes_of(participant, nodes);
            }
        }
        true
    }

    /// Tells others what our node has, if that changed.
    pub fn tell(&mut self) {
        if self.is_told {
            return;
        }
        let gids = |guids: Vec<&Guid>| guids.into_iter().map(|guid| json!({ "data": guid })).collect::<Vec<_>>();
        let info = json!({
            "gid": { "data": self.link.guid() },
            "node_entities_info_seq": [{
                "node_namespace": self.names.namespace,
                "node_name": self.names.node,
                "reader_gid_seq": gids(self.readers.keys().collect()),
                "writer_gid_seq": gids(self.writers.iter().collect()),
            }],
        });
        let written = encode(&self.nodes_type, &info).and_then(|bytes| self.nodes_writer.write(bytes));
        self.is_told = written.is_ok();
    }

    /// Says something the first time only.
    pub fn complain_once(&mut self, level: Level, what: String) {
        if !self.complaints.contains_key(&what) {
            self.complain(level, what);
        }
    }

    /// Says something the first time, and when it has happened ten, a hundred .. times.
    pub fn complain(&mut self, level: Level, what: String) {
        let count = self.complaints.entry(what.clone()).or_default();
        *count += 1;
        match *count {
            1 => self.robot.log(level, what),
            count if 10u64.pow(count.ilog10()) == count => self.robot.log(level, format!("{what} ({count} times)")),
            _ => {}
        }
    }
}

pub fn decode(kind: &Struct, raw: Raw) -> Result<Value, String> {
    read(kind, &raw.bytes, raw.order).map_err(|malformed| malformed.to_string())
}

pub fn encode(kind: &Struct, message: &Value) -> Result<Vec<u8>, String> {
    write(kind, message, Order::Little).map_err(|mismatch| mismatch.to_string())
}

fn node(info: &Value) -> graph::Node {
    let text = |key| info[key].as_str().unwrap_or_default();
    let guids = |key: &str| info[key].as_array().into_iter().flatten().map(guid).collect::<Vec<_>>();
    graph::Node {
        name: join(text("node_namespace"), text("node_name")),
        endpoints: [guids("reader_gid_seq"), guids("writer_gid_seq")].concat(),
    }
}

fn guid(gid: &Value) -> Guid {
    let bytes = lrp_bridge::value::as_bytes(&gid["data"]).unwrap_or_default();
    Guid::try_from(bytes).unwrap_or_default()
}
