//! The tree of a program as written: one struct for each form of the grammar, in the order of the text.

use std::sync::Arc;

use super::source::Span;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree {
    pub forms: Vec<Form>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    Bridge(Bridge),
    Import(Import),
    Export(Export),
    Var(Var),
    Machine(Machine),
    Spawn(Spawn),
    OnPause(Block),
    OnResume(Block),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    pub text: Arc<str>,
    pub span: Span,
}

/// Lua between square brackets: the text and span of what is inside them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    pub text: Arc<str>,
    pub span: Span,
}

/// `(bridge NAME KIND [config])`; the config is the inside of a Lua table constructor.
#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    pub span: Span,
    pub name: Name,
    pub kind: Name,
    pub config: Option<Block>,
}

/// `(import "file.lrp")`
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    pub span: Span,
    pub file: Name,
}

/// `(export MACHINE)`
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    pub span: Span,
    pub machine: Name,
}

/// `(var x := [init])`
#[derive(Clone, Debug, PartialEq)]
pub struct Var {
    pub span: Span,
    pub name: Name,
    pub init: Block,
}

/// `(machine NAME item*)`
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    pub span: Span,
    pub name: Name,
    pub items: Vec<MachineItem>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum MachineItem {
    Var(Var),
    Event(Event),
    State(State),
    Transition(Transition),
}

/// `(event e [b])` or `(event e := [b])`
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    pub span: Span,
    pub name: Name,
    pub block: Block,
}

/// `(state NAME item*)`
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub span: Span,
    pub name: Name,
    pub items: Vec<StateItem>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum StateItem {
    OnEntry(Entry),
    Running(Block),
    OnExit(Block),
    Break(Span),
    Machine(Machine),
}

/// What an `(onentry ..)` does.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    Action(Block),
    Spawn(Spawn),
}

/// `(spawn MACHINE STATE)`
#[derive(Clone, Debug, PartialEq)]
pub struct Spawn {
    pub span: Span,
    pub machine: Name,
    pub state: Name,
}

/// `(on T SRC -> DST name?)`, `(eps SRC -> DST name?)`, `(ontime MS SRC -> DST name?)`, `(exit T SRC -> DST name?)`,
/// each with a `(break)` at its end where the program is to pause
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    pub span: Span,
    pub kind: TransitionKind,
    pub sources: Sources,
    pub target: Name,
    pub name: Option<Name>,
    /// More than one is a mistake, but not of how it is written.
    pub breaks: Vec<Span>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum TransitionKind {
    On(Trigger),
    Eps,
    Ontime(Timeout),
    Exit(Trigger),
}

/// A bare name is always an event.
#[derive(Clone, Debug, PartialEq)]
pub enum Trigger {
    Event(Name),
    Block(Block),
}

#[derive(Clone, Debug, PartialEq)]
pub enum Timeout {
    /// Milliseconds, as written in the text: not negative, finite.
    Number {
        ms: f64,
        span: Span,
    },
    Variable(Name),
    Block(Block),
}

/// Where a transition leaves from: one state, `*`, or `(a b c)`.
#[derive(Clone, Debug, PartialEq)]
pub enum Sources {
    One(Name),
    Any(Span),
    Some(Vec<Name>),
}
