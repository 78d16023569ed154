//! Looking names up from the innermost scope outwards; where nothing is called so, what was renamed is.

use std::sync::Arc;

use super::element::{ElementId, Kind};
use super::ids::*;
use super::program::{Block, Program, Sources, Transition};
use crate::syntax::FileId;

pub struct Names<'p> {
    program: &'p Program,
}

impl<'p> Names<'p> {
    pub fn of(program: &'p Program) -> Self {
        Names { program }
    }

    /// A machine and those that enclose it, innermost first.
    fn outwards(&self, machine: Option<MachineId>) -> impl Iterator<Item = MachineId> + use<'p> {
        let program = self.program;
        std::iter::successors(machine, move |&machine| program.enclosing(machine))
    }

    pub fn var(&self, machine: Option<MachineId>, name: &str) -> Option<VarId> {
        let named = |&var: &VarId| &*self.program[var].name == name;
        self.outwards(machine)
            .find_map(|machine| self.program[machine].vars.iter().copied().find(named))
            .or_else(|| self.program.globals.iter().copied().find(named))
            .or_else(|| self.renamed_var(machine, name))
    }

    fn renamed_var(&self, machine: Option<MachineId>, name: &str) -> Option<VarId> {
        let var = VarId(self.program.alias(Kind::Var, name)?.index);
        let scope = self.program[var].machine;
        (scope.is_none() || self.outwards(machine).any(|around| Some(around) == scope)).then_some(var)
    }

    /// Every variable in scope, inner ones first.
    pub fn vars_in_scope(&self, machine: Option<MachineId>) -> Vec<VarId> {
        let mut vars: Vec<VarId> =
            self.outwards(machine).flat_map(|machine| self.program[machine].vars.iter().copied()).collect();
        vars.extend(&self.program.globals);
        vars
    }

    pub fn vars(&self, machine: Option<MachineId>) -> Vec<Arc<str>> {
        self.vars_in_scope(machine).into_iter().map(|var| self.program[var].name.clone()).collect()
    }

    pub fn event(&self, machine: MachineId, name: &str) -> Option<EventId> {
        let named = |&event: &EventId| &*self.program[event].name == name;
        self.outwards(Some(machine))
            .find_map(|machine| self.program[machine].events.iter().copied().find(named))
            .or_else(|| self.renamed_event(machine, name))
    }

    fn renamed_event(&self, machine: MachineId, name: &str) -> Option<EventId> {
        let event = EventId(self.program.alias(Kind::Event, name)?.index);
        self.outwards(Some(machine)).any(|around| around == self.program[event].machine).then_some(event)
    }

    pub fn events(&self, machine: MachineId) -> Vec<Arc<str>> {
        let events = self.outwards(Some(machine)).flat_map(|machine| self.program[machine].events.iter());
        events.map(|&event| self.program[event].name.clone()).collect()
    }

    /// The machines a spawn may name: those written in the state and in the states around it, then those at top level
    /// of its file, then those the file imports. Outside all states it is a spawn of the program itself.
    fn machines_in_scope(&self, state: Option<StateId>) -> impl Iterator<Item = MachineId> + use<'p> {
        let program = self.program;
        let around = std::iter::successors(state, move |&state| program[program[state].machine].parent);
        let file = state.map_or(FileId(0), |state| program[state].span.file);
        let outside = program.spawnable.get(file.0 as usize).into_iter().flatten().copied();
        around.flat_map(move |state| program[state].machines.iter().copied()).chain(outside)
    }

    pub fn machine(&self, state: Option<StateId>, name: &str) -> Option<MachineId> {
        let renamed = || self.program.alias(Kind::Machine, name).map(|alias| MachineId(alias.index));
        self.machines_in_scope(state)
            .find(|&machine| &*self.program[machine].name == name)
            .or_else(|| renamed().filter(|renamed| self.machines_in_scope(state).any(|machine| machine == *renamed)))
    }

    pub fn machines(&self, state: Option<StateId>) -> Vec<Arc<str>> {
        self.machines_in_scope(state).map(|machine| self.program[machine].name.clone()).collect()
    }
}

impl Program {
    /// The sources as written, each with the state where there is one.
    pub fn sources_of<'p>(
        &'p self,
        transition: &'p Transition,
    ) -> impl Iterator<Item = (&'p str, Option<StateId>)> + use<'p> {
        let (names, states): (&[_], &[StateId]) = match &transition.sources {
            Sources::Any => (&[], &[]),
            Sources::These { names, states } => (names, states),
        };
        let mut left = states.iter().copied().peekable();
        names.iter().map(move |name| {
            let goes_by = |state: &StateId| {
                self[*state].name == *name || self.alias(Kind::State, name) == Some(ElementId::from(*state))
            };
            (&**name, left.next_if(goes_by))
        })
    }

    /// The variable that a free name of a block is.
    pub(super) fn var_in(&self, block: &Block, name: &str) -> Option<VarId> {
        let named = block.uses.iter().copied().find(|&var| *self[var].name == *name);
        let renamed = || block.uses.iter().copied().find(|&var| self.alias(Kind::Var, name) == Some(var.into()));
        named.or_else(renamed)
    }
}
