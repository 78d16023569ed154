//! What concerns the whole system rather than one topic: others' logs, ours, a simulator's clock, and the machines' states.

use std::collections::BTreeMap;
use std::sync::Arc;

use lrp_bridge::{Active, Level};
use serde_json::{Value, json};

use crate::config::Config;
use crate::dds::qos::Qos;
use crate::dds::{ReaderId, Writer};
use crate::names::Role;
use crate::node::{Node, decode, encode};
use crate::topics::now;
use crate::types::Struct;

const LOG: &str = "rcl_interfaces/msg/Log";
const CLOCK: &str = "rosgraph_msgs/msg/Clock";
/// What rqt and Foxglove show as it is.
const STATES: &str = "diagnostic_msgs/msg/DiagnosticArray";

/// Others' logs from now on; what was logged before is told by nobody.
const LOGS: Qos = Qos { depth: 200, ..Qos::DEFAULT };

#[derive(Default)]
pub struct System {
    logs: Option<(ReaderId, Arc<Struct>)>,
    least: Option<Level>,
    own_log: Option<(Writer, Arc<Struct>)>,
    clock: Option<(ReaderId, Arc<Struct>)>,
    /// A simulator's time, if it counts.
    time: Option<Value>,
    states: Option<(String, Writer, Arc<Struct>)>,
    running: BTreeMap<String, Active>,
}

impl System {
    pub fn configure(&mut self, node: &mut Node, config: &Config) -> Result<(), String> {
        self.least = config.rosout;
        match (&self.logs, config.rosout) {
            (None, Some(_)) => {
                let kind = node.find(LOG)?;
                self.logs = Some((node.reader("/rosout", Role::Topic, LOG, LOGS)?, kind));
            }
            (Some((reader, _)), None) => {
                node.close_reader(*reader);
                self.logs = None;
            }
            _ => {}
        }
        if self.own_log.is_none() {
            let kind = node.find(LOG)?;
            self.own_log = Some((node.writer("/rosout", Role::Topic, LOG, Qos::ROSOUT)?, kind));
        }
        self.follow_clock(node, config.use_sim_time)?;
        self.tell_states(node, config.states.as_deref())
    }

    fn follow_clock(&mut self, node: &mut Node, wanted: bool) -> Result<(), String> {
        match (&self.clock, wanted) {
            (None, true) => {
                let kind = node.find(CLOCK)?;
                self.clock = Some((node.reader("/clock", Role::Topic, CLOCK, Qos::CLOCK)?, kind));
            }
            (Some((reader, _)), false) => {
                node.close_reader(*reader);
                self.clock = None;
                self.time = None;
            }
            _ => {}
        }
        Ok(())
    }

    fn tell_states(&mut self, node: &mut Node, topic: Option<&str>) -> Result<(), String> {
        if self.states.as_ref().map(|(topic, ..)| topic.as_str()) == topic {
            return Ok(());
        }
        if let Some((_, writer, _)) = self.states.take() {
            node.close_writer(writer);
        }
        if let Some(topic) = topic {
            let kind = node.find(STATES)?;
            let writer = node.writer(topic, Role::Topic, STATES, Qos::TRANSIENT_LOCAL)?;
            self.states = Some((topic.to_string(), writer, kind));
            self.publish_states(node);
        }
        Ok(())
    }

    /// A simulator's time as a `builtin_interfaces/msg/Time`, if it counts.
    pub fn time(&self) -> Option<Value> {
        self.time.clone()
    }

    /// Whether a reader is for logs or the clock; then what came has been passed on.
    pub fn receive(&mut self, node: &mut Node, reader: ReaderId) -> bool {
        if let Some((_, kind)) = self.logs.as_ref().filter(|(logs, _)| *logs == reader) {
            while let Some(sample) = node.take(reader) {
                if let Ok(log) = decode(kind, sample.sample) {
                    self.pass_on(node, &log);
                }
            }
            return true;
        }
        if let Some((_, kind)) = self.clock.as_ref().filter(|(clock, _)| *clock == reader) {
            while let Some(sample) = node.take(reader) {
                if let Ok(mut clock) = decode(kind, sample.sample) {
                    self.time = Some(clock["clock"].take());
                }
            }
            if let Some(time) = &self.time {
                let part = |key: &str| time[key].as_f64().unwrap_or_default();
                node.robot.time(part("sec") * 1e3 + part("nanosec") / 1e6);
            }
            return true;
        }
        false
    }

    fn pass_on(&self, node: &Node, log: &Value) {
        let text = |key: &str| log[key].as_str().unwrap_or_default();
        let level = level(log["level"].as_u64().unwrap_or_default());
        let is_own = text("name") == logger(node);
        if !is_own && self.least.is_some_and(|least| level >= least) {
            node.robot.log_from(text("name"), level, text("msg"));
        }
    }

    /// What the program logs, for everybody.
    pub fn log(&self, node: &Node, level: Level, message: &str, state: &str) {
        let Some((writer, kind)) = &self.own_log else { return };
        let log = json!({
            "stamp": self.time().unwrap_or_else(now),
            "level": number(level),
            "name": logger(node),
            "msg": message,
            "function": state,
        });
        if let Ok(bytes) = encode(kind, &log) {
            // Where nobody keeps up with the logs, they are lost.
            let _ = writer.write(bytes);
        }
    }

    pub fn states(&mut self, node: &mut Node, machines: Vec<Active>) {
        self.running = machines.into_iter().map(|active| (active.machine.clone(), active)).collect();
        self.publish_states(node);
    }

    fn publish_states(&self, node: &mut Node) {
        let Some((topic, writer, kind)) = &self.states else { return };
        let status = |active: &Active| {
            let value = |key: &str, value: String| json!({ "key": key, "value": value });
            json!({
                "name": active.machine,
                "message": active.state.rsplit('/').next().unwrap_or_default(),
                "hardware_id": node.names.full_node(),
                "values": [value("state", active.state.clone()), value("since", active.since.to_string())],
            })
        };
        let message = json!({
            "header": { "stamp": self.time().unwrap_or_else(now) },
            "status": self.running.values().map(status).collect::<Vec<_>>(),
        });
        if let Err(why) = encode(kind, &message).and_then(|bytes| writer.write(bytes).map(|_| ())) {
            node.complain(Level::Warn, format!("{topic}: {why}"));
        }
    }
}

/// As loggers are called: `robot.lrp`.
fn logger(node: &Node) -> String {
    node.names.full_node().trim_start_matches('/').replace('/', ".")
}

fn level(number: u64) -> Level {
    match number {
        0..20 => Level::Debug,
        20..30 => Level::Info,
        30..40 => Level::Warn,
        _ => Level::Error,
    }
}

fn number(level: Level) -> u64 {
    match level {
        Level::Debug => 10,
        Level::Info => 20,
        Level::Warn => 30,
        Level::Error => 40,
    }
}
