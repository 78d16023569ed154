//! From tree to program: declares every element, then looks every name up from the innermost scope outwards.
//! What can't be found is reported and left unresolved; the rest of the program stays usable.

use std::collections::HashMap;
use std::sync::Arc;

use super::element::Alias;
use super::ids::*;
use super::names::Names;
use super::program::*;
use crate::lua::Checker;
use crate::syntax::ast::{self, Form, MachineItem, StateItem, Tree};
use crate::syntax::{Code, Diagnostic, Source, Span};

/// A robot chosen on the command line; it takes the place of the program's own bridge of that name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Robot {
    pub name: String,
    pub kind: String,
}

pub fn resolve(tree: &Tree, source: Source, robots: &[Robot], checker: &mut Checker) -> Program {
    resolve_renamed(tree, source, robots, checker, None)
}

/// With `alias`, one element of the program that comes of it can be found by another name as well.
pub fn resolve_renamed(
    tree: &Tree,
    source: Source,
    robots: &[Robot],
    checker: &mut Checker,
    alias: Option<Alias>,
) -> Program {
    let mut resolver =
        Resolver { program: Program { sources: vec![source], ..Program::default() }, ..Resolver::default() };
    resolver.declare(tree);
    resolver.bridges(tree, robots, checker);
    resolver.program.alias = alias;
    resolver.link();
    let mut program = resolver.program;
    program.findings = resolver.diagnostics;
    super::blocks::resolve_blocks(&mut program, checker);
    program
}

