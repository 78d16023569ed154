//! Inputs and outputs: topics that are subscribed to and published, whose types and QoS may only be found when others
//! come up.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use lrp_bridge::Level;
use serde_json::{Value, json};

use crate::config::Topic;
use crate::dds::qos::{Qos, Wish};
use crate::dds::{Raw, ReaderId, Writer};
use crate::graph::{Guid, Incompatible, Side};
use crate::names::Role;
use crate::node::{Node, decode, encode};
use crate::types::Struct;

/// A message of more bytes waits while lrp hasn't taken the one before, since making a value of it is work.
const BIG: usize = 32 * 1024;

/// How long a halt may take to arrive before it is given up.
const HALT: Duration = Duration::from_millis(200);

/// When a halt is said again to who has just come, unless the program has said something else.
const AGAIN: Duration = Duration::from_secs(1);

#[derive(Default)]
pub struct Inputs {
    inputs: BTreeMap<String, Input>,
}

struct Input {
    topic: Topic,
    open: Option<Open>,
    /// The latest of the big messages, not yet made a value.
    held: Option<Raw>,
    was_heard: bool,
}

struct Open {
    reader: ReaderId,
    kind: Arc<Struct>,
    qos: Qos,
}

impl Inputs {
    /// Those that are as before stay as they are.
    pub fn configure(&mut self, node: &mut Node, wanted: &BTreeMap<String, Topic>) {
        let gone: Vec<String> =
            self.inputs.iter().filter(|(name, input)| wanted.get(*name) != Some(&input.topic)).map(key).collect();
        for name in gone {
            if let Some(Input { open: Some(open), .. }) = self.inputs.remove(&name) {
                node.close_reader(open.reader);
            }
        }
        for (name, topic) in wanted {
            self.inputs.entry(name.clone()).or_insert_with(|| Input {
                topic: topic.clone(),
                open: None,
                held: None,
                was_heard: false,
            });
        }
        self.follow(node);
    }

    /// Opens what can be opened by now, and otherwise as others now offer it. Whether types have become known.
    pub fn follow(&mut self, node: &mut Node) -> bool {
        let mut news = false;
        for (name, input) in &mut self.inputs {
            news |= input.follow(name, node);
        }
        news
    }

    pub fn types(&self) -> impl Iterator<Item = (&String, &Arc<Struct>)> {
        self.inputs.iter().filter_map(|(name, input)| Some((name, &input.open.as_ref()?.kind)))
    }

    /// Whether a reader is an input's; then what it has has been handed over.
    pub fn receive(&mut self, node: &mut Node, reader: ReaderId) -> bool {
        let of_reader = |input: &Input| input.open.as_ref().is_some_and(|open| open.reader == reader);
        let Some((name, input)) = self.inputs.iter_mut().find(|(_, input)| of_reader(input)) else { return false };
        while let Some(sample) = node.take(reader) {
            if sample.sample.bytes.len() < BIG {
                input.hand_over(name, node, sample.sample);
            } else {
                input.held = Some(sample.sample);
            }
        }
        input.release(name, node);
        true
    }

    /// Hands over what was held back, where lrp has caught up.
    pub fn release(&mut self, node: &mut Node) {
        for (name, input) in &mut self.inputs {
            input.release(name, node);
        }
    }

    pub fn is_holding(&self) -> bool {
        self.inputs.values().any(|input| input.held.is_some())
    }

    /// Says which input a peer doesn't get along with.
    pub fn tell(&self, node: &mut Node, incompatible: &Incompatible) {
        let reader = node.reader_of(incompatible.ours);
        let is_it = |open: &Open| Some(open.reader) == reader;
        let found = self.inputs.iter().find(|(_, input)| input.open.as_ref().is_some_and(is_it));
        let Some((name, Input { topic: Topic { name: topic, qos: Wish::Exactly(_), .. }, .. })) = found else { return };
        let Incompatible { theirs, fault, .. } = incompatible;
        let who = publisher(node, *theirs);
        let what =
            format!("input `{name}` gets nothing from {who} on {topic}: they differ in {fault}; qos = \"match\"?");
        node.complain(Level::Warn, what);
    }
}

fn key<T>((name, _): (&String, T)) -> String {
    name.clone()
}

fn publisher(node: &Node, guid: Guid) -> String {
    node.graph.node_of(guid).unwrap_or("a publisher").to_string()
}

impl Input {
    fn follow(&mut self, name: &str, node: &mut Node) -> bool {
        let Some(type_name) = self.type_name(name, node) else { return false };
        // What isn't known is asked for, and this is tried again.
        let Ok(kind) = node.find(&type_name) else { return false };
        self.tell_of_publishers(name, node);
        let qos = self.qos(node, &kind.name);
        if self.open.as_ref().is_some_and(|open| open.qos == qos && open.kind == kind) {
            return false;
        }
        let is_new = self.open.as_ref().is_none_or(|open| open.kind != kind);
        if let Some(open) = self.open.take() {
            node.close_reader(open.reader);
        }
        match node.reader(&self.topic.name, Role::Topic, &kind.name, qos) {
            Ok(reader) => self.open = Some(Open { reader, kind, qos }),
            Err(why) => node.complain(Level::Error, format!("input `{name}`: {why}")),
        }
        is_new
    }

