//! The second half of resolving: transitions, spawns and blocks of declared elements, with the names in them looked up.

use std::sync::Arc;

use super::element::Kind;
use super::ids::*;
use super::names::Names;
use super::program::*;
use super::resolve::Resolver;
use super::suggestion::suggestion;
use crate::syntax::ast::{self, MachineItem, StateItem};
use crate::syntax::{Code, Diagnostic, Span};

impl Resolver<'_> {
    pub(super) fn link(&mut self) {
        for (machine, tree) in std::mem::take(&mut self.machines) {
            for item in &tree.items {
                if let MachineItem::Transition(transition) = item {
                    self.link_transition(transition, machine);
                }
            }
        }
        for (state, tree) in std::mem::take(&mut self.states) {
            self.link_state(state, tree);
        }
        for spawn in std::mem::take(&mut self.spawns) {
            let spawn = self.link_spawn(spawn, None);
            self.program.spawns.push(spawn);
        }
    }

    fn link_state(&mut self, id: StateId, tree: &ast::State) {
        let machine = Some(self.program[id].machine);
        let breaks = tree.items.iter().filter_map(|item| match item {
            StateItem::Break(span) => Some(*span),
            _ => None,
        });
        self.program.states[id.index()].breakpoint = self.first_break(breaks);
        for item in &tree.items {
            match item {
                StateItem::OnEntry(ast::Entry::Action(block)) => {
                    let block = self.block(block, machine, Owner::State(id));
                    self.program.states[id.index()].onentry.push(Entry::Action(block));
                }
                StateItem::OnEntry(ast::Entry::Spawn(spawn)) => {
                    let spawn = self.link_spawn(spawn, Some(id));
                    self.program.states[id.index()].onentry.push(Entry::Spawn(spawn));
                }
                StateItem::Running(block) => {
                    let block = self.block(block, machine, Owner::State(id));
                    self.program.states[id.index()].running.push(block);
                }
                StateItem::OnExit(block) => {
                    let block = self.block(block, machine, Owner::State(id));
                    self.program.states[id.index()].onexit.push(block);
                }
                StateItem::Break(_) | StateItem::Machine(_) => {}
            }
        }
    }

    /// One `(break)` in a place is enough.
    fn first_break(&mut self, mut breaks: impl Iterator<Item = Span>) -> Option<Span> {
        let first = breaks.next()?;
        for span in breaks {
            self.diagnostics.push(
                Diagnostic::error(Code::Duplicate, span, "a second `break` here; one is enough")
                    .also(first, "the first one")
                    .help("remove one of them"),
            );
        }
        Some(first)
    }

    fn link_spawn(&mut self, spawn: &ast::Spawn, by: Option<StateId>) -> Spawn {
        let machine = Names::of(&self.program).machine(by, &spawn.machine.text);
        let target = machine.and_then(|machine| self.find_state(machine, &spawn.state).map(|state| (machine, state)));
        if !self.program.is_called(machine, &spawn.machine.text) {
            self.unknown_machine(spawn, by);
        }
        Spawn {
            machine_name: spawn.machine.text.clone(),
            state_name: spawn.state.text.clone(),
            machine,
            target,
            span: spawn.span,
        }
    }

    fn link_transition(&mut self, tree: &ast::Transition, machine: MachineId) {
        let sources = self.link_sources(&tree.sources, machine);
        let (kind, trigger) = match &tree.kind {
            ast::TransitionKind::On(trigger) => (TransitionKind::On, self.link_trigger(trigger, machine)),
            ast::TransitionKind::Exit(trigger) => (TransitionKind::Exit, self.link_trigger(trigger, machine)),
            ast::TransitionKind::Eps => (TransitionKind::Eps, Trigger::Always),
            ast::TransitionKind::Ontime(timeout) => (TransitionKind::Ontime, self.link_timeout(timeout, machine)),
        };
        let target = self.link_target(tree, kind, machine);
        let id = TransitionId(self.program.transitions.len() as u32);
        let transition = Transition {
            machine,
            kind,
            sources,
            target_name: tree.target.text.clone(),
            target,
            name: tree.name.as_ref().map(|name| name.text.clone()),
            trigger,
            breakpoint: self.first_break(tree.breaks.iter().copied()),
            span: tree.span,
        };
        self.attach(id, &transition);
        self.program.transitions.push(transition);
    }

    fn link_target(&mut self, tree: &ast::Transition, kind: TransitionKind, machine: MachineId) -> Option<StateId> {
        let owner = match kind {
            TransitionKind::Exit => match self.program.enclosing(machine) {
                Some(parent) => parent,
                None => {
                    let name = &self.program[machine].name;
                    let message = format!("`exit` leaves a nested machine, but `{name}` is not nested in a state");
                    self.diagnostics.push(
                        Diagnostic::error(Code::ExitAtTop, tree.span, message)
                            .help("use `on` to go to a state of the same machine"),
                    );
                    return None;
                }
            },
            _ => machine,
        };
        let target = self.find_state(owner, &tree.target);
        if target.is_none() && kind == TransitionKind::Exit && self.state_named(machine, &tree.target.text).is_some() {
            self.help_last(format!(
                "an exit goes to a state of `{}`; `on` goes to one of `{}`",
                self.name(owner),
                self.name(machine)
            ));
        }
        target
    }

    fn name(&self, machine: MachineId) -> &str {
        &self.program[machine].name
    }

    fn help_last(&mut self, help: String) {
        if let Some(last) = self.diagnostics.last_mut() {
            last.help = Some(help);
        }
    }

    fn unknown_machine(&mut self, spawn: &ast::Spawn, by: Option<StateId>) {
        let elsewhere = self.program.machines.iter().find(|machine| machine.name == spawn.machine.text).cloned();
        let Some(elsewhere) = elsewhere else {
            let known = Names::of(&self.program).machines(by);
            return self.unknown(Code::UnknownMachine, "machine", &spawn.machine, known.iter().map(|name| &**name));
        };
        if elsewhere.parent.is_none() {
            return self.not_imported(spawn, &elsewhere);
        }
        let message = format!("machine `{}` can't be spawned here: it is written in another state", spawn.machine.text);
        let help = "a spawn may name the machines of its own state, of the states around it, and those at top level";
        let diagnostic = Diagnostic::error(Code::UnknownMachine, spawn.machine.span, message);
        self.diagnostics.push(diagnostic.also(elsewhere.name_span, "written here").help(help));
    }

    /// A machine at top level of another file.
    fn not_imported(&mut self, spawn: &ast::Spawn, machine: &Machine) {
        let (name, file) = (&machine.name, &self.program.source(machine.span).name);
        let exported = self.files[machine.span.file.0 as usize].exports().any(|export| export.text == *name);
        let (why, help) = match exported {
            true => (format!("this file doesn't import `{file}`"), format!("import `{file}` in this file as well")),
            false => (format!("`{file}` doesn't export it"), format!("add `(export {name})` to `{file}`")),
        };
        let message = format!("machine `{name}` can't be spawned here: {why}");
        let diagnostic = Diagnostic::error(Code::UnknownMachine, spawn.machine.span, message);
        self.diagnostics.push(diagnostic.also(machine.name_span, "written here").help(help));
    }

    /// Where a transition can be taken, it joins the lists that a step walks.
    fn attach(&mut self, id: TransitionId, transition: &Transition) {
        let machine = transition.machine;
        self.program.machines[machine.index()].transitions.push(id);
        let inert = matches!(transition.trigger, Trigger::UnknownEvent(_) | Trigger::AfterUnknown(_));
        if transition.target.is_none() || inert {
            return;
        }
        if transition.kind == TransitionKind::Exit {
            if let Some(parent) = self.program[machine].parent {
                self.program.states[parent.index()].exits.push(id);
            }
            return;
        }
        let states = match &transition.sources {
            Sources::Any => &self.program.machines[machine.index()].states,
            Sources::These { states, .. } => states,
        };
        for state in states {
            let outgoing = &mut self.program.states[state.index()].outgoing;
            // A state may be named twice among the sources.
            if outgoing.last() != Some(&id) {
                outgoing.push(id);
            }
        }
    }

    fn link_sources(&mut self, sources: &ast::Sources, machine: MachineId) -> Sources {
        let names: &[ast::Name] = match sources {
            ast::Sources::Any(_) => return Sources::Any,
            ast::Sources::One(name) => std::slice::from_ref(name),
            ast::Sources::Some(names) => names,
        };
        let states = names.iter().filter_map(|name| self.find_state(machine, name)).collect();
        Sources::These { names: names.iter().map(|name| name.text.clone()).collect(), states }
    }

    fn link_trigger(&mut self, trigger: &ast::Trigger, machine: MachineId) -> Trigger {
        match trigger {
            ast::Trigger::Block(block) => Trigger::Block(self.transition_block(block, machine)),
            ast::Trigger::Event(name) => {
                let event = Names::of(&self.program).event(machine, &name.text);
                if !self.program.is_called(event, &name.text) {
                    let known = Names::of(&self.program).events(machine);
                    self.unknown(Code::UnknownEvent, "event", name, known.iter().map(|name| &**name));
                }
                event.map_or_else(|| Trigger::UnknownEvent(name.text.clone()), Trigger::Event)
            }
        }
    }

    fn link_timeout(&mut self, timeout: &ast::Timeout, machine: MachineId) -> Trigger {
        match timeout {
            ast::Timeout::Number { ms, .. } => Trigger::After(*ms),
            ast::Timeout::Block(block) => Trigger::AfterBlock(self.transition_block(block, machine)),
            ast::Timeout::Variable(name) => {
                let var = Names::of(&self.program).var(Some(machine), &name.text);
                if !self.program.is_called(var, &name.text) {
                    let known = Names::of(&self.program).vars(Some(machine));
                    self.unknown(Code::UnknownVariable, "variable", name, known.iter().map(|name| &**name));
                }
                var.map_or_else(|| Trigger::AfterUnknown(name.text.clone()), Trigger::AfterVar)
            }
        }
    }

    /// A state of a machine; where none is called so, that is said.
    fn find_state(&mut self, machine: MachineId, name: &ast::Name) -> Option<StateId> {
        let renamed = || self.program.alias(Kind::State, &name.text).map(|alias| StateId(alias.index));
        let state = self
            .state_named(machine, &name.text)
            .or_else(|| renamed().filter(|&state| self.program[state].machine == machine));
        if !self.program.is_called(state, &name.text) {
            self.unknown_state(machine, name);
        }
        state
    }

    fn unknown_state(&mut self, machine: MachineId, name: &ast::Name) {
        let known: Vec<Arc<str>> =
            self.program[machine].states.iter().map(|&state| self.program[state].name.clone()).collect();
        let what = format!("state of machine `{}`", self.program[machine].name);
        self.unknown(Code::UnknownState, &what, name, known.iter().map(|name| &**name));
    }

    pub(super) fn unknown<'a>(
        &mut self,
        code: Code,
        what: &str,
        name: &ast::Name,
        known: impl IntoIterator<Item = &'a str>,
    ) {
        let alias = Kind::missing(code).and_then(|kind| self.program.alias(kind, &name.text));
        let (message, help) = match alias {
            Some(renamed) => renamed_words(&name.text, self.program.name(renamed)),
            None => {
                let known: Vec<&str> = known.into_iter().collect();
                let article = if what.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
                (format!("`{}` is not {article} {what}", name.text), suggestion(&name.text, &known))
            }
        };
        self.diagnostics.push(Diagnostic::error(code, name.span, message).help(help));
    }
}

/// What is wrong with a name whose element has another one now, and what to do about it.
pub(super) fn renamed_words(old: &str, new: &str) -> (String, String) {
    (format!("`{old}` is called `{new}` now"), format!("rename it here too; until then `{old}` goes on meaning it"))
}
