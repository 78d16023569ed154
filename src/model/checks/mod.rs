//! What is most likely a mistake in a program that can run: one rule a function, each a pure function of the resolved
//! program, in time about proportional to its size. Knows nothing of how findings are shown.

mod allow;
mod crowd;
mod events;
mod fields;
mod guards;
mod reach;
mod rest;
mod shadow;
mod spawns;
mod timeouts;
mod unused;
mod wildcard;

use super::Description;
use super::program::Program;
use crate::lua::Checker;
use crate::syntax::Diagnostic;

use allow::Allowed;

/// Adds what the rules find to the program's findings, and leaves out what its comments allow. `offered`: what each of
/// its bridges offers, where that is known; `checker`: that of its blocks.
pub fn check(program: &mut Program, offered: &[Option<Description>], checker: &Checker) {
    let mut allowed = Allowed::of(&program.sources[..program.spawnable.len()]);
    program.findings.retain(|finding| !allowed.covers(finding));
    let mut found = found_anywhere(program, offered, checker);
    // Where a name is misspelt or missing, what it should have named only looks unused.
    let whole = !program.findings.iter().any(Diagnostic::is_error);
    if whole {
        found.extend(found_in_whole(program));
    }
    found.retain(|finding| !allowed.covers(finding));
    program.findings.extend(crowd::thinned(found));
    program.findings.extend(allowed.unknown());
    if whole {
        program.findings.extend(allowed.unused());
    }
}

fn found_anywhere(program: &Program, offered: &[Option<Description>], checker: &Checker) -> Vec<Diagnostic> {
    let mut found = fields::unknown_field(program, offered, checker);
    found.extend(events::not_boolean(program));
    found.extend(events::event_assigns(program));
    found.extend(events::smalltalk(program));
    found.extend(timeouts::not_milliseconds(program));
    found.extend(spawns::already_running(program));
    found
}

/// What only a program without missing names can tell.
fn found_in_whole(program: &Program) -> Vec<Diagnostic> {
    let mut found = spawns::never_spawned(program);
    found.extend(reach::unreachable_state(program));
    found.extend(shadow::shadowed_transition(program));
    found.extend(rest::never_rests(program));
    found.extend(wildcard::reenters_itself(program));
    found.extend(unused::unused_event(program));
    found.extend(unused::unused_variable(program));
    found
}