    /// As the form says, or as others have it.
    fn type_name(&self, name: &str, node: &mut Node) -> Option<String> {
        let theirs = node.graph.types(&self.topic.name, Role::Topic);
        let topic = &self.topic.name;
        match (&self.topic.type_name, theirs.first()) {
            (Some(ours), Some(theirs)) if ours != theirs => {
                let what = format!("input `{name}`: {topic} is {theirs} there, and {ours} in the form");
                node.complain(Level::Warn, what);
            }
            (None, Some(_)) if theirs.len() > 1 => {
                let what =
                    format!("input `{name}`: {topic} has several types, {}; the first is taken", theirs.join(", "));
                node.complain(Level::Warn, what);
            }
            _ => {}
        }
        let open = self.open.as_ref().map(|open| open.kind.name.clone());
        self.topic.type_name.clone().or(open).or(theirs.first().cloned())
    }

    fn qos(&self, node: &Node, type_name: &str) -> Qos {
        let depth = match self.topic.qos {
            Wish::Exactly(qos) => return qos,
            Wish::Match { depth } => depth,
        };
        let theirs = node.graph.endpoints(&self.topic.name, Role::Topic).map(|(_, endpoint)| endpoint);
        let writers = theirs.filter(|endpoint| endpoint.side == Side::Writes && endpoint.type_name == type_name);
        let offered: Vec<_> = writers.map(|endpoint| &endpoint.qos).collect();
        match (&self.open, offered.is_empty()) {
            // As it was, until somebody comes.
            (Some(open), true) => open.qos,
            _ => Qos::to_read(depth, offered),
        }
    }

    /// That the last publisher is gone, or one is back.
    fn tell_of_publishers(&mut self, name: &str, node: &mut Node) {
        let topic = &self.topic.name;
        let mut theirs = node.graph.endpoints(topic, Role::Topic);
        let is_heard = theirs.any(|(_, endpoint)| endpoint.side == Side::Writes);
        if is_heard != self.was_heard {
            self.was_heard = is_heard;
            match is_heard {
                true => node.robot.log(Level::Info, format!("input `{name}`: {topic} is published")),
                false => node.robot.log(Level::Warn, format!("input `{name}`: nobody publishes {topic} any more")),
            }
        }
    }

    fn release(&mut self, name: &str, node: &mut Node) {
        if self.held.is_some()
            && !node.robot.is_waiting(name)
            && let Some(raw) = self.held.take()
        {
            self.hand_over(name, node, raw);
        }
    }

    fn hand_over(&self, name: &str, node: &mut Node, raw: Raw) {
        let Some(open) = &self.open else { return };
        match decode(&open.kind, raw) {
            Ok(message) => node.robot.input(name, message),
            Err(why) => node.complain(Level::Warn, format!("input `{name}` ({}): {why}", self.topic.name)),
        }
    }
}

#[derive(Default)]
pub struct Outputs {
    outputs: BTreeMap<String, Output>,
}

struct Output {
    topic: Topic,
    open: Option<(Writer, Arc<Struct>)>,
    /// Somebody listens; to the first one a halt is sent before anything else.
    is_heard: bool,
    /// When it is sent once more: who was just found may not have found us.
    again: Option<Instant>,
}

impl Outputs {
    pub fn configure(&mut self, node: &mut Node, wanted: &BTreeMap<String, Topic>) {
        let gone: Vec<String> =
            self.outputs.iter().filter(|(name, output)| wanted.get(*name) != Some(&output.topic)).map(key).collect();
        for name in gone {
            if let Some(mut output) = self.outputs.remove(&name) {
                // What nobody drives any more must not drive on.
                output.halt(None);
                output.settle();
                output.close(node);
            }
        }
        for (name, topic) in wanted {
            self.outputs.entry(name.clone()).or_insert_with(|| Output {
                topic: topic.clone(),
                open: None,
                is_heard: false,
                again: None,
            });
        }
        self.follow(node);
    }

    pub fn follow(&mut self, node: &mut Node) -> bool {
        let mut news = false;
        for (name, output) in &mut self.outputs {
            news |= output.follow(name, node);
        }
        news
    }

    pub fn types(&self) -> impl Iterator<Item = (&String, &Arc<Struct>)> {
        self.outputs.iter().filter_map(|(name, output)| Some((name, &output.open.as_ref()?.1)))
    }

