//! What a condition saw: the variables and inputs that its code names, with the values they have.
//! Reads the code's words only; knows nothing of Lua.

use serde_json::Value;

use super::{Path, View};
use crate::model::{MachineId, Program};
use crate::ui::format;

/// A longer list would tell nothing.
const MOST: usize = 6;

impl View {
    /// As text, `robot.light.data 142`, in the order written, each once.
    pub(super) fn evidence(&self, program: &Program, machine: MachineId, code: &str) -> Vec<String> {
        let mut seen: Vec<&str> = Vec::new();
        let mut evidence = Vec::new();
        for word in code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')) {
            if evidence.len() == MOST {
                break;
            }
            if seen.contains(&word) {
                continue;
            }
            if let Some(value) = self.value_of(program, machine, word) {
                seen.push(word);
                evidence.push(format!("{word} {}", format::value(value)));
            }
        }
        evidence
    }

    fn value_of(&self, program: &Program, machine: MachineId, word: &str) -> Option<&Value> {
        let mut parts = word.split('.');
        let first = parts.next().filter(|first| !first.is_empty())?;
        let whole = match self.bridges.get(first) {
            Some(bridge) => &bridge.inputs.get(parts.next()?)?.value,
            None => self.variables.get(in_scope(program, machine, first)?)?.value.as_ref()?,
        };
        parts.try_fold(whole, |value, field| value.get(field))
    }
}

/// The path of the variable a name means in a machine.
fn in_scope<'a>(program: &'a Program, machine: MachineId, name: &str) -> Option<&'a Path> {
    let mut scope = Some(machine);
    let scopes = std::iter::from_fn(|| {
        let id = scope?;
        scope = program.enclosing(id);
        Some(&program[id].vars)
    });
    let vars = scopes.chain([&program.globals]).flatten();
    vars.map(|&var| &program[var]).find(|var| *var.name == *name).map(|var| &var.path)
}
