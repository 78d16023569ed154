//! From tree to program: declares every element, then looks every name up from the innermost scope outwards.
//! What can't be found is reported and left unresolved; the rest of the program stays usable.

use std::collections::HashMap;
use std::sync::Arc;

use super::blocks::syntax_diagnostic;
use super::element::Alias;
use super::files::{File, precedence};
use super::ids::*;
use super::names::Names;
use super::program::*;
use crate::lua::Checker;
use crate::syntax::ast::{self, Form, MachineItem, StateItem, Tree};
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

/// A robot chosen on the command line; it takes the place of the program's own bridge of that name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Robot {
    pub name: String,
    pub kind: String,
}

/// A program of one file.
pub fn resolve(tree: &Tree, source: Source, robots: &[Robot], checker: &mut Checker) -> Program {
    let file = File { source, tree, imports: Vec::new(), qualifier: String::new() };
    resolve_files(&[file], robots, checker, None)
}

/// `files` by `FileId`: the program itself is the first. With `alias`, one element of the program that comes of it can be
/// found by another name as well.
pub fn resolve_files(files: &[File], robots: &[Robot], checker: &mut Checker, alias: Option<Alias>) -> Program {
    let order = precedence(files);
    let mut resolver = Resolver { files, alias, ..Resolver::default() };
    resolver.program.sources = files.iter().map(|file| file.source.clone()).collect();
    resolver.program.spawnable = vec![Vec::new(); files.len()];
    resolver.declare(&order);
    resolver.program.alias = resolver.alias.clone();
    resolver.share_machines();
    resolver.bridges(&order, robots, checker);
    resolver.link();
    let mut program = resolver.program;
    program.findings = resolver.diagnostics;
    super::blocks::resolve_blocks(&mut program, checker);
    for block in resolver.ignored {
        if let Err(error) = checker.check(&block.text) {
            let mistake = syntax_diagnostic(program.source(block.span), block.span, &error);
            program.findings.push(mistake);
        }
    }
    if files.len() > 1 {
        program.globals = super::globals::initialisation_order(&program, &order);
    }
    program
}

/// What is still to be linked refers to the tree.
#[derive(Default)]
pub(super) struct Resolver<'t> {
    pub(super) files: &'t [File<'t>],
    /// The program's only once all is declared: an id of it means nothing before.
    pub(super) alias: Option<Alias>,
    pub(super) program: Program,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) machines: Vec<(MachineId, &'t ast::Machine)>,
    pub(super) states: Vec<(StateId, &'t ast::State)>,
    named_states: HashMap<(MachineId, Arc<str>), StateId>,
    pub(super) spawns: Vec<&'t ast::Spawn>,
    /// Blocks of imported files that don't count: they have to be Lua nevertheless.
    pub(super) ignored: Vec<&'t ast::Block>,
}

impl<'t> Resolver<'t> {
    fn declare(&mut self, order: &[FileId]) {
        // Variables first, here as in machines: what is inside may not hide them, wherever they are written.
        for &file in order {
            self.declare_globals(file);
        }
        for &file in order {
            self.declare_forms(file);
        }
    }

    /// What an imported file spawns and does at a pause counts only when it is run by itself.
    fn declare_forms(&mut self, file: FileId) {
        let is_program = file == FileId(0);
        for form in &self.files[file.0 as usize].tree.forms {
            match form {
                Form::Machine(machine) => {
                    if let Some(id) = self.declare_machine(machine, None) {
                        self.program.tops.push(id);
                        self.program.spawnable[file.0 as usize].push(id);
                    }
                }
                Form::Spawn(spawn) if is_program => self.spawns.push(spawn),
                Form::OnPause(block) if is_program => self.declare_hook(Hook::Pause, block),
                Form::OnResume(block) if is_program => self.declare_hook(Hook::Resume, block),
                Form::OnPause(block) | Form::OnResume(block) => self.ignored.push(block),
                _ => {}
            }
        }
    }

    /// Says so where machines are at hand and none is spawned, here or by those who import the program.
    pub(super) fn check_spawns(&mut self) {
        let spawned = !self.spawns.is_empty() || self.files[0].exports().next().is_some();
        let Some(&top) = self.program.spawnable[0].first().filter(|_| !spawned) else { return };
        let top = &self.program[top];
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
            reads: Vec::new(),
            writes: Vec::new(),
            missing: Vec::new(),
            facts: Arc::default(),
            precompiled: None,
            requires: Vec::new(),
        });
        id
    }

    /// A block of the transition that is being linked.
    pub(super) fn transition_block(&mut self, block: &ast::Block, machine: MachineId) -> BlockId {
        let owner = Owner::Transition(TransitionId(self.program.transitions.len() as u32));
        self.block(block, Some(machine), owner)
    }

    pub(super) fn declare_var(&mut self, var: &ast::Var, machine: Option<MachineId>) -> Option<VarId> {
        if let Some(first) = Names::of(&self.program).var(machine, &var.name.text) {
            let first = &self.program[first];
            let (first, code) = match first.machine == machine {
                true => (first.name_span, Code::Duplicate),
                false => (first.name_span, Code::Redeclared),
            };
            self.redeclared(code, var, first);
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

    pub(super) fn redeclared(&mut self, code: Code, var: &ast::Var, first: Span) {
        let what = match code {
            Code::Duplicate => "declared twice",
            _ => "already a variable of an enclosing scope",
        };
        let message = format!("variable `{}` is {what}; this declaration is ignored", var.name.text);
        self.diagnostics.push(
            Diagnostic::error(code, var.name.span, message)
                .also(first, "declared here")
                .help("give one of them another name; names may be reused only in machines beside each other"),
        );
    }

    fn declare_machine(&mut self, machine: &'t ast::Machine, parent: Option<StateId>) -> Option<MachineId> {
        let siblings = match parent {
            Some(state) => &self.program[state].machines,
            None => &self.program.spawnable[machine.span.file.0 as usize],
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
            None => self.top_path(machine),
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
        self.program.events.push(Event {
            name: event.name.text.clone(),
            path,
            machine,
            block,
            span: event.span,
            name_span: event.name.span,
        });
        self.program.machines[machine.index()].events.push(id);
    }

    fn declare_state(&mut self, state: &'t ast::State, machine: MachineId) {
        let id = StateId(self.program.states.len() as u32);
        let twin = *self.named_states.entry((machine, state.name.text.clone())).or_insert(id);
        if twin != id {
            let first = self.program[twin].name_span;
            return self.duplicate("state", &state.name, first);
        }
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

    pub(super) fn state_named(&self, machine: MachineId, name: &Arc<str>) -> Option<StateId> {
        self.named_states.get(&(machine, name.clone())).copied()
    }

    pub(super) fn duplicate(&mut self, what: &str, name: &ast::Name, first: Span) {
        let message = format!("{what} `{}` is declared twice; this declaration is ignored", name.text);
        self.diagnostics.push(
            Diagnostic::error(Code::Duplicate, name.span, message)
                .also(first, "first declared here")
                .help("rename or remove one of them"),
        );
    }
}

enum Hook {
    Pause,
    Resume,
}

fn join(path: &str, name: &str) -> Arc<str> {
    format!("{path}/{name}").into()
}
