//! What of the program robots are told that want to know: its variables and its active states, when they change, and what
//! it logs.

use std::collections::BTreeMap;
use std::sync::Arc;

use lrp_bridge::{Active, Order, Variable, Want};
use serde_json::Value;

use super::robot::Robot;
use crate::runtime::record::Log;
use crate::runtime::{Engine, Record, What};

/// So many lines a step; a program that logs more can't be followed anyway.
const LOGS: usize = 100;

/// What has changed since robots were last told.
#[derive(Default)]
pub struct Told {
    variables: BTreeMap<Arc<str>, Value>,
    states: bool,
    logs: Vec<Log>,
    /// Whatever was known before: the program is another one.
    all: bool,
}

impl Told {
    pub fn see(&mut self, record: &Record) {
        match &record.what {
            What::Set { var, value, .. } => drop(self.variables.insert(Arc::clone(var), value.clone())),
            What::Spawn { .. } | What::Enter { .. } | What::Discard { .. } | What::Force { .. } => self.states = true,
            // What robots have said has no line.
            What::Log(log) if log.line > 0 && self.logs.len() < LOGS => self.logs.push(log.clone()),
            What::Load(_) | What::Restart { .. } => self.all = true,
            _ => {}
        }
    }

    /// Tells those who want to know; one that has just come up is told everything.
    pub fn tell(&mut self, engine: &Engine, robots: &mut [Robot]) {
        let Told { variables, states, logs, all } = std::mem::take(self);
        for robot in robots {
            let Some(bridge) = &mut robot.bridge else { continue };
            let news = all || std::mem::take(&mut robot.uninformed);
            for want in bridge.wants().to_vec() {
                let order = match want {
                    Want::Log => {
                        logs.iter().map(logged).for_each(|order| bridge.tell(order));
                        continue;
                    }
                    Want::Variables if news => Order::Variables { variables: all_variables(engine) },
                    Want::Variables if !variables.is_empty() => Order::Variables { variables: changed(&variables) },
                    Want::States if news || states => active(engine),
                    Want::Variables | Want::States | Want::Unknown => continue,
                };
                bridge.tell(order);
            }
        }
    }
}

fn changed(variables: &BTreeMap<Arc<str>, Value>) -> Vec<Variable> {
    let variable = |(path, value): (&Arc<str>, &Value)| Variable { path: path.to_string(), value: value.clone() };
    variables.iter().map(variable).collect()
}

fn logged(Log { level, message, state, .. }: &Log) -> Order {
    let state = (!state.is_empty()).then(|| state.to_string());
    Order::Log { level: *level, message: message.clone(), state }
}

fn all_variables(engine: &Engine) -> Vec<Variable> {
    engine.values().into_iter().map(|(path, value)| Variable { path, value }).collect()
}

fn active(engine: &Engine) -> Order {
    let machine = |path: String| {
        let (machine, state) = path.rsplit_once('/')?;
        let since = engine.entered(machine)?.ms();
        Some(Active { machine: machine.to_string(), state: state.to_string(), since })
    };
    Order::States { t: engine.now().ms(), machines: engine.active().into_iter().filter_map(machine).collect() }
}
