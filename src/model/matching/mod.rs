//! Which element of one program is which of another: what goes on through an edit. By its place and name, or renamed.

mod keys;
mod renames;
mod scopes;
mod transitions;
mod uses;

use super::element::{ElementId, Kind};
use super::ids::*;
use super::program::Program;

pub(super) use keys::{Key, Reading, Side};

/// By old id the new one, where the element is still there, and the other way round.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matching {
    machines: Table,
    states: Table,
    events: Table,
    vars: Table,
    transitions: Table,
}

#[derive(Clone, Debug, Default, PartialEq)]
struct Table {
    now: Vec<Option<u32>>,
    was: Vec<Option<u32>>,
}

impl Matching {
    pub fn of(old: &Program, new: &Program) -> Matching {
        let mut matching = Matching {
            machines: Table::new(old.machines.len(), new.machines.len()),
            states: Table::new(old.states.len(), new.states.len()),
            events: Table::new(old.events.len(), new.events.len()),
            vars: Table::new(old.vars.len(), new.vars.len()),
            transitions: Table::new(old.transitions.len(), new.transitions.len()),
        };
        let left = scopes::match_names(old, new, &mut matching);
        renames::find(old, new, &mut matching, left);
        transitions::pair(old, new, &mut matching);
        matching
    }

    pub fn machine(&self, old: MachineId) -> Option<MachineId> {
        self.machines.now[old.index()].map(MachineId)
    }

    pub fn state(&self, old: StateId) -> Option<StateId> {
        self.states.now[old.index()].map(StateId)
    }

    pub fn event(&self, old: EventId) -> Option<EventId> {
        self.events.now[old.index()].map(EventId)
    }

    pub fn var(&self, old: VarId) -> Option<VarId> {
        self.vars.now[old.index()].map(VarId)
    }

    /// A transition that says the same as before.
    pub fn transition(&self, old: TransitionId) -> Option<TransitionId> {
        self.transitions.now[old.index()].map(TransitionId)
    }

    pub fn transition_was(&self, new: TransitionId) -> Option<TransitionId> {
        self.transitions.was[new.index()].map(TransitionId)
    }

    pub fn now(&self, old: impl Into<ElementId>) -> Option<ElementId> {
        let ElementId { kind, index } = old.into();
        self.table(kind).now[index as usize].map(|index| ElementId { kind, index })
    }

    pub fn was(&self, new: impl Into<ElementId>) -> Option<ElementId> {
        let ElementId { kind, index } = new.into();
        self.table(kind).was[index as usize].map(|index| ElementId { kind, index })
    }

    fn table(&self, kind: Kind) -> &Table {
        match kind {
            Kind::Machine => &self.machines,
            Kind::State => &self.states,
            Kind::Event => &self.events,
            Kind::Var => &self.vars,
        }
    }

    fn table_mut(&mut self, kind: Kind) -> &mut Table {
        match kind {
            Kind::Machine => &mut self.machines,
            Kind::State => &mut self.states,
            Kind::Event => &mut self.events,
            Kind::Var => &mut self.vars,
        }
    }

    /// The names in a program that mean nothing, once for each place that says them.
    pub(super) fn unresolved(program: &Program) -> Vec<(Kind, &str)> {
        let mut names = Vec::new();
        uses::each_use(program, &mut |it| names.extend(it.found.is_none().then_some((it.kind, it.name))));
        names
    }

    /// Two elements of one kind.
    fn link(&mut self, old: ElementId, new: ElementId) {
        self.table_mut(old.kind).link(old.index, new.index);
    }

    fn unlink(&mut self, old: ElementId) {
        let table = self.table_mut(old.kind);
        if let Some(new) = table.now[old.index as usize].take() {
            table.was[new as usize] = None;
        }
    }
}

impl Table {
    fn new(old: usize, new: usize) -> Table {
        Table { now: vec![None; old], was: vec![None; new] }
    }

    fn link(&mut self, old: u32, new: u32) {
        self.now[old as usize] = Some(new);
        self.was[new as usize] = Some(old);
    }
}
