//! Events and variables that nothing asks for.

use crate::model::program::*;
use crate::syntax::{Code, Diagnostic};

/// Events that no transition waits for.
pub fn unused_event(program: &Program) -> Vec<Diagnostic> {
    let mut used = vec![false; program.events.len()];
    for transition in &program.transitions {
        if let Trigger::Event(event) = transition.trigger {
            used[event.index()] = true;
        }
    }
    let unused = program.events.iter().zip(used).filter(|(_, used)| !used);
    let found = unused.map(|(event, _)| {
        let message = format!("event `{}` is never used", event.name);
        let help = format!("use it in a transition, `(on {} STATE -> STATE)`, or remove it", event.name);
        Diagnostic::hint(Code::UnusedEvent, event.name_span, message).help(help)
    });
    found.collect()
}

/// Variables that no block and no timeout reads.
pub fn unused_variable(program: &Program) -> Vec<Diagnostic> {
    let mut read = vec![false; program.vars.len()];
    let mut written = vec![None; program.vars.len()];
    for block in &program.blocks {
        block.reads.iter().for_each(|var| read[var.index()] = true);
        block.writes.iter().for_each(|var| written[var.index()] = Some(block.span));
    }
    for transition in &program.transitions {
        if let Trigger::AfterVar(var) = transition.trigger {
            read[var.index()] = true;
        }
    }
    let unused = program.vars.iter().zip(read).zip(written).filter(|((_, read), _)| !read);
    let found = unused.map(|((var, _), written)| {
        let name = &var.name;
        let hint = |message| Diagnostic::hint(Code::UnusedVariable, var.name_span, message);
        match written {
            None => hint(format!("variable `{name}` is never used")).help("use it in a block, or remove it"),
            Some(block) => hint(format!("variable `{name}` is assigned, but never read"))
                .also(block, "assigned here")
                .help(format!(
                    "read it somewhere, or write `; lrp: allow {}` before it if it is there to be watched",
                    { Code::UnusedVariable.name() }
                )),
        }
    });
    found.collect()
}
