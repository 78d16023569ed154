//! What stands in random programs' blocks and transitions. Some of it fails, or means nothing.

use super::{Choices, Machine};

pub fn name(choices: &mut Choices, scope: &[String]) -> String {
    choices.of(scope).cloned().unwrap_or_else(|| "nothing".into())
}

pub fn expression(choices: &mut Choices, scope: &[String]) -> String {
    let var = name(choices, scope);
    match choices.below(7) {
        0 | 1 => choices.below(5).to_string(),
        2 => format!("({var} or 1) / 3"),
        3 => format!("{var} + 0.1"),
        4 => format!("{{ n = type({var}) }}"),
        5 => "function() return 1 end".into(),
        _ => "nil + 1".into(),
    }
}

pub fn condition(choices: &mut Choices, scope: &[String]) -> String {
    let var = name(choices, scope);
    match choices.below(7) {
        6 => format!("{var} == 'a b'"),
        0 => format!("elapsed() >= {}", 100 * choices.below(6)),
        1 => format!("{var} > 2"),
        2 => format!("type({var}) == 'table'"),
        3 => "robot.light.data > 1".into(),
        4 => "now() % 300 == 0".into(),
        _ => "1".into(),
    }
}

pub fn action(choices: &mut Choices, scope: &[String]) -> String {
    let var = name(choices, scope);
    match choices.below(6) {
        0 => format!("{var} = ({var} or 0) + 1"),
        1 => format!("{var} = {}", expression(choices, scope)),
        2 => format!("{var}.n = now()"),
        3 => format!("log.info({var})"),
        4 => "robot.move{ linear = { x = 0.1 } }".into(),
        _ => "error 'oh'".into(),
    }
}

pub fn transition(choices: &mut Choices, machine: &Machine, scope: &[String]) -> String {
    let state = |choices: &mut Choices| choices.of(&machine.states).map_or("gone".into(), |state| state.name.clone());
    let (from, to) = (state(choices), state(choices));
    let from = match choices.below(6) {
        0 => "*".into(),
        1 => format!("({from} {})", state(choices)),
        _ => from,
    };
    match choices.below(6) {
        0 => format!("(eps {from} -> {to})"),
        1 => format!("(ontime {} {from} -> {to})", 100 * choices.below(5)),
        2 => format!("(ontime {} {from} -> {to})", name(choices, scope)),
        3 => format!("(ontime [{}] {from} -> {to})", expression(choices, scope)),
        4 => format!("(on [{}] {from} -> {to})", condition(choices, scope)),
        _ => format!("(on {} {from} -> {to})", event(choices, machine)),
    }
}

/// Out of a machine, to a state of the one around it.
pub fn exit(choices: &mut Choices, machine: &Machine, scope: &[String], to: &str) -> String {
    match choices.below(2) {
        0 => format!("(exit [{}] * -> {to})", condition(choices, scope)),
        _ => format!("(exit {} * -> {to})", event(choices, machine)),
    }
}

fn event<'m>(choices: &mut Choices, machine: &'m Machine) -> &'m str {
    choices.of(&machine.events).map_or("missing", |event| &event.name)
}
