//! A program with every name resolved, in flat arenas: what the engine runs, the screen draws and the checks read.

use std::ops::Index;
use std::sync::Arc;

use super::element::Alias;
use super::ids::*;
use crate::lua::{Facts, Precompiled};
use crate::syntax::{Diagnostic, FileId, Source, Span};

/// Elements that refer to something that doesn't exist keep the name as written and are skipped when run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The texts, by the `FileId` of spans: the program itself, the files it imports, the Lua files it requires.
    pub sources: Vec<Source>,
    pub machines: Vec<Machine>,
    pub states: Vec<State>,
    pub transitions: Vec<Transition>,
    pub events: Vec<Event>,
    pub vars: Vec<Var>,
    pub blocks: Vec<Block>,
    pub modules: Vec<Module>,
    /// Top-level machines in the order written, those of the program itself before those of imported files.
    pub tops: Vec<MachineId>,
    /// By `FileId`: the top-level machines that spawns in the file may name, its own before those it imports.
    pub spawnable: Vec<Vec<MachineId>>,
    /// In the order they are initialised.
    pub globals: Vec<VarId>,
    pub spawns: Vec<Spawn>,
    /// Machines that the program and the files it imports let others import.
    pub exported: Vec<MachineId>,
    pub bridges: Vec<Bridge>,
    pub on_pause: Option<BlockId>,
    pub on_resume: Option<BlockId>,
    /// An element that was renamed, while its uses still go by the old name.
    pub alias: Option<Alias>,
    /// What the checks found; none of it keeps the program from running.
    pub findings: Vec<Diagnostic>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    pub name: Arc<str>,
    /// `root/r1/nest1`
    pub path: Arc<str>,
    /// The state it is written in; none at top level.
    pub parent: Option<StateId>,
    pub vars: Vec<VarId>,
    pub events: Vec<EventId>,
    pub states: Vec<StateId>,
    /// In the order written, exits among them.
    pub transitions: Vec<TransitionId>,
    pub span: Span,
    pub name_span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub name: Arc<str>,
    /// `root/r1/nest1/n1`
    pub path: Arc<str>,
    pub machine: MachineId,
    pub onentry: Vec<Entry>,
    pub running: Vec<BlockId>,
    pub onexit: Vec<BlockId>,
    /// Machines written in this state.
    pub machines: Vec<MachineId>,
    /// What may fire while it is active, in the order written; wildcards among them.
    pub outgoing: Vec<TransitionId>,
    /// Exit transitions of the machines written in it, which leave this state.
    pub exits: Vec<TransitionId>,
    /// Its `(break)`.
    pub breakpoint: Option<Span>,
    pub span: Span,
    pub name_span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    Action(BlockId),
    Spawn(Spawn),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Spawn {
    pub machine_name: Arc<str>,
    pub state_name: Arc<str>,
    /// Where it exists, whether or not the state does.
    pub machine: Option<MachineId>,
    /// The machine and the state, where both exist.
    pub target: Option<(MachineId, StateId)>,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// The machine it is written in.
    pub machine: MachineId,
    pub kind: TransitionKind,
    pub sources: Sources,
    pub target_name: Arc<str>,
    /// A state of `machine`, or for an exit of its parent machine.
    pub target: Option<StateId>,
    pub name: Option<Arc<str>>,
    pub trigger: Trigger,
    /// Its `(break)`.
    pub breakpoint: Option<Span>,
    pub span: Span,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TransitionKind {
    On,
    Eps,
    Ontime,
    Exit,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Sources {
    /// `*`
    Any,
    /// One state or a subset, as written; those that exist.
    These { names: Vec<Arc<str>>, states: Vec<StateId> },
}

#[derive(Clone, Debug, PartialEq)]
pub enum Trigger {
    Always,
    Event(EventId),
    UnknownEvent(Arc<str>),
    Block(BlockId),
    /// Milliseconds since the state was entered.
    After(f64),
    AfterVar(VarId),
    AfterUnknown(Arc<str>),
    AfterBlock(BlockId),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    pub name: Arc<str>,
    pub path: Arc<str>,
    pub machine: MachineId,
    pub block: BlockId,
    pub span: Span,
    pub name_span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Var {
    pub name: Arc<str>,
    /// `root/r1/nest1/x`, or the bare name of a global.
    pub path: Arc<str>,
    /// None: global.
    pub machine: Option<MachineId>,
    pub init: BlockId,
    pub span: Span,
    pub name_span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    pub code: Arc<str>,
    /// The inside of the brackets.
    pub span: Span,
    /// The scope it is written in; none at top level.
    pub machine: Option<MachineId>,
    pub owner: Owner,
    /// The variables it reads or writes, found through its scopes.
    pub uses: Vec<VarId>,
    pub reads: Vec<VarId>,
    pub writes: Vec<VarId>,
    /// Names in it that nothing is known by.
    pub missing: Vec<Arc<str>>,
    /// What can be said of its text alone; nothing where that isn't Lua.
    pub facts: Arc<Facts>,
    /// Its text compiled, as far as that can be done without the interpreter that will run it.
    pub precompiled: Option<Arc<Precompiled>>,
    /// The Lua files it requires by a literal name, also through other ones; sorted.
    pub requires: Vec<ModuleId>,
}

/// A Lua file that blocks require by a literal name: its text counts as part of each block that requires it.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// `a.b` for the file `a/b.lua`.
    pub name: Arc<str>,
    pub file: FileId,
    /// Those that it requires in turn, also through other ones; sorted.
    pub requires: Vec<ModuleId>,
}

/// The element a block is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    Program,
    Var(VarId),
    Event(EventId),
    State(StateId),
    Transition(TransitionId),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    pub name: Arc<str>,
    pub kind: Arc<str>,
    pub config: serde_json::Value,
    pub span: Span,
}

macro_rules! index {
    ($($id:ident => $arena:ident: $element:ty,)*) => {$(
        impl Index<$id> for Program {
            type Output = $element;

            fn index(&self, id: $id) -> &$element {
                &self.$arena[id.index()]
            }
        }
    )*};
}

index! {
    MachineId => machines: Machine,
    StateId => states: State,
    TransitionId => transitions: Transition,
    EventId => events: Event,
    VarId => vars: Var,
    BlockId => blocks: Block,
    ModuleId => modules: Module,
}

impl Program {
    pub fn source(&self, span: Span) -> &Source {
        &self.sources[span.file.0 as usize]
    }

    pub fn module_text(&self, module: ModuleId) -> &Arc<str> {
        &self.sources[self[module].file.0 as usize].text
    }

    /// The machine that encloses the state a machine is written in.
    pub fn enclosing(&self, machine: MachineId) -> Option<MachineId> {
        self[machine].parent.map(|state| self[state].machine)
    }

    pub fn machine(&self, path: &str) -> Option<MachineId> {
        let found = self.machines.iter().position(|machine| &*machine.path == path)?;
        Some(MachineId(found as u32))
    }

    pub fn state(&self, path: &str) -> Option<StateId> {
        let found = self.states.iter().position(|state| &*state.path == path)?;
        Some(StateId(found as u32))
    }

    pub fn var(&self, path: &str) -> Option<VarId> {
        let found = self.vars.iter().position(|var| &*var.path == path)?;
        Some(VarId(found as u32))
    }

    /// The path of the state, event, variable or machine that a block is written in; empty at top level.
    pub fn owner_path(&self, block: BlockId) -> Arc<str> {
        self.owner_path_of(&self[block])
    }

    pub fn owner_path_of(&self, block: &Block) -> Arc<str> {
        match block.owner {
            Owner::Program => Arc::default(),
            Owner::Var(var) => self[var].path.clone(),
            Owner::Event(event) => self[event].path.clone(),
            Owner::State(state) => self[state].path.clone(),
            Owner::Transition(transition) => self[self[transition].machine].path.clone(),
        }
    }

    /// The actions on pause and resume.
    pub fn hooks(&self) -> Vec<BlockId> {
        self.on_pause.into_iter().chain(self.on_resume).collect()
    }

    /// The blocks written in the transitions of a machine.
    pub fn guards(&self, machine: MachineId) -> Vec<BlockId> {
        let block = |&id: &TransitionId| match self[id].trigger {
            Trigger::Block(block) | Trigger::AfterBlock(block) => Some(block),
            _ => None,
        };
        self[machine].transitions.iter().filter_map(block).collect()
    }

    pub fn state_named(&self, machine: MachineId, name: &str) -> Option<StateId> {
        self[machine].states.iter().copied().find(|&state| &*self[state].name == name)
    }
}

impl State {
    /// All its actions.
    pub fn blocks(&self) -> Vec<BlockId> {
        let onentry = self.onentry.iter().filter_map(|item| match item {
            Entry::Action(block) => Some(*block),
            Entry::Spawn(_) => None,
        });
        onentry.chain(self.running.iter().copied()).chain(self.onexit.iter().copied()).collect()
    }

    /// What its onentry spawns, each with its place among the onentry items.
    pub fn spawns(&self) -> impl Iterator<Item = (u32, &Spawn)> {
        (0..).zip(&self.onentry).filter_map(|(index, item)| match item {
            Entry::Spawn(spawn) => Some((index, spawn)),
            Entry::Action(_) => None,
        })
    }
}

impl TransitionKind {
    pub fn form(self) -> &'static str {
        match self {
            TransitionKind::On => "on",
            TransitionKind::Eps => "eps",
            TransitionKind::Ontime => "ontime",
            TransitionKind::Exit => "exit",
        }
    }
}

impl Transition {
    pub fn leaves(&self, state: StateId) -> bool {
        match &self.sources {
            Sources::Any => true,
            Sources::These { states, .. } => states.contains(&state),
        }
    }
}
