//! What a step reads of a program, laid out flat: for each state its guards and actions, side by side in memory. Blocks that
//! can't be compiled are left out.

use std::ops::Range;

use super::store::Store;
use super::time::Time;
use crate::lua;
use crate::model::{BlockId, Entry, MachineId, Program, StateId, TransitionId, Trigger, VarId};

#[derive(Default)]
pub struct Plan {
    states: Vec<StatePlan>,
    guards: Vec<Guard>,
    transitions: Vec<TransitionId>,
    entries: Vec<EntryItem>,
    blocks: Vec<BlockId>,
    /// Of the blocks, in their order.
    functions: Vec<lua::Block>,
}

struct StatePlan {
    outgoing: Range<u32>,
    exits: Range<u32>,
    onentry: Range<u32>,
    running: Calls,
    onexit: Calls,
}

/// Blocks to be called in order, all of the same scope.
#[derive(Clone, Copy)]
pub struct Calls {
    start: u32,
    end: u32,
    /// Whose time `elapsed()` is.
    pub machine: Option<MachineId>,
    /// Whether any of them reads or writes variables.
    pub use_variables: bool,
}

/// What is tested at once: for one transition, or blocks for as many.
#[derive(Clone, Copy)]
pub struct Guard {
    first: u32,
    pub test: Test,
}

#[derive(Clone, Copy)]
pub enum Test {
    Always,
    Blocks(Calls),
    After(Time),
    AfterVar(VarId),
    AfterBlock(BlockId),
}

#[derive(Clone, Copy)]
pub enum EntryItem {
    Actions(Calls),
    /// Which of the state's onentry items, and what it spawns.
    Spawn(u32, (MachineId, StateId)),
}

impl Plan {
    pub fn of(program: &Program, store: &Store) -> Plan {
        let mut plan = Plan::default();
        for state in &program.states {
            let state = StatePlan {
                outgoing: plan.guards(program, store, &state.outgoing),
                exits: plan.exit_guards(program, store, &state.exits),
                onentry: plan.entry(store, &state.onentry),
                running: plan.calls(store, state.running.iter().copied()),
                onexit: plan.calls(store, state.onexit.iter().copied()),
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

    pub fn running(&self, state: StateId) -> Calls {
        self.states[state.index()].running
    }

    pub fn onexit(&self, state: StateId) -> Calls {
        self.states[state.index()].onexit
    }

    /// The transition that the test at `index` of a guard is of.
    pub fn transition(&self, guard: &Guard, index: usize) -> TransitionId {
        self.transitions[guard.first as usize + index]
    }

    pub fn blocks(&self, calls: Calls) -> &[BlockId] {
        slice(&self.blocks, &calls.range())
    }

    pub fn functions(&self, calls: Calls) -> &[lua::Block] {
        slice(&self.functions, &calls.range())
    }

    fn guards(&mut self, program: &Program, store: &Store, transitions: &[TransitionId]) -> Range<u32> {
        let testable = testable(program, store, transitions);
        let scope = |id: &TransitionId| Some(store.block(condition(program, *id)?).machine);
        let stretches = testable.chunk_by(|a, b| scope(a).is_some() && scope(a) == scope(b));
        self.all_guards(program, store, stretches)
    }

    /// Each for itself, as it counts only while its own machine is in the right state.
    fn exit_guards(&mut self, program: &Program, store: &Store, transitions: &[TransitionId]) -> Range<u32> {
        self.all_guards(program, store, testable(program, store, transitions).chunks(1))
    }

    fn all_guards<'a>(
        &mut self,
        program: &Program,
        store: &Store,
        stretches: impl Iterator<Item = &'a [TransitionId]>,
    ) -> Range<u32> {
        let start = self.guards.len() as u32;
        for stretch in stretches {
            let first = self.transitions.len() as u32;
            self.transitions.extend(stretch);
            let conditions = self.calls(store, stretch.iter().filter_map(|&id| condition(program, id)));
            let test = match program[stretch[0]].trigger {
                Trigger::Always => Test::Always,
                Trigger::After(ms) => Test::After(Time::from_ms(ms)),
                Trigger::AfterVar(var) => Test::AfterVar(var),
                Trigger::AfterBlock(block) => Test::AfterBlock(block),
                _ => Test::Blocks(conditions),
            };
            self.guards.push(Guard { first, test });
        }
        start..self.guards.len() as u32
    }

    fn entry(&mut self, store: &Store, items: &[Entry]) -> Range<u32> {
        let start = self.entries.len() as u32;
        let mut index = 0;
        for stretch in items.chunk_by(|a, b| action(a).is_some() && action(b).is_some()) {
            match &stretch[0] {
                Entry::Action(_) => {
                    let actions = self.calls(store, stretch.iter().filter_map(action));
                    self.entries.push(EntryItem::Actions(actions));
                }
                Entry::Spawn(spawn) => self.entries.extend(spawn.target.map(|target| EntryItem::Spawn(index, target))),
            }
            index += stretch.len() as u32;
        }
        start..self.entries.len() as u32
    }

    fn calls(&mut self, store: &Store, blocks: impl Iterator<Item = BlockId>) -> Calls {
        let start = self.blocks.len() as u32;
        let mut calls = Calls { start, end: start, machine: None, use_variables: false };
        for block in blocks {
            let compiled = store.block(block);
            let Some(function) = compiled.lua else { continue };
            self.blocks.push(block);
            self.functions.push(function);
            calls.end += 1;
            calls.machine = compiled.machine;
            calls.use_variables |= compiled.uses_variables;
        }
        calls
    }
}

impl Calls {
    pub fn is_empty(self) -> bool {
        self.start == self.end
    }

    fn range(self) -> Range<u32> {
        self.start..self.end
    }
}

fn slice<'a, T>(arena: &'a [T], range: &Range<u32>) -> &'a [T] {
    &arena[range.start as usize..range.end as usize]
}

fn action(entry: &Entry) -> Option<BlockId> {
    match entry {
        Entry::Action(block) => Some(*block),
        Entry::Spawn(_) => None,
    }
}

/// Those of the transitions that could ever be taken.
fn testable(program: &Program, store: &Store, transitions: &[TransitionId]) -> Vec<TransitionId> {
    let could = |&id: &TransitionId| match program[id].trigger {
        Trigger::UnknownEvent(_) | Trigger::AfterUnknown(_) => false,
        _ => condition(program, id).is_none_or(|block| store.block(block).lua.is_some()),
    };
    transitions.iter().copied().filter(could).collect()
}

/// The block that is a transition's condition.
fn condition(program: &Program, transition: TransitionId) -> Option<BlockId> {
    match program[transition].trigger {
        Trigger::Event(event) => Some(program[event].block),
        Trigger::Block(block) => Some(block),
        _ => None,
    }
}
