//! Programs for the tests of the screen, straight from text: names looked up, blocks not compiled.

use std::sync::Arc;

use lrp::model::*;
use lrp::syntax::ast::{self, Form, MachineItem, StateItem};
use lrp::syntax::{FileId, Source, parse};

pub const LINE_FOLLOWER: &str = include_str!("line_follower.lrp");

/// A program named `line_follower.lrp`.
pub fn program(text: &str) -> Arc<Program> {
    let source = Source::new("line_follower.lrp", text);
    let parsed = parse(&source, FileId(0));
    assert_eq!(parsed.diagnostics, Vec::new());
    let mut builder = Builder { program: Program { sources: vec![source], ..Program::default() } };
    for form in &parsed.tree.forms {
        match form {
            Form::Var(var) => {
                let var = builder.var(var, None);
                builder.program.globals.push(var);
            }
            Form::Machine(machine) => {
                let machine = builder.machine(machine, None);
                builder.program.tops.push(machine);
            }
            _ => (),
        }
    }
    Arc::new(builder.program)
}

struct Builder {
    program: Program,
}

impl Builder {
    fn path(&self, owner: Option<Arc<str>>, name: &str) -> Arc<str> {
        owner.map_or(name.into(), |owner| format!("{owner}/{name}").into())
    }

    fn block(&mut self, block: &ast::Block, machine: Option<MachineId>) -> BlockId {
        let block = Block {
            code: block.text.clone(),
            span: block.span,
            machine,
            owner: Owner::Program,
            uses: Vec::new(),
        };
        self.program.blocks.push(block);
        BlockId(self.program.blocks.len() as u32 - 1)
    }

    fn var(&mut self, var: &ast::Var, machine: Option<MachineId>) -> VarId {
        let init = self.block(&var.init, machine);
        let path = self.path(machine.map(|machine| self.program[machine].path.clone()), &var.name.text);
        let (span, name_span) = (var.span, var.name.span);
        self.program.vars.push(Var { name: var.name.text.clone(), path, machine, init, span, name_span });
        VarId(self.program.vars.len() as u32 - 1)
    }

    fn machine(&mut self, machine: &ast::Machine, parent: Option<StateId>) -> MachineId {
        let id = MachineId(self.program.machines.len() as u32);
        let path = self.path(parent.map(|state| self.program[state].path.clone()), &machine.name.text);
        self.program.machines.push(Machine {
            name: machine.name.text.clone(),
            path,
            parent,
            vars: Vec::new(),
            events: Vec::new(),
            states: Vec::new(),
            transitions: Vec::new(),
            span: machine.span,
            name_span: machine.name.span,
        });
        for item in &machine.items {
            match item {
                MachineItem::Var(var) => {
                    let var = self.var(var, Some(id));
                    self.program.machines[id.index()].vars.push(var);
                }
                MachineItem::Event(event) => self.event(event, id),
                MachineItem::State(state) => self.state(state, id),
                MachineItem::Transition(_) => (),
            }
        }
        for item in &machine.items {
            if let MachineItem::Transition(transition) = item {
                self.transition(transition, id);
            }
        }
        id
    }

    fn event(&mut self, event: &ast::Event, machine: MachineId) {
        let block = self.block(&event.block, Some(machine));
        let path = self.path(Some(self.program[machine].path.clone()), &event.name.text);
        self.program.events.push(Event { name: event.name.text.clone(), path, machine, block, span: event.span });
        let id = EventId(self.program.events.len() as u32 - 1);
        self.program.machines[machine.index()].events.push(id);
    }

