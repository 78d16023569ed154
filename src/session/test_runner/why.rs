//! Why a state is not left, as a test asks for it: each way out with its guard's last value and what that reads.

use std::fmt;

use serde::Serialize;
use serde_json::{Map, Value};

use super::value::text;
use crate::model::reads::{Reading, Root, readings};
use crate::model::ways::ways_out;
use crate::model::{Program, StateId, TransitionId};
use crate::runtime::record::{Answer, Way};
use crate::runtime::{Engine, Record, What};

#[derive(Debug, Serialize)]
pub struct WayOut {
    #[serde(flatten)]
    way: Way,
    /// The name of the state it leads to.
    to: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Of a timeout: ms until it is due.
    #[serde(skip_serializing_if = "Option::is_none")]
    left: Option<f64>,
    /// What the guard reads, with the values of now; what has none is left out.
    reads: Map<String, Value>,
}

impl WayOut {
    pub fn leads_to(&self, state: &str) -> bool {
        self.to == state
    }
}

/// `m: on low a -> b: false; x 5`
impl fmt::Display for WayOut {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: ", self.way.transition)?;
        match (&self.way.message, self.left, self.way.guard) {
            (Some(message), _, _) => f.write_str(message)?,
            (None, Some(left), Answer::False) => write!(f, "{left} ms left")?,
            (None, _, guard) => f.write_str(if guard == Answer::True { "true" } else { "false" })?,
        }
        for (index, (name, value)) in self.reads.iter().enumerate() {
            write!(f, "{} {name} {}", if index == 0 { ";" } else { "," }, text(value))?;
        }
        Ok(())
    }
}

/// In the order in which they are tried; exits last.
pub fn ways(engine: &Engine, records: &[Record], state: StateId) -> Vec<WayOut> {
    let program = engine.program();
    let ids = ways_out(program, state).into_iter();
    ids.zip(engine.ways(state)).map(|(id, way)| way_out(engine, records, id, way)).collect()
}

fn way_out(engine: &Engine, records: &[Record], id: TransitionId, way: Way) -> WayOut {
    let program = engine.program();
    let transition = &program[id];
    let entered = engine.entered(&program[transition.machine].path);
    let elapsed = entered.map(|entered| engine.now().since(entered).ms());
    let left = way.after.zip(elapsed).map(|(after, elapsed)| (after - elapsed).max(0.0));
    let reads = readings(program, id).into_iter();
    let reads = reads.filter_map(|reading| Some((reading.text.clone(), value(engine, records, program, &reading)?)));
    WayOut {
        way,
        to: transition.target_name.to_string(),
        name: transition.name.as_ref().map(ToString::to_string),
        left,
        reads: reads.collect(),
    }
}

fn value(engine: &Engine, records: &[Record], program: &Program, reading: &Reading) -> Option<Value> {
    let whole = match &reading.root {
        Root::Variable(var) => engine.value(&program[*var].path)?,
        Root::Input { bridge, input } => records.iter().rev().find_map(|record| match &record.what {
            What::Input { bridge: from, name, value } if **from == **bridge && **name == **input => Some(value.clone()),
            _ => None,
        })?,
    };
    reading.fields.iter().try_fold(&whole, |value, field| value.get(field)).cloned()
}
