//! What a guard sees: the variables and inputs that it reads, with the values they have.

use serde_json::Value;

use super::View;
use crate::model::reads::{Reading, Root, readings};
use crate::model::{Program, TransitionId};
use crate::ui::format;

/// A longer list would tell nothing.
const MOST: usize = 6;

impl View {
    /// As text, `light.data 142`, in the order written; the robot is named where there are several.
    pub fn evidence(&self, program: &Program, transition: TransitionId) -> Vec<String> {
        let readings = readings(program, transition).into_iter();
        let seen = readings.filter_map(|reading| {
            let value = format::value(self.value_of(program, &reading)?);
            Some(format!("{} {value}", shortly(program, &reading)))
        });
        seen.take(MOST).collect()
    }

    fn value_of(&self, program: &Program, reading: &Reading) -> Option<&Value> {
        let whole = match &reading.root {
            Root::Input { bridge, input } => &self.bridges.get(&**bridge)?.inputs.get(&**input)?.value,
            Root::Variable(var) => self.variables.get(&program[*var].path)?.value.as_ref()?,
        };
        reading.fields.iter().try_fold(whole, |value, field| value.get(field))
    }
}

fn shortly<'a>(program: &Program, reading: &'a Reading) -> &'a str {
    match (&reading.root, &*program.bridges, reading.text.split_once('.')) {
        (Root::Input { .. }, [_], Some((_, rest))) => rest,
        _ => &reading.text,
    }
}
