//! Every span of a tree, each with the span of the form it stands in.

use lrp::syntax::Span;
use lrp::syntax::ast::*;

/// (outer, inner) pairs; the outermost forms come with `whole`.
pub fn pairs(tree: &Tree, whole: Span) -> Vec<(Span, Span)> {
    let mut walk = Walk { pairs: Vec::new() };
    for form in &tree.forms {
        walk.form(whole, form);
    }
    walk.pairs
}

struct Walk {
    pairs: Vec<(Span, Span)>,
}

impl Walk {
    fn all(&mut self, outer: Span, inner: &[Span]) {
        self.pairs.extend(inner.iter().map(|&inner| (outer, inner)));
    }

    fn form(&mut self, whole: Span, form: &Form) {
        match form {
            Form::Bridge(bridge) => {
                self.all(whole, &[bridge.span]);
                self.all(bridge.span, &[bridge.name.span, bridge.kind.span]);
                self.all(bridge.span, &bridge.config.iter().map(|block| block.span).collect::<Vec<_>>());
            }
            Form::Import(import) => self.all(whole, &[import.span, import.file.span]),
            Form::Export(export) => self.all(whole, &[export.span, export.machine.span]),
            Form::Var(var) => self.var(whole, var),
            Form::Machine(machine) => self.machine(whole, machine),
            Form::Spawn(spawn) => self.spawn(whole, spawn),
            Form::OnPause(block) | Form::OnResume(block) => self.all(whole, &[block.span]),
        }
    }

    fn var(&mut self, outer: Span, var: &Var) {
        self.all(outer, &[var.span]);
        self.all(var.span, &[var.name.span, var.init.span]);
    }

    fn spawn(&mut self, outer: Span, spawn: &Spawn) {
        self.all(outer, &[spawn.span]);
        self.all(spawn.span, &[spawn.machine.span, spawn.state.span]);
    }

    fn machine(&mut self, outer: Span, machine: &Machine) {
        self.all(outer, &[machine.span]);
        self.all(machine.span, &[machine.name.span]);
        for item in &machine.items {
            match item {
                MachineItem::Var(var) => self.var(machine.span, var),
                MachineItem::Event(event) => {
                    self.all(machine.span, &[event.span]);
                    self.all(event.span, &[event.name.span, event.block.span]);
                }
                MachineItem::State(state) => self.state(machine.span, state),
                MachineItem::Transition(transition) => self.transition(machine.span, transition),
            }
        }
    }

    fn state(&mut self, outer: Span, state: &State) {
        self.all(outer, &[state.span]);
        self.all(state.span, &[state.name.span]);
        for item in &state.items {
            match item {
                StateItem::OnEntry(Entry::Spawn(spawn)) => self.spawn(state.span, spawn),
                StateItem::OnEntry(Entry::Action(block)) | StateItem::Running(block) | StateItem::OnExit(block) => {
                    self.all(state.span, &[block.span]);
                }
                StateItem::Break(span) => self.all(state.span, &[*span]),
                StateItem::Machine(machine) => self.machine(state.span, machine),
            }
        }
    }

    fn transition(&mut self, outer: Span, transition: &Transition) {
        let span = transition.span;
        self.all(outer, &[span]);
        self.all(span, &[transition.target.span]);
        self.all(span, &transition.breaks);
        self.all(span, &transition.name.iter().map(|name| name.span).collect::<Vec<_>>());
        match &transition.kind {
            TransitionKind::On(Trigger::Event(name)) | TransitionKind::Exit(Trigger::Event(name)) => {
                self.all(span, &[name.span]);
            }
            TransitionKind::On(Trigger::Block(block)) | TransitionKind::Exit(Trigger::Block(block)) => {
                self.all(span, &[block.span]);
            }
            TransitionKind::Eps => {}
            TransitionKind::Ontime(Timeout::Number { span: number, .. }) => self.all(span, &[*number]),
            TransitionKind::Ontime(Timeout::Variable(name)) => self.all(span, &[name.span]),
            TransitionKind::Ontime(Timeout::Block(block)) => self.all(span, &[block.span]),
        }
        match &transition.sources {
            Sources::One(name) => self.all(span, &[name.span]),
            Sources::Any(star) => self.all(span, &[*star]),
            Sources::Some(names) => self.all(span, &names.iter().map(|name| name.span).collect::<Vec<_>>()),
        }
    }
}
