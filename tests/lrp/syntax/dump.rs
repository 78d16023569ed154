//! A tree printed as a compact s-expression, with the line and column of each form.

use std::fmt::Write;

use lrp::syntax::ast::*;
use lrp::syntax::{Source, Span};

pub fn dump(tree: &Tree, source: &Source) -> String {
    let mut printer = Printer { source, out: String::new(), depth: 0 };
    for form in &tree.forms {
        printer.form(form);
    }
    printer.out
}

struct Printer<'a> {
    source: &'a Source,
    out: String,
    depth: usize,
}

impl Printer<'_> {
    fn line(&mut self, span: Span, text: String) {
        let at = self.source.position(span.start as usize);
        let indent = "  ".repeat(self.depth);
        writeln!(self.out, "{indent}{text}  ; {}:{}", at.line, at.column).unwrap();
    }

    fn form(&mut self, form: &Form) {
        match form {
            Form::Bridge(bridge) => {
                let config = bridge.config.as_ref().map_or("-".to_string(), block);
                self.line(bridge.span, format!("bridge {} {} {config}", bridge.name.text, bridge.kind.text));
            }
            Form::Import(import) => self.line(import.span, format!("import {:?}", import.file.text)),
            Form::Export(export) => self.line(export.span, format!("export {}", export.machine.text)),
            Form::Var(var) => self.var(var),
            Form::Machine(machine) => self.machine(machine),
            Form::Spawn(spawn) => self.line(spawn.span, format!("spawn {}", target(spawn))),
            Form::OnPause(b) => self.line(b.span, format!("onpause {}", block(b))),
            Form::OnResume(b) => self.line(b.span, format!("onresume {}", block(b))),
        }
    }

    fn var(&mut self, var: &Var) {
        self.line(var.span, format!("var {} {}", var.name.text, block(&var.init)));
    }

    fn machine(&mut self, machine: &Machine) {
        self.line(machine.span, format!("machine {}", machine.name.text));
        self.depth += 1;
        for item in &machine.items {
            match item {
                MachineItem::Var(var) => self.var(var),
                MachineItem::Event(event) => {
                    self.line(event.span, format!("event {} {}", event.name.text, block(&event.block)));
                }
                MachineItem::State(state) => self.state(state),
                MachineItem::Transition(transition) => self.transition(transition),
            }
        }
        self.depth -= 1;
    }

    fn state(&mut self, state: &State) {
        self.line(state.span, format!("state {}", state.name.text));
        self.depth += 1;
        for item in &state.items {
            match item {
                StateItem::OnEntry(Entry::Action(b)) => self.line(b.span, format!("onentry {}", block(b))),
                StateItem::OnEntry(Entry::Spawn(spawn)) => {
                    self.line(spawn.span, format!("onentry spawn {}", target(spawn)));
                }
                StateItem::Running(b) => self.line(b.span, format!("running {}", block(b))),
                StateItem::OnExit(b) => self.line(b.span, format!("onexit {}", block(b))),
                StateItem::Break(span) => self.line(*span, "break".into()),
                StateItem::Machine(machine) => self.machine(machine),
            }
        }
        self.depth -= 1;
    }

    fn transition(&mut self, transition: &Transition) {
        let kind = match &transition.kind {
            TransitionKind::On(t) => format!("on {}", trigger(t)),
            TransitionKind::Eps => "eps".to_string(),
            TransitionKind::Ontime(t) => format!("ontime {}", timeout(t)),
            TransitionKind::Exit(t) => format!("exit {}", trigger(t)),
        };
        let name = transition.name.as_ref().map_or(String::new(), |name| format!(" named {}", name.text));
        let (from, to) = (sources(&transition.sources), &transition.target.text);
        self.line(transition.span, format!("{kind}: {from} -> {to}{name}"));
        self.depth += 1;
        for &span in &transition.breaks {
            self.line(span, "break".into());
        }
        self.depth -= 1;
    }
}

fn block(block: &Block) -> String {
    format!("{:?}", block.text)
}

fn target(spawn: &Spawn) -> String {
    format!("{} in {}", spawn.machine.text, spawn.state.text)
}

fn trigger(trigger: &Trigger) -> String {
    match trigger {
        Trigger::Event(name) => name.text.to_string(),
        Trigger::Block(b) => block(b),
    }
}

fn timeout(timeout: &Timeout) -> String {
    match timeout {
        Timeout::Number { ms, .. } => ms.to_string(),
        Timeout::Variable(name) => name.text.to_string(),
        Timeout::Block(b) => block(b),
    }
}

fn sources(sources: &Sources) -> String {
    match sources {
        Sources::One(name) => name.text.to_string(),
        Sources::Any(_) => "*".to_string(),
        Sources::Some(names) => {
            let names: Vec<&str> = names.iter().map(|name| &*name.text).collect();
            format!("({})", names.join(" "))
        }
    }
}
