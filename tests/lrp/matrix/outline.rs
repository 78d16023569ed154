//! What stands where in a tree, and what its names mean there.

use std::collections::BTreeMap;

use super::tree::*;

pub struct Outline<'t> {
    pub tree: &'t Tree,
    pub machines: BTreeMap<Id, MachineAt<'t>>,
    pub states: BTreeMap<Id, StateAt<'t>>,
    /// All of them: global ones first, outer ones before inner ones.
    pub vars: Vec<VarAt<'t>>,
    pub events: Vec<EventAt<'t>>,
}

pub struct MachineAt<'t> {
    pub path: String,
    pub machine: &'t Machine,
    /// The state it is written in.
    pub inside: Option<Id>,
}

pub struct StateAt<'t> {
    pub path: String,
    pub state: &'t State,
    pub of: Id,
}

pub struct VarAt<'t> {
    pub path: String,
    pub var: &'t Var,
    pub of: Option<Id>,
}

pub struct EventAt<'t> {
    pub path: String,
    pub event: &'t Event,
    pub of: Id,
}

impl<'t> Outline<'t> {
    pub fn of(tree: &'t Tree) -> Outline<'t> {
        let (machines, states) = (BTreeMap::new(), BTreeMap::new());
        let mut outline = Outline { tree, machines, states, vars: Vec::new(), events: Vec::new() };
        let globals = tree.vars.iter().map(|var| VarAt { path: var.name.clone(), var, of: None });
        outline.vars.extend(globals);
        tree.machines.iter().for_each(|machine| outline.add(machine, None, machine.name.clone()));
        outline
    }

    fn add(&mut self, machine: &'t Machine, inside: Option<Id>, path: String) {
        let inner = |name: &str| format!("{path}/{name}");
        let of = machine.id;
        self.vars.extend(machine.vars.iter().map(|var| VarAt { path: inner(&var.name), var, of: Some(of) }));
        self.events.extend(machine.events.iter().map(|event| EventAt { path: inner(&event.name), event, of }));
        for state in &machine.states {
            let path = inner(&state.name);
            for nested in &state.machines {
                self.add(nested, Some(state.id), format!("{path}/{}", nested.name));
            }
            self.states.insert(state.id, StateAt { path, state, of });
        }
        self.machines.insert(of, MachineAt { path, machine, inside });
    }

    /// A machine and those it is written in, innermost first.
    fn around(&self, machine: Option<Id>) -> Vec<Id> {
        let outer = |&id: &Id| self.machines[&id].inside.map(|state| self.states[&state].of);
        std::iter::successors(machine, outer).collect()
    }

    /// What a block of a machine, or at top level, means by a name.
    pub fn var(&self, name: &str, from: Option<Id>) -> Option<&VarAt<'t>> {
        let (name, seen) = (self.tree.meant(name), self.around(from));
        self.vars.iter().find(|at| at.var.name == name && at.of.is_none_or(|of| seen.contains(&of)))
    }

    pub fn event(&self, name: &str, from: Id) -> Option<&EventAt<'t>> {
        let (name, seen) = (self.tree.meant(name), self.around(Some(from)));
        self.events.iter().find(|at| at.event.name == name && seen.contains(&at.of))
    }

    pub fn state(&self, name: &str, of: Id) -> Option<&'t State> {
        let name = self.tree.meant(name);
        self.machines[&of].machine.states.iter().find(|state| state.name == name)
    }

    /// The machine and state that a spawn in a state, or at top level, means.
    pub fn spawned(&self, spawn: &Spawn, from: Option<Id>) -> Option<(Id, Id)> {
        let machine = self.machine(&spawn.machine, from)?;
        Some((machine, self.state(&spawn.state, machine)?.id))
    }

    pub fn machine(&self, name: &str, from: Option<Id>) -> Option<Id> {
        let name = self.tree.meant(name);
        let outer = |&state: &Id| self.machines[&self.states[&state].of].inside;
        let states: Vec<Id> = std::iter::successors(from, outer).collect();
        let seen = |at: &MachineAt| at.machine.name == name && at.inside.is_none_or(|state| states.contains(&state));
        self.machines.values().find(|&at| seen(at)).map(|at| at.machine.id)
    }
}
