//! What the variables pane lists for a machine: what is pinned, its variables, those around it, the globals, and what
//! bridges carry; tables that were opened with what is in them. Activity never changes the order.

use std::collections::BTreeSet;
use std::ops::Range;

use serde_json::Value;

use super::format;
use super::view::{Bridge, Path, Renames, View, name, owner};
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
    /// How many rows at the beginning are pinned.
    pub pinned: usize,
    /// How many rows at the end are what bridges carry.
    pub carried: usize,
}

/// How a person wants the values arranged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrangement {
    /// On top whatever is selected, in the order they were pinned.
    pub pinned: Vec<Path>,
    /// Tables and messages with what is in them.
    pub open: BTreeSet<Path>,
    /// A part of the paths that are looked for, in every machine; empty: all that are in scope.
    pub filter: String,
}

/// How the rows of a listing share a pane: where they don't all fit, what is pinned stays on top and what bridges carry
/// keeps the lower part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shares {
    /// The first rows of the listing, which don't scroll.
    pub fixed: usize,
    /// Rows of the listing, and how many the pane has for them.
    pub upper: (Range<usize>, usize),
    /// The same for the lower part.
    pub lower: (Range<usize>, usize),
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
    /// In an opened table or message.
    Item {
        path: Path,
        name: String,
        value: Value,
        /// The variable or message, and how deep inside it.
        root: Path,
        depth: u16,
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
            Row::Variable { path, .. }
            | Row::Field { path, .. }
            | Row::Message { path, .. }
            | Row::Item { path, .. } => Some(path),
        }
    }

    /// The table or message that can be opened.
    pub fn inside<'a>(&'a self, view: &'a View) -> Option<&'a Value> {
        let value = match self {
            Row::Heading(_) => return None,
            Row::Variable { path, .. } => view.variables.get(path)?.value.as_ref()?,
            Row::Field { value, .. } | Row::Message { value, .. } | Row::Item { value, .. } => value,
        };
        (!format::entries(value).is_empty()).then_some(value)
    }
}

impl Arrangement {
    pub fn rename(&mut self, renames: &Renames) {
        self.pinned.iter_mut().for_each(|path| *path = renames.variable(path));
        self.open = self.open.iter().map(|path| renames.variable(path)).collect();
    }

    fn finds(&self, path: &str) -> bool {
        path.to_lowercase().contains(&self.filter.to_lowercase())
    }
}

impl Listing {
    pub fn new(view: &View, machine: Option<MachineId>, arrangement: &Arrangement) -> Listing {
        let program = view.program.as_deref();
        let scope = program.map_or_else(Vec::new, |program| scope(program, machine));
        let mut declared = program.map_or_else(Vec::new, |program| groups(program, &scope, arrangement));
        let (mut pinned, mut carried) = (Vec::new(), carried(view));
        for path in &arrangement.pinned {
            let mut groups = declared.iter_mut().chain(&mut carried);
            pinned.extend(groups.find_map(|group| group.take(path)));
        }
        tell_apart(&mut pinned);
        declared.retain(|group| scope.contains(&group.scope) || !arrangement.filter.is_empty());
        for group in declared.iter_mut().chain(&mut carried) {
            group.rows.retain(|row| row.path().is_some_and(|path| arrangement.finds(path)));
        }
        let mut listing = Listing::default();
        listing.add(Group { scope: None, title: "pinned".into(), rows: pinned }, view, arrangement);
        listing.pinned = listing.rows.len();
        declared.into_iter().for_each(|group| listing.add(group, view, arrangement));
        let above = listing.rows.len();
        carried.into_iter().for_each(|group| listing.add(group, view, arrangement));
        listing.carried = listing.rows.len() - above;
        listing
    }

    pub fn shares(&self, height: usize) -> Shares {
        let (all, declared) = (self.rows.len(), self.rows.len() - self.carried);
        if all <= height || declared == 0 {
            return Shares { fixed: 0, upper: (0..all, height), lower: (all..all, 0) };
        }
        let fixed = if self.pinned <= height / 2 { self.pinned } else { 0 };
        let lower = self.carried.min((height - fixed) / 2);
        Shares { fixed, upper: (fixed..declared, height - fixed - lower), lower: (declared..all, lower) }
    }

    /// The row of a selection.
    pub fn position(&self, path: Option<&Path>) -> Option<usize> {
        self.rows.iter().position(|row| path.is_some() && row.path() == path)
    }

