//! What an edit renamed: the way from old paths to new ones, for all that the picture keeps by path.

use std::collections::BTreeMap;

use super::{Path, View, name, owner, within};
use crate::runtime::command::BreakAt;
use crate::runtime::record::{Change, Element, Op, Taken};

/// A machine takes along what is inside it. States and variables may share a path, so each kind has its own way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Renames {
    /// Machines and states: from, to.
    places: Vec<(Path, Path)>,
    variables: Vec<(Path, Path)>,
    events: Vec<(Path, Path)>,
}

impl Renames {
    pub fn of(changes: &[Change]) -> Renames {
        let mut renames = Renames::default();
        for change in changes.iter().filter(|change| change.op == Op::Renamed) {
            let Some(to) = &change.to else { continue };
            let way = match change.kind {
                Element::Machine | Element::State => &mut renames.places,
                Element::Variable => &mut renames.variables,
                Element::Event => &mut renames.events,
                _ => continue,
            };
            way.push((change.path.clone(), to.clone()));
        }
        renames
    }

    pub fn is_empty(&self) -> bool {
        self.places.is_empty() && self.variables.is_empty() && self.events.is_empty()
    }

    /// Of a machine or a state.
    pub fn place(&self, path: &Path) -> Path {
        let around = self.places.iter().filter(|(from, _)| within(path, from));
        match around.max_by_key(|(from, _)| from.len()) {
            Some((from, to)) => format!("{to}{}", &path[from.len()..]).into(),
            None => path.clone(),
        }
    }

    pub fn variable(&self, path: &Path) -> Path {
        self.member(&self.variables, path)
    }

    /// Of what set a variable: a state, an event or a machine; other words stay.
    fn doer(&self, path: &Path) -> Path {
        let place = self.place(path);
        if place == *path { self.member(&self.events, path) } else { place }
    }

    /// What a machine has beside states.
    fn member(&self, own: &[(Path, Path)], path: &Path) -> Path {
        if let Some((_, to)) = own.iter().find(|(from, _)| from == path) {
            return to.clone();
        }
        match owner(path) {
            Some(machine) => format!("{}/{}", self.place(&machine.into()), name(path)).into(),
            None => path.clone(),
        }
    }

    /// The name of a state of a machine, by their old paths.
    fn state_name(&self, machine: &str, state: &str) -> Path {
        name(&self.place(&format!("{machine}/{state}").into())).into()
    }

    fn taken(&self, taken: &mut Taken) {
        taken.from = self.state_name(&taken.machine, &taken.from);
        taken.to = self.state_name(&taken.machine, &taken.to);
        taken.machine = self.place(&taken.machine);
        taken.via = taken.via.as_ref().map(|via| self.place(via));
    }
}

impl View {
    /// Before a program is taken over in which these names are others.
    pub(super) fn rename(&mut self, renames: &Renames) {
        if renames.is_empty() {
            return;
        }
        for (path, machine) in &mut self.machines {
            machine.trail.iter_mut().for_each(|trace| trace.from = renames.state_name(path, &trace.from));
            machine.active = machine.active.as_ref().map(|state| renames.place(state));
            machine.spawned_by = machine.spawned_by.as_ref().map(|state| renames.place(state));
        }
        rekey(&mut self.machines, |path| renames.place(path));
        rekey(&mut self.states, |path| renames.place(path));
        self.variables.values_mut().for_each(|variable| variable.by = renames.doer(&variable.by));
        rekey(&mut self.variables, |path| renames.variable(path));
        rekey(&mut self.tuned, |path| renames.variable(path));
        rekey(&mut self.by_hand, |path| renames.variable(path));
        self.taken.iter_mut().for_each(|(_, taken)| renames.taken(taken));
        self.journal.rename(|var| renames.variable(var));
        for breakpoint in &mut self.breakpoints {
            match &mut breakpoint.at {
                BreakAt::State { state } => *state = renames.place(state),
                BreakAt::Condition { machine, .. } => *machine = renames.place(machine),
                // Its text is told anew by the engine.
                BreakAt::Transition { .. } => (),
            }
        }
    }
}

fn rekey<T>(kept: &mut BTreeMap<Path, T>, to: impl Fn(&Path) -> Path) {
    *kept = std::mem::take(kept).into_iter().map(|(path, item)| (to(&path), item)).collect();
}
