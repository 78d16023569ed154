//! Wildcards that leave their own target.

use super::guards::{always, condition};
use crate::lua::FieldKind;
use crate::model::ids::*;
use crate::model::program::*;
use crate::model::suggestion::listed;
use crate::syntax::{Code, Diagnostic};

/// A `*` on an event that goes on holding leaves its target and enters it again at each step. Not told where entering
/// the target may end the event, or another transition out of it comes first.
pub fn reenters_itself(program: &Program) -> Vec<Diagnostic> {
    let all = (0..program.transitions.len() as u32).map(TransitionId);
    all.filter_map(|id| reenters(program, id)).collect()
}

fn reenters(program: &Program, id: TransitionId) -> Option<Diagnostic> {
    let transition = &program[id];
    if transition.sources != Sources::Any || transition.kind != TransitionKind::On {
        return None;
    }
    let target = transition.target?;
    let guard = condition(program, &transition.trigger)?;
    let states = &program[transition.machine].states;
    let leaves_at_once = always(program, &transition.trigger);
    if states.len() < 2 || leaves_at_once || left_before(program, target, id) || may_end(program, guard, target) {
        return None;
    }
    let holds = match transition.trigger {
        Trigger::Event(event) => format!("`{}` holds", program[event].name),
        _ => "its condition holds".to_string(),
    };
    let name = &program[target].name;
    let message = format!("while {holds}, `*` leaves `{name}` and enters it again at each step");
    let others: Vec<&str> = states.iter().filter(|&&it| it != target).map(|&it| &*program[it].name).collect();
    let help = match others.as_slice() {
        [other] => format!("name the state it is to leave: `{other}`"),
        others => format!("name the states it is to leave: `({})`", listed(others).replace(", ", " ")),
    };
    Some(Diagnostic::hint(Code::ReentersItself, transition.span, message).help(help))
}

/// Whether another transition out of the target is taken when this one could be.
fn left_before(program: &Program, target: StateId, wildcard: TransitionId) -> bool {
    let trigger = &program[wildcard].trigger;
    let same = |other: &Trigger| matches!((trigger, other), (Trigger::Event(a), Trigger::Event(b)) if a == b);
    let earlier = program[target].outgoing.iter().take_while(|&&id| id != wildcard);
    earlier.map(|&id| &program[id].trigger).any(|other| always(program, other) || same(other))
}

/// Whether a guard that held may not do so once a state was left and entered: it looks at a clock or at what its actions
/// touch.
fn may_end(program: &Program, guard: BlockId, target: StateId) -> bool {
    let guard = &program[guard];
    let looks_at = |name: &str| guard.facts.reads.iter().any(|read| read.name == name);
    if ["elapsed", "now", "require"].into_iter().any(looks_at) {
        return true;
    }
    let mut actions = program[target].onexit.clone();
    entry_actions(program, target, &mut Vec::new(), &mut actions);
    actions.into_iter().any(|action| {
        let action = &program[action];
        let forgets = action.facts.fields.iter().any(|used| used.kind == FieldKind::Write && looks_at(&used.name));
        forgets || action.uses.iter().any(|var| guard.uses.contains(var))
    })
}

/// The actions of entering a state, those of the machines it spawns included.
fn entry_actions(program: &Program, state: StateId, met: &mut Vec<StateId>, actions: &mut Vec<BlockId>) {
    if met.contains(&state) {
        return;
    }
    met.push(state);
    for item in &program[state].onentry {
        match item {
            Entry::Action(block) => actions.push(*block),
            Entry::Spawn(spawn) => {
                if let Some((_, start)) = spawn.target {
                    entry_actions(program, start, met, actions);
                }
            }
        }
    }
}
