//! What the variables pane lists for a machine: its variables, those around it, the globals, and what bridges carry.
//! Activity never changes the order.

use serde_json::Value;

use super::format::telling;
use super::view::{Path, View};
use crate::model::{MachineId, Program, VarId};
use crate::runtime::time::Time;

/// A table with more fields than this shows as one value.
const FIELDS: usize = 12;

#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    Heading(Path),
    Variable { path: Path, name: Path },
    /// A field of the latest message under a name, `light.data`.
    Field { path: Path, name: String, value: Value, at: Time, way: Way },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Input,
    Output,
}

impl Row {
    /// What a selection holds on to; none for what can't be selected.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Row::Heading(_) => None,
            Row::Variable { path, .. } | Row::Field { path, .. } => Some(path),
        }
    }
}

/// Innermost scope first, in the order written.
pub fn rows(view: &View, machine: Option<MachineId>) -> Vec<Row> {
    let mut rows = Vec::new();
    if let Some(program) = &view.program {
        let mut scope = machine;
        while let Some(id) = scope {
            add_variables(program, &program[id].name, &program[id].vars, &mut rows);
            scope = program.enclosing(id);
        }
        add_variables(program, "global", &program.globals, &mut rows);
    }
    for (name, bridge) in &view.bridges {
        if bridge.inputs.is_empty() && bridge.outputs.is_empty() {
            continue;
        }
        rows.push(Row::Heading(name.clone()));
        for (port, message) in &bridge.inputs {
            add_fields(name, port, &message.value, message.at, &mut rows);
        }
        for (port, message) in &bridge.outputs {
            rows.push(Row::Field {
                path: format!("{name}:{port}").into(),
                name: port.to_string(),
                value: telling(&message.value),
                at: message.at,
                way: Way::Output,
            });
        }
    }
    rows
}

fn add_variables(program: &Program, scope: &str, vars: &[VarId], rows: &mut Vec<Row>) {
    if !vars.is_empty() {
        rows.push(Row::Heading(scope.into()));
    }
    rows.extend(vars.iter().map(|&var| {
        let var = &program[var];
        Row::Variable { path: var.path.clone(), name: var.name.clone() }
    }));
}

/// A row for each field of a small message, `light.data`; one for anything else.
fn add_fields(bridge: &str, name: &str, value: &Value, at: Time, rows: &mut Vec<Row>) {
    match value.as_object().filter(|fields| (1..=FIELDS).contains(&fields.len())) {
        Some(fields) => {
            for (field, value) in fields {
                add_fields(bridge, &format!("{name}.{field}"), value, at, rows);
            }
        }
        None => rows.push(Row::Field {
            path: format!("{bridge}.{name}").into(),
            name: name.into(),
            value: value.clone(),
            at,
            way: Way::Input,
        }),
    }
}
