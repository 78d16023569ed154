//! What a program pauses for, and the pause at the end of the step in which it was met.

use std::sync::Arc;

use super::command::OnError;
use super::engine::Engine;
use super::record::{Fault, What};
use crate::model::breakpoints::{Spot, SpotNames};
use crate::model::*;
use crate::syntax::{Code, Span};

/// Something was met for which the program is to pause.
pub(super) enum Met {
    State(StateId),
    Transition { transition: TransitionId, target: StateId },
    Condition { code: Arc<str>, machine: Option<MachineId> },
    Fault { message: String, state: Arc<str> },
}

impl Engine {
    /// Whether it has paused of itself since records were last taken: then what was sent before that is to wait.
    pub fn has_paused(&self) -> bool {
        self.breakpoints.paused
    }

    #[cold]
    pub(super) fn meet_state(&mut self, state: StateId) {
        if self.breakpoints.are_at(Spot::State(state)) {
            self.breakpoints.met.push(Met::State(state));
        }
    }

    #[cold]
    pub(super) fn meet_transition(&mut self, transition: TransitionId, target: StateId) {
        if self.breakpoints.are_at(Spot::Transition(transition)) {
            self.breakpoints.met.push(Met::Transition { transition, target });
        }
    }

    /// A fault that was not known before. What the checks found in the text is not something that has happened.
    pub(super) fn meet_fault(&mut self, code: Code, span: Span, fault: &Fault) {
        let found = || self.program.findings.iter().any(|finding| (finding.code, finding.span) == (code, span));
        if self.on_error == OnError::Pause && happens_while_running(code) && !found() {
            let met = Met::Fault { message: fault.message.clone(), state: fault.state.clone() };
            self.breakpoints.met.push(met);
        }
    }

    /// At the end of a step or a command.
    #[inline]
    pub(super) fn pause_if_met(&mut self) {
        if !self.breakpoints.met.is_empty() {
            self.pause_as_met();
        }
    }

    /// One pause for all that was met. While paused it is told again, so that each step says where it came to.
    #[cold]
    fn pause_as_met(&mut self) {
        while !self.breakpoints.met.is_empty() {
            let met = std::mem::take(&mut self.breakpoints.met);
            let reason = self.why(&met);
            let at = met.iter().find_map(|met| self.where_met(met));
            self.breakpoints.paused = true;
            match self.paused {
                true => self.rare(What::Pause { reason, at }),
                false => self.pause(&reason, at),
            }
            // What the program's own actions upon a pause have brought about.
            self.finish();
        }
    }

    /// `breakpoint: entered m/b, took m: on go a -> b; error in m/b: attempt to ..`
    fn why(&self, met: &[Met]) -> String {
        let program = &self.program;
        let names = SpotNames::of(program);
        let (mut breakpoints, mut errors) = (Vec::new(), Vec::new());
        for met in met {
            let (list, text) = match met {
                Met::State(state) => (&mut breakpoints, format!("entered {}", program[*state].path)),
                Met::Transition { transition, .. } => {
                    (&mut breakpoints, format!("took {}", names.name(Spot::Transition(*transition))))
                }
                Met::Condition { code, machine: None } => (&mut breakpoints, format!("{code} became true")),
                Met::Condition { code, machine: Some(machine) } => {
                    (&mut breakpoints, format!("{code} became true in {}", program[*machine].path))
                }
                Met::Fault { message, state } if state.is_empty() => (&mut errors, format!("error: {message}")),
                Met::Fault { message, state } => (&mut errors, format!("error in {state}: {message}")),
            };
            if !list.contains(&text) {
                list.push(text);
            }
        }
        let breakpoints = Some(breakpoints.join(", ")).filter(|list| !list.is_empty());
        let breakpoints = breakpoints.map(|list| format!("breakpoint: {list}"));
        breakpoints.into_iter().chain(errors).collect::<Vec<_>>().join("; ")
    }

    /// The state to look at.
    fn where_met(&self, met: &Met) -> Option<Arc<str>> {
        let state = match met {
            Met::State(state) | Met::Transition { target: state, .. } => Some(*state),
            Met::Condition { machine, .. } => machine.and_then(|machine| self.active_state(machine)),
            Met::Fault { state, .. } => self.state_of(state),
        };
        state.map(|state| self.program[state].path.clone())
    }

    /// A fault belongs to a state, or to a machine or something in it: then it is the one active there.
    fn state_of(&self, path: &str) -> Option<StateId> {
        let program = &self.program;
        let around = || path.rsplit_once('/').and_then(|(machine, _)| program.machine(machine));
        program.state(path).or_else(|| self.active_state(program.machine(path).or_else(around)?))
    }
}

fn happens_while_running(code: Code) -> bool {
    matches!(
        code,
        Code::Runtime
            | Code::NotBoolean
            | Code::OverTime
            | Code::OverMemory
            | Code::NotMilliseconds
            | Code::AlreadyRunning
    )
}
