//! Where the program is to pause: places from its text and by command, kept over edits and told whenever they change.
//! Knows nothing of what happens when one is met.

use std::sync::Arc;

use super::command::{BreakAt, Breaking};
use super::conditions::Condition;
use super::engine::Engine;
use super::met::Met;
use super::obey::{Refused, refuse};
use super::record::{Breakpoint, Level, Setter, What};
use crate::model::breakpoints::{Spot, SpotNames, in_source};
use crate::model::transition_names::TransitionNames;
use crate::model::{Matching, Program, TransitionId};

#[derive(Default)]
pub(super) struct Breakpoints {
    /// Set by command.
    set: Vec<Spot>,
    /// With a `(break)` in the text, but cleared by command: until that is removed, or set by command again.
    cleared: Vec<Spot>,
    pub conditions: Vec<Condition>,
    /// By state and by transition; empty while nothing is armed.
    states: Vec<bool>,
    transitions: Vec<bool>,
    /// Whether any state or transition is to be looked up at all.
    pub are_armed: bool,
    told: Vec<Breakpoint>,
    /// In this step or command so far.
    pub met: Vec<Met>,
    /// Whether the engine has paused of itself since its records were last taken.
    pub paused: bool,
}

impl Breakpoints {
    pub fn are_at(&self, spot: Spot) -> bool {
        match spot {
            Spot::State(state) => self.states[state.index()],
            Spot::Transition(transition) => self.transitions[transition.index()],
        }
    }

    /// All states and transitions to pause at, those of the text first.
    fn spots(&self, program: &Program) -> Vec<(Spot, Setter)> {
        let source = in_source(program).filter(|spot| !self.cleared.contains(spot));
        let others = self.set.iter().copied().filter(|spot| !spot.is_in_source(program));
        source.map(|spot| (spot, Setter::Source)).chain(others.map(|spot| (spot, Setter::Command))).collect()
    }
}

impl Engine {
    /// All breakpoints, as they were last told.
    pub fn breakpoints(&self) -> &[Breakpoint] {
        &self.breakpoints.told
    }

    pub(super) fn set_breakpoint(&mut self, at: &BreakAt, mode: Breaking) -> Result<(), Refused> {
        let done = match (at, mode) {
            (BreakAt::Condition { condition, machine }, Breaking::Set) => self.watch(condition, machine)?,
            (BreakAt::Condition { condition, machine }, Breaking::Clear) => self.unwatch(condition, machine)?,
            (BreakAt::State { state }, _) => self.set_spot(Spot::State(self.state_called(state)?), mode),
            (BreakAt::Transition { transition }, _) => {
                self.set_spot(Spot::Transition(self.transition_called(transition)?), mode)
            }
        };
        if done == Done::WasNone {
            return Err(Refused(format!("there is no breakpoint at {at}")));
        }
        self.lay_out_breakpoints();
        Ok(())
    }

    fn set_spot(&mut self, spot: Spot, mode: Breaking) -> Done {
        let program = Arc::clone(&self.program);
        let is_there = self.breakpoints.spots(&program).iter().any(|&(known, _)| known == spot);
        match mode {
            Breaking::Set => {
                self.breakpoints.cleared.retain(|&cleared| cleared != spot);
                if !is_there && !spot.is_in_source(&program) {
                    self.breakpoints.set.push(spot);
                }
            }
            Breaking::Clear if !is_there => return Done::WasNone,
            Breaking::Clear => {
                self.breakpoints.set.retain(|&set| set != spot);
                if spot.is_in_source(&program) {
                    self.breakpoints.cleared.push(spot);
                }
            }
        }
        Done::Done
    }

    fn transition_called(&self, name: &str) -> Result<TransitionId, Refused> {
        let names = TransitionNames::of(&self.program);
        names.called(name).ok_or_else(|| refuse("transition", name, names.all().iter().map(|name| &**name)))
    }

    /// Another program was taken over: what is still there keeps its breakpoints.
    pub(super) fn follow_breakpoints(&mut self, old: &Program, matching: &Matching) {
        let new = Arc::clone(&self.program);
        let names = SpotNames::of(old);
        let cleared = std::mem::take(&mut self.breakpoints.cleared).into_iter();
        let still = cleared.filter_map(|spot| spot.follow(matching)).filter(|spot| spot.is_in_source(&new));
        self.breakpoints.cleared = still.collect();
        for spot in std::mem::take(&mut self.breakpoints.set) {
            match spot.follow(matching) {
                Some(now) => self.breakpoints.set.push(now),
                None => self.breakpoint_gone(&place(spot, &names), "it is no longer there"),
            }
        }
        self.follow_conditions(old, matching);
        self.lay_out_breakpoints();
    }

    pub(super) fn breakpoint_gone(&mut self, at: &BreakAt, why: &str) {
        self.remark(Level::Warn, format!("the breakpoint at {at} is gone: {why}"));
    }

    /// Arms what is to be met, and tells all breakpoints where they have changed.
    fn lay_out_breakpoints(&mut self) {
        let program = Arc::clone(&self.program);
        let spots = self.breakpoints.spots(&program);
        let breakpoints = &mut self.breakpoints;
        breakpoints.are_armed = !spots.is_empty();
        let sizes = if spots.is_empty() { (0, 0) } else { (program.states.len(), program.transitions.len()) };
        (breakpoints.states, breakpoints.transitions) = (vec![false; sizes.0], vec![false; sizes.1]);
        for &(spot, _) in &spots {
            match spot {
                Spot::State(state) => breakpoints.states[state.index()] = true,
                Spot::Transition(transition) => breakpoints.transitions[transition.index()] = true,
            }
        }
        let names = SpotNames::of(&program);
        let places = spots.into_iter().map(|(spot, by)| Breakpoint { at: place(spot, &names), by });
        let conditions = breakpoints.conditions.iter();
        let conditions = conditions.map(|it| Breakpoint { at: it.place(&program), by: Setter::Command });
        let all: Vec<Breakpoint> = places.chain(conditions).collect();
        if breakpoints.told != all {
            breakpoints.told.clone_from(&all);
            self.rare(What::Breakpoints { all });
        }
    }
}

/// What came of a command.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Done {
    Done,
    /// There was nothing to clear.
    WasNone,
}

fn place(spot: Spot, names: &SpotNames) -> BreakAt {
    let name = names.name(spot);
    match spot {
        Spot::State(_) => BreakAt::State { state: name },
        Spot::Transition(_) => BreakAt::Transition { transition: name },
    }
}
