//! Why a state is not left: what each guard came to when it was last looked at. A step notes only what nothing else tells,
//! so that it costs nothing when nobody asks; the rest follows from which state is active and what is decided. Runs no block.

use std::collections::HashMap;
use std::sync::Arc;

use super::command::Explain;
use super::engine::{Engine, Running};
use super::record::{Answer, Way, What};
use super::time::Time;
use crate::model::transition_names::TransitionNames;
use crate::model::ways::{guard_block, ways_out};
use crate::model::*;

const NOT_YET: &str = "not looked at yet";

/// While the program runs, guards are told at most this often.
const TELL_EVERY: Time = Time(100_000);

#[derive(Default)]
pub(super) struct Why {
    mode: Explain,
    /// By active state.
    told: HashMap<StateId, Told>,
    told_at: Option<Time>,
    /// Blocks that weren't true or false, or no number, when they last ran.
    amiss: HashMap<BlockId, Amiss>,
    /// By block: what a timeout's block gave last, ms.
    lengths: Vec<f64>,
}

struct Amiss {
    step: u64,
    answer: Answer,
    message: String,
}

/// What was told of a state since it was entered for the so manieth time.
struct Told {
    visits: u64,
    findings: Vec<Finding>,
}

#[derive(Clone, Debug, PartialEq)]
struct Finding {
    answer: Answer,
    after: Option<f64>,
    message: Option<String>,
}

impl Finding {
    fn plain(answer: Answer) -> Finding {
        Finding { answer, after: None, message: None }
    }

    fn with(answer: Answer, message: impl Into<String>) -> Finding {
        Finding { message: Some(message.into()), ..Finding::plain(answer) }
    }
}

impl Why {
    #[inline]
    pub fn is_asked(&self) -> bool {
        self.mode == Explain::On
    }

    pub fn ask(&mut self, mode: Explain) {
        self.mode = mode;
        self.tell_all_again();
    }

    fn tell_all_again(&mut self) {
        self.told.clear();
        self.told_at = None;
    }

    /// Another program was taken over.
    pub fn begin_anew(&mut self, program: &Program) {
        self.tell_all_again();
        self.amiss.clear();
        self.lengths.clear();
        self.lengths.resize(program.blocks.len(), f64::NAN);
    }

    #[inline]
    pub fn note_length(&mut self, block: BlockId, ms: Option<f64>) {
        self.lengths[block.index()] = ms.unwrap_or(f64::NAN);
    }

    #[cold]
    pub fn note_amiss(&mut self, block: BlockId, step: u64, answer: Answer, message: &str) {
        self.amiss.insert(block, Amiss { step, answer, message: message.to_string() });
    }
}

impl Engine {
    /// The ways out of a state with what their guards came to when they were last looked at.
    pub fn ways(&self, state: StateId) -> Vec<Way> {
        let ways = ways_out(&self.program, state);
        let findings = ways.iter().map(|&id| self.finding(state, id)).collect();
        self.spelled_out(&ways, findings)
    }

    fn spelled_out(&self, ways: &[TransitionId], findings: Vec<Finding>) -> Vec<Way> {
        let names = TransitionNames::of(&self.program);
        let way = |(&id, Finding { answer, after, message })| Way {
            transition: names.name(id),
            guard: answer,
            after,
            message,
        };
        ways.iter().zip(findings).map(way).collect()
    }

    /// Of each active state, what has changed since that was last told.
    #[cold]
    pub(super) fn tell_guards(&mut self) {
        let is_early = self.why.told_at.is_some_and(|at| self.now.since(at) < TELL_EVERY);
        if is_early && !self.paused {
            return;
        }
        self.why.told_at = Some(self.now);
        let active: Vec<StateId> = self.running.iter().flatten().map(|running| running.state).collect();
        self.why.told.retain(|state, _| active.contains(state));
        for state in active {
            self.tell_guards_of(state);
        }
    }

    fn tell_guards_of(&mut self, state: StateId) {
        let ways = ways_out(&self.program, state);
        let visits = self.visits[state.index()];
        let findings: Vec<Finding> = ways.iter().map(|&id| self.finding(state, id)).collect();
        let known = self.why.told.get(&state);
        if ways.is_empty() || known.is_some_and(|known| known.visits == visits && known.findings == findings) {
            return;
        }
        self.why.told.insert(state, Told { visits, findings: findings.clone() });
        let ways = self.spelled_out(&ways, findings);
        self.rare(What::Guards { state: self.program[state].path.clone(), ways });
    }

    fn finding(&self, state: StateId, way: TransitionId) -> Finding {
        let program = &self.program;
        if self.active_state(program[state].machine) != Some(state) {
            return Finding::with(Answer::Unseen, format!("{} is not active", program[state].name));
        }
        if let Some(why) = self.never(way) {
            return Finding::with(Answer::Error, why);
        }
        if program[way].kind == TransitionKind::Exit { self.exit_finding(way) } else { self.tested(state, way) }
    }

