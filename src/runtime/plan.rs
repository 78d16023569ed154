//! What a step reads of a program, laid out flat: for each state its guards and actions, side by side in memory.

use std::ops::Range;

use super::time::Time;
use crate::model::{BlockId, Entry, MachineId, Program, StateId, TransitionId, Trigger, VarId};

pub struct Plan {
    states: Vec<StatePlan>,
    guards: Vec<Guard>,
    actions: Vec<BlockId>,
    entries: Vec<EntryItem>,
}

struct StatePlan {
    outgoing: Range<u32>,
    exits: Range<u32>,
    onentry: Range<u32>,
    running: Range<u32>,
    onexit: Range<u32>,
}

#[derive(Clone, Copy)]
pub struct Guard {
    pub transition: TransitionId,
    pub test: Test,
}

#[derive(Clone, Copy)]
pub enum Test {
    Always,
    Block(BlockId),
    After(Time),
    AfterVar(VarId, TransitionId),
    AfterBlock(BlockId),
}

#[derive(Clone, Copy)]
pub enum EntryItem {
    Action(BlockId),
    /// Which of the state's onentry items, and what it spawns; none where that doesn't exist.
    Spawn(u32, Option<(MachineId, StateId)>),
}

impl Plan {
    pub fn of(program: &Program) -> Plan {
        let mut plan = Plan { states: Vec::new(), guards: Vec::new(), actions: Vec::new(), entries: Vec::new() };
        for state in &program.states {
            let state = StatePlan {
                outgoing: append(&mut plan.guards, state.outgoing.iter().filter_map(|&id| guard(program, id))),
                exits: append(&mut plan.guards, state.exits.iter().filter_map(|&id| guard(program, id))),
                onentry: append(&mut plan.entries, state.onentry.iter().enumerate().map(entry)),
                running: append(&mut plan.actions, state.running.iter().copied()),
                onexit: append(&mut plan.actions, state.onexit.iter().copied()),
            };
            plan.states.push(state);
        }
        plan
    }

    pub fn outgoing(&self, state: StateId) -> &[Guard] {
        slice(&self.guards, &self.states[state.index()].outgoing)
    }

    pub fn exits(&self, state: StateId) -> &[Guard] {
        slice(&self.guards, &self.states[state.index()].exits)
    }

    pub fn onentry(&self, state: StateId) -> &[EntryItem] {
        slice(&self.entries, &self.states[state.index()].onentry)
    }

    pub fn running(&self, state: StateId) -> &[BlockId] {
        slice(&self.actions, &self.states[state.index()].running)
    }

    pub fn onexit(&self, state: StateId) -> &[BlockId] {
        slice(&self.actions, &self.states[state.index()].onexit)
    }
}

fn append<T>(arena: &mut Vec<T>, items: impl Iterator<Item = T>) -> Range<u32> {
    let start = arena.len() as u32;
    arena.extend(items);
    start..arena.len() as u32
}

fn slice<'a, T>(arena: &'a [T], range: &Range<u32>) -> &'a [T] {
    &arena[range.start as usize..range.end as usize]
}

fn guard(program: &Program, transition: TransitionId) -> Option<Guard> {
    let test = match program[transition].trigger {
        Trigger::Always => Test::Always,
        Trigger::Event(event) => Test::Block(program[event].block),
        Trigger::Block(block) => Test::Block(block),
        Trigger::After(ms) => Test::After(Time::from_ms(ms)),
        Trigger::AfterVar(var) => Test::AfterVar(var, transition),
        Trigger::AfterBlock(block) => Test::AfterBlock(block),
        Trigger::UnknownEvent(_) | Trigger::AfterUnknown(_) => return None,
    };
    Some(Guard { transition, test })
}

fn entry((index, entry): (usize, &Entry)) -> EntryItem {
    match entry {
        Entry::Action(block) => EntryItem::Action(*block),
        Entry::Spawn(spawn) => EntryItem::Spawn(index as u32, spawn.target),
    }
}