    pub fn row(&self, path: &Path) -> Option<&Row> {
        self.rows.get(self.position(Some(path))?)
    }

    /// The scope that the row before `top` belongs to: what a title says of the rows that are seen.
    pub fn scope_at(&self, top: usize) -> Option<&Path> {
        let headings = self.rows.iter().take(top).rev().find_map(|row| match row {
            Row::Heading(scope) => Some(scope),
            _ => None,
        });
        headings.or(self.first.as_ref())
    }

    fn add(&mut self, group: Group, view: &View, arrangement: &Arrangement) {
        if group.rows.is_empty() {
            return;
        }
        match (&self.first, self.rows.is_empty()) {
            (None, true) => self.first = Some(group.title),
            _ => self.rows.push(Row::Heading(group.title)),
        }
        for row in group.rows {
            let inside = row.inside(view).cloned().zip(row.path().cloned());
            self.rows.push(row);
            if let Some((value, path)) = inside {
                self.add_inside(&path, &path, &value, 1, arrangement);
            }
        }
    }

    fn add_inside(&mut self, root: &Path, path: &Path, value: &Value, depth: u16, arrangement: &Arrangement) {
        if !arrangement.open.contains(path) {
            return;
        }
        for (key, value) in format::entries(value) {
            let path: Path = format!("{path}.{key}").into();
            let (root, value) = (root.clone(), value.clone());
            self.rows.push(Row::Item {
                path: path.clone(),
                name: key,
                value: value.clone(),
                root: root.clone(),
                depth,
            });
            self.add_inside(&root, &path, &value, depth + 1, arrangement);
        }
    }
}

/// Rows under a heading.
struct Group {
    /// None at top level.
    scope: Option<MachineId>,
    title: Path,
    rows: Vec<Row>,
}

impl Group {
    fn of_variables(program: &Program, scope: Option<MachineId>, vars: &[VarId]) -> Group {
        let title = scope.map_or("global".into(), |machine| program[machine].name.clone());
        let row = |&var: &VarId| Row::Variable { path: program[var].path.clone(), name: program[var].name.clone() };
        Group { scope, title, rows: vars.iter().map(row).collect() }
    }

    fn take(&mut self, path: &Path) -> Option<Row> {
        let at = self.rows.iter().position(|row| row.path() == Some(path))?;
        Some(self.rows.remove(at))
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

/// From a machine outwards; the global one last.
fn scope(program: &Program, machine: Option<MachineId>) -> Vec<Option<MachineId>> {
    let around = std::iter::successors(machine, |&machine| program.enclosing(machine));
    around.map(Some).chain([None]).collect()
}

/// The scopes a machine sees; where something may be wanted from elsewhere, all others behind them.
fn groups(program: &Program, scope: &[Option<MachineId>], arrangement: &Arrangement) -> Vec<Group> {
    let elsewhere = !arrangement.filter.is_empty() || !arrangement.pinned.is_empty();
    let all = (0..program.machines.len() as u32).map(|id| Some(MachineId(id)));
    let others = all.filter(|other| elsewhere && !scope.contains(other));
    let vars = |scope: Option<MachineId>| scope.map_or(&program.globals, |machine| &program[machine].vars);
    scope.iter().copied().chain(others).map(|scope| Group::of_variables(program, scope, vars(scope))).collect()
}

fn carried(view: &View) -> Vec<Group> {
    let group = |(bridge, carried): (&Path, &Bridge)| {
        let mut group = Group { scope: None, title: bridge.clone(), rows: Vec::new() };
        for (port, message) in &carried.inputs {
            group.add_input(bridge, port, &message.value, message.at);
        }
        for (port, message) in &carried.outputs {
            group.add_message(format!("{bridge}:{port}").into(), port, &message.value, message.at, Way::Output);
        }
        group
    };
    view.bridges.iter().map(group).collect()
}

/// Pinned variables of one name go by that of their machine as well.
fn tell_apart(rows: &mut [Row]) {
    let called = |row: &Row| match row {
        Row::Variable { name, .. } => Some(name.clone()),
        _ => None,
    };
    let names: Vec<Path> = rows.iter().filter_map(called).collect();
    for row in rows {
        if let Row::Variable { path, name: called } = row
            && names.iter().filter(|name| *name == called).count() > 1
            && let Some(machine) = owner(path)
        {
            *called = format!("{}/{called}", name(machine)).into();
        }
    }
}
