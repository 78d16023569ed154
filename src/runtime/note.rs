//! What happened, as the engine jots it down while it runs: ids only, so that the hot path neither allocates nor
//! looks names up. Turned into records when the step is over.

use std::sync::Arc;

use super::command::Command;
use super::record::{Taken, What};
use crate::model::*;

pub enum Note {
    Spawn {
        machine: MachineId,
        by: Option<StateId>,
    },
    Enter(StateId),
    Exit(StateId),
    Discard(MachineId),
    Transition {
        transition: TransitionId,
        from: StateId,
        via: Option<StateId>,
    },
    /// What is rare enough to be spelled out at once.
    Rare(Box<What>),
}

impl Note {
    /// Whether after this an edit may do something else than before.
    pub fn may_change_a_verdict(&self) -> bool {
        match self {
            Note::Spawn { .. } | Note::Enter(_) | Note::Discard(_) => true,
            Note::Exit(_) | Note::Transition { .. } => false,
            Note::Rare(what) => {
                matches!(**what, What::Restart { .. } | What::Command { command: Command::OnEdit { .. } })
            }
        }
    }

    pub fn spell_out(self, program: &Program) -> What {
        match self {
            Note::Spawn { machine, by } => {
                What::Spawn { machine: program[machine].path.clone(), by: by.map(|state| program[state].path.clone()) }
            }
            Note::Enter(state) => What::Enter { state: program[state].path.clone() },
            Note::Exit(state) => What::Exit { state: program[state].path.clone() },
            Note::Discard(machine) => What::Discard { machine: program[machine].path.clone() },
            Note::Transition { transition, from, via } => What::Transition(taken(program, transition, from, via)),
            Note::Rare(what) => *what,
        }
    }
}

fn taken(program: &Program, id: TransitionId, from: StateId, via: Option<StateId>) -> Taken {
    let transition = &program[id];
    let to = transition.target.unwrap_or(from);
    Taken {
        machine: program[program[from].machine].path.clone(),
        from: program[from].name.clone(),
        to: program[to].name.clone(),
        name: transition.name.clone(),
        trigger: trigger(program, transition),
        via: via.map(|state| program[state].path.clone()),
        index: position(program, transition.machine, id),
    }
}

fn trigger(program: &Program, transition: &Transition) -> Arc<str> {
    match &transition.trigger {
        Trigger::Event(event) => program[*event].name.clone(),
        Trigger::UnknownEvent(name) => name.clone(),
        Trigger::Always => "eps".into(),
        Trigger::Block(_) => "block".into(),
        Trigger::After(_) | Trigger::AfterVar(_) | Trigger::AfterUnknown(_) | Trigger::AfterBlock(_) => "ontime".into(),
    }
}

fn position(program: &Program, machine: MachineId, id: TransitionId) -> u32 {
    program[machine].transitions.iter().position(|&transition| transition == id).unwrap_or(0) as u32
}
