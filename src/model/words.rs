//! An element's text as a row of words that tell what they name: what two texts are compared by. Layout and comments are
//! not among them, nor is the element's own name.

use std::borrow::Cow;

use super::element::{ElementId, Kind};
use super::ids::*;
use super::program::*;
use crate::syntax::lua_names;
use crate::syntax::lua_tokens::{TokenKind, with_line_feeds};

#[derive(Clone, Debug, PartialEq)]
pub enum Word<'p> {
    /// Where a part of the text begins or ends.
    Mark(&'static str),
    Text(Cow<'p, str>),
    Number(f64),
    /// The name of an element that is written here.
    Declares(ElementId),
    /// A name that is looked up, with what was found.
    Names(Kind, &'p str, Option<ElementId>),
}

/// Hands over words one after the other.
pub struct Words<'p, F: FnMut(Word<'p>)> {
    program: &'p Program,
    each: F,
}

impl<'p, F: FnMut(Word<'p>)> Words<'p, F> {
    pub fn of(program: &'p Program, each: F) -> Self {
        Words { program, each }
    }

    pub fn element(&mut self, element: ElementId) {
        let program = self.program;
        match element.kind {
            Kind::Machine => self.machine(&program[MachineId(element.index)]),
            Kind::State => self.state(&program[StateId(element.index)]),
            Kind::Event => self.block(program[EventId(element.index)].block),
            Kind::Var => self.block(program[VarId(element.index)].init),
        }
    }

    fn machine(&mut self, machine: &'p Machine) {
        machine.vars.iter().for_each(|&var| self.inside("var", var.into()));
        machine.events.iter().for_each(|&event| self.inside("event", event.into()));
        machine.states.iter().for_each(|&state| self.inside("state", state.into()));
        machine.transitions.iter().for_each(|&transition| self.transition(transition));
    }

    fn state(&mut self, state: &'p State) {
        for entry in &state.onentry {
            self.mark("onentry");
            match entry {
                Entry::Action(block) => self.block(*block),
                Entry::Spawn(spawn) => self.spawn(spawn),
            }
        }
        for (form, blocks) in [("running", &state.running), ("onexit", &state.onexit)] {
            for &block in blocks {
                self.mark(form);
                self.block(block);
            }
        }
        state.machines.iter().for_each(|&machine| self.inside("machine", machine.into()));
    }

    fn inside(&mut self, form: &'static str, element: ElementId) {
        self.mark(form);
        (self.each)(Word::Declares(element));
        self.element(element);
        self.mark("end");
    }

    fn mark(&mut self, mark: &'static str) {
        (self.each)(Word::Mark(mark));
    }

    fn names(&mut self, kind: Kind, name: &'p str, found: Option<impl Into<ElementId>>) {
        (self.each)(Word::Names(kind, name, found.map(Into::into)));
    }

    pub fn spawn(&mut self, spawn: &'p Spawn) {
        self.names(Kind::Machine, &spawn.machine_name, spawn.machine);
        self.names(Kind::State, &spawn.state_name, spawn.target.map(|(_, state)| state));
    }

    pub fn transition(&mut self, id: TransitionId) {
        let program = self.program;
        let transition = &program[id];
        self.mark(transition.kind.form());
        match &transition.trigger {
            Trigger::Always => {}
            Trigger::Event(event) => self.names(Kind::Event, program.name(*event), Some(*event)),
            Trigger::UnknownEvent(name) => self.names(Kind::Event, name, None::<EventId>),
            Trigger::After(ms) => (self.each)(Word::Number(*ms)),
            Trigger::AfterVar(var) => self.names(Kind::Var, program.name(*var), Some(*var)),
            Trigger::AfterUnknown(name) => self.names(Kind::Var, name, None::<VarId>),
            Trigger::Block(block) | Trigger::AfterBlock(block) => self.block(*block),
        }
        match &transition.sources {
            Sources::Any => self.mark("*"),
            Sources::These { .. } => {
                program.sources_of(transition).for_each(|(name, state)| self.names(Kind::State, name, state));
            }
        }
        self.mark("->");
        self.names(Kind::State, &transition.target_name, transition.target);
        if let Some(name) = &transition.name {
            (self.each)(Word::Text(Cow::Borrowed(name)));
        }
    }

    pub fn block(&mut self, id: BlockId) {
        let program = self.program;
        let block = &program[id];
        self.mark("[");
        for word in lua_names::words(&block.code) {
            let text = &block.code[word.token.range];
            match word.token.kind {
                _ if word.is_free => self.names(Kind::Var, text, program.var_in(block, text)),
                TokenKind::String => (self.each)(Word::Text(with_line_feeds(text))),
                _ => (self.each)(Word::Text(Cow::Borrowed(text))),
            }
        }
        self.mark("]");
    }
}