    pub fn send(&mut self, node: &mut Node, name: &str, message: &Value) {
        let Some(output) = self.outputs.get_mut(name) else { return };
        output.again = None;
        let written = match &output.open {
            Some((writer, kind)) => encode(kind, message).and_then(|bytes| writer.write(bytes).map(|_| ())),
            None => Err(format!("nobody listens to {}, so its type isn't known yet", output.topic.name)),
        };
        if let Err(why) = written {
            node.complain(Level::Error, format!("output `{name}`: {why}"));
        }
    }

    /// A halt to all that moves. `time`: a simulator's, if it counts.
    pub fn halt(&mut self, time: Option<Value>) {
        self.outputs.values_mut().for_each(|output| output.halt(time.clone()));
        self.outputs.values().for_each(Output::settle);
    }

    /// A halt to those that have just come up: they may still do what an earlier program wanted.
    pub fn greet(&mut self, node: &Node, time: &Option<Value>) {
        for output in self.outputs.values_mut() {
            let is_heard = output.open.as_ref().is_some_and(|(writer, _)| node.graph.is_matched(writer.guid()));
            if is_heard && !output.is_heard {
                output.halt(time.clone());
                output.again = Some(Instant::now() + AGAIN);
            } else if output.again.take_if(|again| *again <= Instant::now()).is_some() {
                output.halt(time.clone());
            }
            output.is_heard = is_heard;
        }
    }

    /// Says which output a peer doesn't get along with.
    pub fn tell(&self, node: &mut Node, incompatible: &Incompatible) {
        let is_it =
            |output: &Output| output.open.as_ref().is_some_and(|(writer, _)| writer.guid() == incompatible.ours);
        let Some((name, Output { topic, .. })) = self.outputs.iter().find(|(_, output)| is_it(output)) else { return };
        if let Wish::Exactly(_) = topic.qos {
            let who = node.graph.node_of(incompatible.theirs).unwrap_or("a subscriber").to_string();
            let Topic { name: topic, .. } = topic;
            let fault = &incompatible.fault;
            node.complain(
                Level::Warn,
                format!("output `{name}` doesn't reach {who} on {topic}: they differ in {fault}"),
            );
        }
    }
}

impl Output {
    fn follow(&mut self, name: &str, node: &mut Node) -> bool {
        let theirs = node.graph.types(&self.topic.name, Role::Topic);
        if let (Some(ours), Some(theirs)) =
            (&self.topic.type_name, theirs.first().filter(|theirs| Some(*theirs) != self.topic.type_name.as_ref()))
        {
            let what = format!("output `{name}`: {} is {theirs} there, and {ours} in the form", self.topic.name);
            node.complain(Level::Warn, what);
        }
        let open = self.open.as_ref().map(|(_, kind)| kind.name.clone());
        let Some(type_name) = self.topic.type_name.clone().or(open).or(theirs.first().cloned()) else { return false };
        // What isn't known is asked for, and this is tried again.
        let Ok(kind) = node.find(&type_name) else { return false };
        let qos = self.qos(node);
        if self.open.as_ref().is_some_and(|(writer, _)| writer.qos == qos) {
            return false;
        }
        let is_new = self.open.is_none();
        self.close(node);
        match node.writer(&self.topic.name, Role::Topic, &kind.name, qos) {
            Ok(writer) => self.open = Some((writer, kind)),
            Err(why) => node.complain(Level::Error, format!("output `{name}`: {why}")),
        }
        is_new
    }

    fn qos(&self, node: &Node) -> Qos {
        match self.topic.qos {
            Wish::Exactly(qos) => qos,
            Wish::Match { depth } => {
                let theirs = node.graph.endpoints(&self.topic.name, Role::Topic).map(|(_, endpoint)| endpoint);
                let readers = theirs.filter(|endpoint| endpoint.side == Side::Reads);
                Qos::to_write(depth, readers.map(|endpoint| &endpoint.qos))
            }
        }
    }

    fn close(&mut self, node: &mut Node) {
        if let Some((writer, _)) = self.open.take() {
            node.close_writer(writer);
        }
    }

    /// Zero velocity, where it is one that is sent.
    fn halt(&mut self, time: Option<Value>) {
        let Some((writer, kind)) = &self.open else { return };
        let halt = match kind.name.as_str() {
            "geometry_msgs/msg/Twist" => json!({}),
            "geometry_msgs/msg/TwistStamped" => json!({ "header": { "stamp": time.unwrap_or_else(now) } }),
            _ => return,
        };
        if let Ok(bytes) = encode(kind, &halt) {
            // Nothing more can be done than to try; the bridge's end is another halt for who watches over its age.
            let _ = writer.write(bytes);
        }
    }

    fn settle(&self) {
        if let Some((writer, kind)) = &self.open
            && kind.name.starts_with("geometry_msgs/msg/Twist")
        {
            writer.settle(HALT);
        }
    }
}

/// The time of day as a `builtin_interfaces/msg/Time`.
pub fn now() -> Value {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    json!({ "sec": since.as_secs() as i32, "nanosec": since.subsec_nanos() })
}
