//! Timeouts that can't be due.

use crate::lua::Gives;
use crate::model::program::*;
use crate::syntax::{Code, Diagnostic};

/// Timeouts that are no number of milliseconds: a block that gives something else in any case, a variable that nothing
/// gives another value.
pub fn not_milliseconds(program: &Program) -> Vec<Diagnostic> {
    let mut written = vec![false; program.vars.len()];
    for var in program.blocks.iter().flat_map(|block| &block.writes) {
        written[var.index()] = true;
    }
    let help = "a timeout is a number of milliseconds: `500`, `[2 * time]`";
    let wrong = |transition: &Transition| match transition.trigger {
        Trigger::AfterBlock(block) => {
            let kind = no_number(program[block].facts.gives)?;
            let message = format!("a timeout is a number of milliseconds, but this block gives {kind}");
            Some(Diagnostic::error(Code::NotMilliseconds, program[block].span, message).help(help))
        }
        Trigger::AfterVar(var) if !written[var.index()] => {
            let var = &program[var];
            no_number(program[var.init].facts.gives)?;
            let message =
                format!("timeout `{}` is not a number of milliseconds; the transition is not taken", var.name);
            let error = Diagnostic::error(Code::NotMilliseconds, transition.span, message);
            Some(error.also(program[var.init].span, "this is its value").help(help))
        }
        _ => None,
    };
    program.transitions.iter().filter_map(wrong).collect()
}

fn no_number(gives: Gives) -> Option<&'static str> {
    match gives {
        Gives::Something | Gives::Number(_) | Gives::Bits => None,
        _ => Some(gives.name()),
    }
}