/// What is still to be linked refers to the tree.
#[derive(Default)]
pub(super) struct Resolver<'t> {
    pub(super) program: Program,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) machines: Vec<(MachineId, &'t ast::Machine)>,
    pub(super) states: Vec<(StateId, &'t ast::State)>,
    pub(super) spawns: Vec<&'t ast::Spawn>,
}

impl<'t> Resolver<'t> {
    fn declare(&mut self, tree: &'t Tree) {
        // Variables first, here as in machines: what is inside may not hide them, wherever they are written.
        for form in &tree.forms {
            if let Form::Var(var) = form {
                self.declare_global(var);
            }
        }
        for form in &tree.forms {
            match form {
                Form::Machine(machine) => {
                    if let Some(id) = self.declare_machine(machine, None) {
                        self.program.tops.push(id);
                    }
                }
                Form::Spawn(spawn) => self.spawns.push(spawn),
                Form::OnPause(block) => self.declare_hook(Hook::Pause, block),
                Form::OnResume(block) => self.declare_hook(Hook::Resume, block),
                Form::Import(import) => self.unsupported(import.span, "import"),
                Form::Export(export) => self.check_export(export, tree),
                Form::Var(_) | Form::Bridge(_) => {}
            }
        }
        if self.spawns.is_empty() && !self.program.tops.is_empty() {
            self.no_spawn();
        }
    }

    fn unsupported(&mut self, span: Span, what: &str) {
        self.diagnostics.push(
            Diagnostic::error(Code::Unsupported, span, format!("`{what}` is not available yet; the form is ignored"))
                .help("copy the machines into this file for now"),
        );
    }

    fn check_export(&mut self, export: &ast::Export, tree: &Tree) {
        let known = tree.forms.iter().filter_map(|form| match form {
            Form::Machine(machine) => Some(&*machine.name.text),
            _ => None,
        });
        let known: Vec<&str> = known.collect();
        if !known.contains(&&*export.machine.text) {
            self.unknown(Code::UnknownMachine, "machine", &export.machine, known);
        }
    }

    fn no_spawn(&mut self) {
        let top = &self.program[self.program.tops[0]];
        let state = top.states.first().map_or("STATE", |&state| &*self.program[state].name);
        let help = format!("add `(spawn {} {state})` at the end of the file", top.name);
        let message = "nothing is spawned, so nothing will run";
        self.diagnostics.push(Diagnostic::warning(Code::NoSpawn, top.name_span, message).help(help));
    }

    fn declare_hook(&mut self, hook: Hook, block: &ast::Block) {
        let id = self.block(block, None, Owner::Program);
        let (slot, name) = match hook {
            Hook::Pause => (&mut self.program.on_pause, "onpause"),
            Hook::Resume => (&mut self.program.on_resume, "onresume"),
        };
        match *slot {
            None => *slot = Some(id),
            Some(first) => {
                let first = self.program[first].span;
                let message = format!("a second `{name}`; only the first one is used");
                self.diagnostics.push(
                    Diagnostic::error(Code::Duplicate, block.span, message)
                        .also(first, "the first one")
                        .help("put both into one block"),
                );
            }
        }
    }

    pub(super) fn block(&mut self, block: &ast::Block, machine: Option<MachineId>, owner: Owner) -> BlockId {
        let id = BlockId(self.program.blocks.len() as u32);
        let code = block.text.clone();
        self.program.blocks.push(Block {
            code,
            span: block.span,
            machine,
            owner,
            uses: Vec::new(),
            missing: Vec::new(),
        });
        id
    }

    /// A block of the transition that is being linked.
    pub(super) fn transition_block(&mut self, block: &ast::Block, machine: MachineId) -> BlockId {
        let owner = Owner::Transition(TransitionId(self.program.transitions.len() as u32));
        self.block(block, Some(machine), owner)
    }

    fn declare_global(&mut self, var: &ast::Var) {
        if let Some(id) = self.declare_var(var, None) {
            self.program.globals.push(id);
        }
    }

    fn declare_var(&mut self, var: &ast::Var, machine: Option<MachineId>) -> Option<VarId> {
        if let Some(first) = Names::of(&self.program).var(machine, &var.name.text) {
            let (what, code) = match self.program[first].machine == machine {
                true => ("declared twice", Code::Duplicate),
                false => ("already a variable of an enclosing scope", Code::Redeclared),
            };
            let message = format!("variable `{}` is {what}; this declaration is ignored", var.name.text);
            let first = self.program[first].name_span;
            self.diagnostics.push(
                Diagnostic::error(code, var.name.span, message)
                    .also(first, "declared here")
                    .help("give one of them another name; names may be reused only in machines beside each other"),
            );
            return None;
        }
        let init = self.block(&var.init, machine, Owner::Var(VarId(self.program.vars.len() as u32)));
        let path = match machine {
            Some(machine) => join(&self.program[machine].path, &var.name.text),
            None => var.name.text.clone(),
        };
        let id = VarId(self.program.vars.len() as u32);
        let name = var.name.text.clone();
        self.program.vars.push(Var { name, path, machine, init, span: var.span, name_span: var.name.span });
        Some(id)
    }

    fn declare_machine(&mut self, machine: &'t ast::Machine, parent: Option<StateId>) -> Option<MachineId> {
        let siblings = match parent {
            Some(state) => &self.program[state].machines,
            None => &self.program.tops,
        };
        let twin = siblings.iter().find(|&&id| self.program[id].name == machine.name.text);
        if let Some(&twin) = twin {
            let first = self.program[twin].name_span;
            self.duplicate("machine", &machine.name, first);
            return None;
        }
        let name = machine.name.text.clone();
        let path = match parent {
            Some(state) => join(&self.program[state].path, &name),
            None => name.clone(),
        };
        let id = MachineId(self.program.machines.len() as u32);
        self.program.machines.push(Machine {
            name,
            path,
            parent,
            vars: Vec::new(),
            events: Vec::new(),
            states: Vec::new(),
            transitions: Vec::new(),
            span: machine.span,
            name_span: machine.name.span,
        });
        self.machines.push((id, machine));
        self.declare_items(id, machine);
        Some(id)
    }

    /// Variables first: a nested machine's may not hide them, wherever they are written.
    fn declare_items(&mut self, id: MachineId, machine: &'t ast::Machine) {
        for item in &machine.items {
            if let MachineItem::Var(var) = item
                && let Some(var) = self.declare_var(var, Some(id))
            {
                self.program.machines[id.index()].vars.push(var);
            }
        }
        for item in &machine.items {
            match item {
                MachineItem::Event(event) => self.declare_event(event, id),
                MachineItem::State(state) => self.declare_state(state, id),
                MachineItem::Var(_) | MachineItem::Transition(_) => {}
            }
        }
    }

    fn declare_event(&mut self, event: &ast::Event, machine: MachineId) {
        let twin = self.program[machine].events.iter().find(|&&id| self.program[id].name == event.name.text);
        if let Some(&twin) = twin {
            let first = self.program[twin].span;
            return self.duplicate("event", &event.name, first);
        }
        let block = self.block(&event.block, Some(machine), Owner::Event(EventId(self.program.events.len() as u32)));
        let path = join(&self.program[machine].path, &event.name.text);
        let id = EventId(self.program.events.len() as u32);
        self.program.events.push(Event { name: event.name.text.clone(), path, machine, block, span: event.span });
        self.program.machines[machine.index()].events.push(id);
    }

    fn declare_state(&mut self, state: &'t ast::State, machine: MachineId) {
        if let Some(twin) = self.program.state_named(machine, &state.name.text) {
            let first = self.program[twin].name_span;
            return self.duplicate("state", &state.name, first);
        }
        let id = StateId(self.program.states.len() as u32);
        self.program.states.push(State {
            name: state.name.text.clone(),
            path: join(&self.program[machine].path, &state.name.text),
            machine,
            onentry: Vec::new(),
            running: Vec::new(),
            onexit: Vec::new(),
            machines: Vec::new(),
            outgoing: Vec::new(),
            exits: Vec::new(),
            breakpoint: None,
            span: state.span,
            name_span: state.name.span,
        });
        self.program.machines[machine.index()].states.push(id);
        self.states.push((id, state));
        for item in &state.items {
            if let StateItem::Machine(nested) = item
                && let Some(nested) = self.declare_machine(nested, Some(id))
            {
                self.program.states[id.index()].machines.push(nested);
            }
        }
    }

    fn duplicate(&mut self, what: &str, name: &ast::Name, first: Span) {
        let message = format!("{what} `{}` is declared twice; this declaration is ignored", name.text);
        self.diagnostics.push(
            Diagnostic::error(Code::Duplicate, name.span, message)
                .also(first, "first declared here")
                .help("rename or remove one of them"),
        );
    }

    fn bridges(&mut self, tree: &Tree, robots: &[Robot], checker: &mut Checker) {
        let mut chosen: HashMap<&str, &str> = robots.iter().map(|robot| (&*robot.name, &*robot.kind)).collect();
        for form in &tree.forms {
            let Form::Bridge(bridge) = form else { continue };
            if let Some(twin) = self.program.bridges.iter().find(|known| known.name == bridge.name.text) {
                let first = twin.span;
                self.duplicate("bridge", &bridge.name, first);
                continue;
            }
            let other = chosen.remove(&*bridge.name.text).filter(|kind| *kind != &*bridge.kind.text);
            let (kind, config) = match other {
                Some(kind) => (kind.into(), serde_json::json!({})),
                None => (bridge.kind.text.clone(), self.config(bridge, checker)),
            };
            self.program.bridges.push(Bridge { name: bridge.name.text.clone(), kind, config, span: bridge.span });
        }
        for robot in robots.iter().filter(|robot| chosen.contains_key(&*robot.name)) {
            let (name, kind) = (robot.name.as_str().into(), robot.kind.as_str().into());
            self.program.bridges.push(Bridge { name, kind, config: serde_json::json!({}), span: Span::default() });
        }
    }

    fn config(&mut self, bridge: &ast::Bridge, checker: &mut Checker) -> serde_json::Value {
        let Some(block) = &bridge.config else { return serde_json::json!({}) };
        checker.config(&block.text).unwrap_or_else(|mut error| {
            // The bracket that Lua sees at the end is not in the text.
            if !block.text.contains('}') {
                error.message = error.message.replace("near '}'", "near ']'");
                error.token = error.token.filter(|token| token != "}");
            }
            let source = &self.program.sources[block.span.file.0 as usize];
            self.diagnostics.push(super::blocks::syntax_diagnostic(source, block.span, &error));
            serde_json::json!({})
        })
    }
}

enum Hook {
    Pause,
    Resume,
}

fn join(path: &str, name: &str) -> Arc<str> {
    format!("{path}/{name}").into()
}