    fn state(&mut self, state: &ast::State, machine: MachineId) {
        let id = StateId(self.program.states.len() as u32);
        let path = self.path(Some(self.program[machine].path.clone()), &state.name.text);
        self.program.states.push(State {
            name: state.name.text.clone(),
            path,
            machine,
            onentry: Vec::new(),
            running: Vec::new(),
            onexit: Vec::new(),
            machines: Vec::new(),
            outgoing: Vec::new(),
            exits: Vec::new(),
            span: state.span,
            name_span: state.name.span,
        });
        self.program.machines[machine.index()].states.push(id);
        for item in &state.items {
            match item {
                StateItem::Running(block) => {
                    let block = self.block(block, Some(machine));
                    self.program.states[id.index()].running.push(block);
                }
                StateItem::OnExit(block) => {
                    let block = self.block(block, Some(machine));
                    self.program.states[id.index()].onexit.push(block);
                }
                StateItem::OnEntry(ast::Entry::Action(block)) => {
                    let block = self.block(block, Some(machine));
                    self.program.states[id.index()].onentry.push(Entry::Action(block));
                }
                StateItem::OnEntry(ast::Entry::Spawn(spawn)) => {
                    let spawn = Spawn {
                        machine_name: spawn.machine.text.clone(),
                        state_name: spawn.state.text.clone(),
                        target: None,
                        span: spawn.span,
                    };
                    self.program.states[id.index()].onentry.push(Entry::Spawn(spawn));
                }
                StateItem::Machine(inner) => {
                    let inner = self.machine(inner, Some(id));
                    self.program.states[id.index()].machines.push(inner);
                }
            }
        }
    }

    fn transition(&mut self, transition: &ast::Transition, machine: MachineId) {
        let id = TransitionId(self.program.transitions.len() as u32);
        let (kind, trigger) = self.trigger(&transition.kind, machine);
        let states = &self.program.machines[machine.index()].states;
        let named = |name: &str| states.iter().copied().find(|&state| &*self.program[state].name == name);
        let sources = match &transition.sources {
            ast::Sources::Any(_) => Sources::Any,
            ast::Sources::One(name) => these(std::slice::from_ref(name), named),
            ast::Sources::Some(names) => these(names, named),
        };
        let transition = Transition {
            machine,
            kind,
            target: named(&transition.target.text),
            sources,
            target_name: transition.target.text.clone(),
            name: transition.name.as_ref().map(|name| name.text.clone()),
            trigger,
            span: transition.span,
        };
        for state in states.clone() {
            if transition.leaves(state) {
                self.program.states[state.index()].outgoing.push(id);
            }
        }
        self.program.transitions.push(transition);
        self.program.machines[machine.index()].transitions.push(id);
    }

    fn trigger(&mut self, kind: &ast::TransitionKind, machine: MachineId) -> (TransitionKind, Trigger) {
        match kind {
            ast::TransitionKind::On(trigger) => (TransitionKind::On, self.event_or_block(trigger, machine)),
            ast::TransitionKind::Exit(trigger) => (TransitionKind::Exit, self.event_or_block(trigger, machine)),
            ast::TransitionKind::Eps => (TransitionKind::Eps, Trigger::Always),
            ast::TransitionKind::Ontime(timeout) => {
                let trigger = match timeout {
                    ast::Timeout::Number { ms, .. } => Trigger::After(*ms),
                    ast::Timeout::Block(block) => Trigger::AfterBlock(self.block(block, Some(machine))),
                    ast::Timeout::Variable(name) => {
                        let found = self.program.vars.iter().rposition(|var| var.name == name.text);
                        found.map_or(Trigger::AfterUnknown(name.text.clone()), |i| Trigger::AfterVar(VarId(i as u32)))
                    }
                };
                (TransitionKind::Ontime, trigger)
            }
        }
    }

    fn event_or_block(&mut self, trigger: &ast::Trigger, machine: MachineId) -> Trigger {
        match trigger {
            ast::Trigger::Block(block) => Trigger::Block(self.block(block, Some(machine))),
            ast::Trigger::Event(name) => {
                let found = self.program.events.iter().rposition(|event| event.name == name.text);
                found.map_or(Trigger::UnknownEvent(name.text.clone()), |i| Trigger::Event(EventId(i as u32)))
            }
        }
    }
}

fn these(names: &[ast::Name], named: impl Fn(&str) -> Option<StateId>) -> Sources {
    let states = names.iter().filter_map(|name| named(&name.text)).collect();
    Sources::These { names: names.iter().map(|name| name.text.clone()).collect(), states }
}
