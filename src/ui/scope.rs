//! What the variables pane lists for a machine: its variables, those around it, the globals, and what bridges carry.
//! Activity never changes the order.

use serde_json::Value;

use super::view::{Path, View};
use crate::model::{MachineId, Program, VarId};
use crate::runtime::time::Time;

/// A message with more fields than this is one row.
const FIELDS: usize = 2;

/// Innermost scope first, in the order written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Listing {
    /// The scope of the first rows, for the title.
    pub first: Option<Path>,
    /// Scopes after the first begin with a heading.
    pub rows: Vec<Row>,
    /// How many rows at the end are what bridges carry.
    pub carried: usize,
}

/// How the rows of a listing share a pane: where they don't all fit, what bridges carry keeps the lower part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shares {
    /// Rows of the listing and rows of the pane for the upper part.
    pub upper: (usize, usize),
    /// The same for the lower part.
    pub lower: (usize, usize),
}

#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    Heading(Path),
    Variable {
        path: Path,
        name: Path,
    },
    /// A field of the latest message under a name, `light.data`.
    Field {
        path: Path,
        name: String,
        value: Value,
        at: Time,
    },
    /// A whole message.
    Message {
        path: Path,
        name: Path,
        value: Value,
        at: Time,
        way: Way,
    },
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
            Row::Variable { path, .. } | Row::Field { path, .. } | Row::Message { path, .. } => Some(path),
        }
    }
}

impl Listing {
    pub fn new(view: &View, machine: Option<MachineId>) -> Listing {
        let mut listing = Listing::default();
        if let Some(program) = &view.program {
            let mut scope = machine;
            while let Some(id) = scope {
                listing.add_variables(program, &program[id].name, &program[id].vars);
                scope = program.enclosing(id);
            }
            listing.add_variables(program, "global", &program.globals);
        }
        let declared = listing.rows.len();
        for (name, bridge) in &view.bridges {
            if bridge.inputs.is_empty() && bridge.outputs.is_empty() {
                continue;
            }
            listing.begin(name);
            for (port, message) in &bridge.inputs {
                listing.add_input(name, port, &message.value, message.at);
            }
            for (port, message) in &bridge.outputs {
                let path = format!("{name}:{port}").into();
                listing.add_message(path, port, &message.value, message.at, Way::Output);
            }
        }
        listing.carried = listing.rows.len() - declared;
        listing
    }

    pub fn shares(&self, height: usize) -> Shares {
        let declared = self.rows.len() - self.carried;
        if self.rows.len() <= height || declared == 0 {
            return Shares { upper: (self.rows.len(), height), lower: (0, 0) };
        }
        let lower = self.carried.min(height / 2);
        Shares { upper: (declared, height - lower), lower: (self.carried, lower) }
    }

    /// The row of a selection.
    pub fn position(&self, path: Option<&Path>) -> Option<usize> {
        self.rows.iter().position(|row| path.is_some() && row.path() == path)
    }

    /// The scope that the row before `top` belongs to: what a title says of the rows that are seen.
    pub fn scope_at(&self, top: usize) -> Option<&Path> {
        let headings = self.rows.iter().take(top).rev().find_map(|row| match row {
            Row::Heading(scope) => Some(scope),
            _ => None,
        });
        headings.or(self.first.as_ref())
    }

    fn begin(&mut self, scope: &str) {
        match (&self.first, self.rows.is_empty()) {
            (None, true) => self.first = Some(scope.into()),
            _ => self.rows.push(Row::Heading(scope.into())),
        }
    }

    fn add_variables(&mut self, program: &Program, scope: &str, vars: &[VarId]) {
        if vars.is_empty() {
            return;
        }
        self.begin(scope);
        self.rows.extend(vars.iter().map(|&var| {
            let var = &program[var];
            Row::Variable { path: var.path.clone(), name: var.name.clone() }
        }));
    }

    /// A row for each field of a small message, `light.data`; one for a larger one.
    fn add_input(&mut self, bridge: &str, name: &Path, value: &Value, at: Time) {
        let small = value.as_object().filter(|fields| (1..=FIELDS).contains(&fields.len()));
        match small.filter(|fields| fields.values().all(|field| !field.is_object())) {
            Some(fields) => self.rows.extend(fields.iter().map(|(field, value)| Row::Field {
                path: format!("{bridge}.{name}.{field}").into(),
                name: format!("{name}.{field}"),
                value: value.clone(),
                at,
            })),
            None => self.add_message(format!("{bridge}.{name}").into(), name, value, at, Way::Input),
        }
    }

    fn add_message(&mut self, path: Path, name: &Path, value: &Value, at: Time, way: Way) {
        self.rows.push(Row::Message { path, name: name.clone(), value: value.clone(), at, way });
    }
}
