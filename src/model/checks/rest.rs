//! States that are left as soon as they are entered, in a circle.

use super::guards::{always, tested};
use crate::model::ids::*;
use crate::model::program::*;
use crate::model::suggestion::listed;
use crate::model::transition_names::spelled;
use crate::syntax::{Code, Diagnostic};

/// Circles of transitions that are always taken: each step takes one, and no state in it ever runs. A warning where
/// nothing can end it from within; a hint where an earlier guard may.
pub fn never_rests(program: &Program) -> Vec<Diagnostic> {
    let next: Vec<Option<Hop>> = (0..program.states.len() as u32).map(|state| hop(program, StateId(state))).collect();
    let mut walked: Vec<Option<u32>> = vec![None; next.len()];
    let mut found = Vec::new();
    for start in 0..next.len() as u32 {
        let mut at = StateId(start);
        while walked[at.index()].is_none()
            && let Some(hop) = next[at.index()]
        {
            walked[at.index()] = Some(start);
            at = hop.target;
        }
        // Back on this very walk: a circle that was not met before.
        if walked[at.index()] == Some(start) && next[at.index()].is_some() {
            found.push(circle(program, at, &next));
        }
    }
    found
}

/// The transition that is always taken out of a state, if no other is.
#[derive(Clone, Copy)]
struct Hop {
    transition: TransitionId,
    target: StateId,
    others: Others,
}

#[derive(Clone, Copy, PartialEq)]
enum Others {
    None,
    /// Another guard is tested first.
    Earlier,
}

fn hop(program: &Program, state: StateId) -> Option<Hop> {
    for (nth, transition) in tested(program, state).enumerate() {
        if always(program, &program[transition].trigger) {
            let inside = program[transition].kind != TransitionKind::Exit;
            let others = if nth == 0 { Others::None } else { Others::Earlier };
            return program[transition].target.filter(|_| inside).map(|target| Hop { transition, target, others });
        }
    }
    None
}

fn circle(program: &Program, first: StateId, next: &[Option<Hop>]) -> Diagnostic {
    let hops =
        std::iter::successors(
            next[first.index()],
            |hop| {
                if hop.target == first { None } else { next[hop.target.index()] }
            },
        );
    let hops: Vec<Hop> = hops.collect();
    let states = [first].into_iter().chain(hops[..hops.len() - 1].iter().map(|hop| hop.target));
    let names: Vec<String> = states.map(|state| format!("`{}`", program[state].name)).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let transition = hops[0].transition;
    let (span, spelled) = (program[transition].span, spelled(program, transition));
    let message = match names.as_slice() {
        [name] => format!("{name} never rests: `{spelled}` leaves it and enters it again at each step"),
        _ => format!("{} never rest: each is left in the step after it is entered", listed(&names)),
    };
    let ends = hops.iter().any(|hop| hop.others == Others::Earlier);
    let mut finding = match ends {
        true => Diagnostic::hint(Code::NeverRests, span, message),
        false => Diagnostic::warning(Code::NeverRests, span, message),
    };
    for hop in &hops[1..] {
        finding = finding.also(program[hop.transition].span, "and on");
    }
    finding.help("give one of them a condition or a time, or do what they do in `running`")
}