    /// Why a transition can't be taken as it is written.
    fn never(&self, way: TransitionId) -> Option<String> {
        let program = &self.program;
        let transition = &program[way];
        match &transition.trigger {
            Trigger::UnknownEvent(name) => return Some(format!("there is no event `{name}`")),
            Trigger::AfterUnknown(name) => return Some(format!("there is no variable `{name}`")),
            _ if transition.target.is_none() => return Some(format!("there is no state `{}`", transition.target_name)),
            _ => {}
        }
        let block = guard_block(program, way).filter(|&block| self.store.ready(block).is_none())?;
        Some(match (self.store.block(block).lua, self.why.amiss.get(&block)) {
            (None, _) => "its block is no Lua".to_string(),
            (Some(_), Some(amiss)) => format!("{}; it is not run again", amiss.message),
            (Some(_), None) => "it took too long and is not run again".to_string(),
        })
    }

    /// An exit is looked at by the machine around its own, in the state that is written around.
    fn exit_finding(&self, way: TransitionId) -> Finding {
        let program = &self.program;
        let machine = program[way].machine;
        let Some(outer) = program[machine].parent else {
            return Finding::with(Answer::Error, "there is no machine around this one to leave to");
        };
        if self.active_state(program[outer].machine) != Some(outer) {
            return Finding::with(Answer::Unseen, format!("{} is not active", program[outer].name));
        }
        match self.active_state(machine) {
            None => Finding::with(Answer::Unseen, format!("{} is not running", program[machine].name)),
            Some(inner) if !program[way].leaves(inner) => {
                let (machine, inner) = (&program[machine].name, &program[inner].name);
                Finding::with(Answer::Unseen, format!("{machine} is in {inner}"))
            }
            Some(_) if self.arrived_after(program[outer].machine, machine) => {
                Finding { after: self.length(way), ..Finding::with(Answer::Unseen, NOT_YET) }
            }
            Some(_) => self.tested(outer, way),
        }
    }

    /// Whether a nested machine went to its state in this step, when the machine around it had looked already.
    fn arrived_after(&self, outer: MachineId, inner: MachineId) -> bool {
        let tested = |machine: MachineId| self.running[machine.index()].as_ref().map_or(0, |running| running.tested);
        tested(inner) >= self.step && tested(outer) < self.step
    }

    /// `state` is active: its machine has tested the guards in order, up to the first that held.
    fn tested(&self, state: StateId, way: TransitionId) -> Finding {
        let Some(running) = &self.running[self.program[state].machine.index()] else {
            return Finding::plain(Answer::Unseen);
        };
        let order = |id: TransitionId| {
            let State { outgoing, exits, .. } = &self.program[state];
            outgoing.iter().chain(exits).position(|&other| other == id)
        };
        match &running.decided {
            Some(fired) if fired.transition == way => {
                Finding { after: self.length(way), ..Finding::plain(Answer::True) }
            }
            Some(fired) if order(way) > order(fired.transition) => {
                Finding::with(Answer::Unseen, "an earlier one fires first")
            }
            Some(_) => self.not_true(way),
            None if self.step < running.tested => Finding { after: self.length(way), ..self.not_tested(state) },
            None => self.not_true(way),
        }
    }

    fn not_tested(&self, state: StateId) -> Finding {
        let outer = self.around(self.program[state].machine).find(|outer| outer.decided.is_some());
        match outer {
            Some(outer) => {
                let around = &self.program[outer.state].name;
                Finding::with(Answer::Unseen, format!("a transition out of {around} fires first"))
            }
            None => Finding::with(Answer::Unseen, NOT_YET),
        }
    }

    /// The machines by which a machine was spawned, innermost first.
    fn around(&self, machine: MachineId) -> impl Iterator<Item = &Running> {
        let outer = |inner: MachineId| {
            let spawned = |running: &Option<Running>| running.as_ref().is_some_and(|it| it.nested.contains(&inner));
            Some(MachineId(self.running.iter().position(spawned)? as u32))
        };
        std::iter::successors(outer(machine), move |&inner| outer(inner))
            .filter_map(|machine| self.running[machine.index()].as_ref())
    }

    /// It was looked at and didn't hold.
    fn not_true(&self, way: TransitionId) -> Finding {
        let after = self.length(way);
        let block = guard_block(&self.program, way);
        let amiss = block.and_then(|block| self.why.amiss.get(&block)).filter(|amiss| amiss.step == self.step);
        match (amiss, &self.program[way].trigger) {
            (Some(amiss), _) => Finding::with(amiss.answer, amiss.message.clone()),
            (None, Trigger::AfterVar(var)) if after.is_none() => {
                let name: &Arc<str> = &self.program[*var].name;
                Finding::with(Answer::Error, format!("`{name}` is not a number of milliseconds"))
            }
            (None, _) => Finding { after, ..Finding::plain(Answer::False) },
        }
    }

    /// Of a timeout, ms.
    fn length(&self, way: TransitionId) -> Option<f64> {
        let ms = match self.program[way].trigger {
            Trigger::After(ms) => ms,
            Trigger::AfterVar(var) => self.store.lua.number_in(self.store.cell(var))?,
            Trigger::AfterBlock(block) => self.why.lengths[block.index()],
            _ => return None,
        };
        ms.is_finite().then_some(ms)
    }
}
