//! One machine's part of a step: the guards of its active state, leaving and entering states, spawning and discarding.

use super::engine::{Engine, Running};
use super::note::Note;
use super::plan::{EntryItem, Guard, Plan, Test};
use super::record::{Fault, Mended, What};
use super::time::Time;
use crate::model::*;
use crate::syntax::{Code, Span};

/// A transition whose guard holds; `via` is the nested state an exit transition is written at.
#[derive(Clone, Copy)]
pub(super) struct Fired {
    pub transition: TransitionId,
    pub target: StateId,
    pub via: Option<StateId>,
}

/// What spawns a machine: a spawn statement at top level, or one of a state's onentry items.
#[derive(Clone, Copy)]
pub(super) enum Spawner {
    Top { index: usize },
    Entry { state: StateId, index: u32 },
}

impl Spawner {
    fn state(self) -> Option<StateId> {
        match self {
            Spawner::Top { .. } => None,
            Spawner::Entry { state, .. } => Some(state),
        }
    }

    fn span(self, program: &Program) -> Span {
        match self {
            Spawner::Top { index } => program.spawns[index].span,
            Spawner::Entry { state, index } => match &program[state].onentry[index as usize] {
                Entry::Spawn(spawn) => spawn.span,
                Entry::Action(block) => program[*block].span,
            },
        }
    }
}

impl Engine {
    pub(super) fn step_machine(&mut self, plan: &Plan, machine: MachineId) {
        let Some(state) = self.active_state(machine) else { return };
        let decided = self.running[machine.index()].as_mut().and_then(|running| running.decided.take());
        if let Some(fired) = decided.or_else(|| self.firing(plan, machine, state)) {
            self.take(plan, machine, state, fired);
            self.settle(plan, machine);
            return;
        }
        self.run_all(plan, plan.running(state));
        for index in 0..self.nested_count(machine) {
            self.step_machine(plan, self.nested(machine, index));
        }
    }

    pub(super) fn runs(&self, machine: MachineId) -> bool {
        self.running[machine.index()].is_some()
    }

    pub(super) fn active_state(&self, machine: MachineId) -> Option<StateId> {
        self.running[machine.index()].as_ref().map(|running| running.state)
    }

    fn nested_count(&self, machine: MachineId) -> usize {
        self.running[machine.index()].as_ref().map_or(0, |running| running.nested.len())
    }

    fn nested(&self, machine: MachineId, index: usize) -> MachineId {
        self.running[machine.index()].as_ref().map_or(machine, |running| running.nested[index])
    }

    /// The first transition that may be taken now: the machine's own, then exits of machines written in the state.
    fn firing(&mut self, plan: &Plan, machine: MachineId, state: StateId) -> Option<Fired> {
        for guard in plan.outgoing(state) {
            if let Some(index) = self.holds(plan, guard, machine) {
                return self.fired(plan.transition(guard, index), None);
            }
        }
        for guard in plan.exits(state) {
            let transition = plan.transition(guard, 0);
            let nested = self.program[transition].machine;
            let Some(inner) = self.active_state(nested) else { continue };
            if self.program[transition].leaves(inner) && self.holds(plan, guard, nested).is_some() {
                return self.fired(transition, Some(inner));
            }
        }
        None
    }

    fn fired(&self, transition: TransitionId, via: Option<StateId>) -> Option<Fired> {
        let target = self.program[transition].target?;
        Some(Fired { transition, target, via })
    }

    /// Which of a guard's transitions may be taken, if any.
    #[inline]
    fn holds(&mut self, plan: &Plan, guard: &Guard, machine: MachineId) -> Option<usize> {
        let due = match guard.test {
            Test::Blocks(conditions) => return self.first_true(plan, conditions),
            Test::Always => true,
            Test::After(timeout) => self.since_entry(machine) >= timeout,
            Test::AfterVar(var) => {
                let ms = self.store.lua.number_in(self.store.cell(var));
                if ms.is_none() {
                    self.not_milliseconds(plan.transition(guard, 0), var);
                }
                ms.is_some_and(|ms| self.is_due(machine, ms))
            }
            Test::AfterBlock(block) => {
                let ms = self.milliseconds(block);
                self.why.note_length(block, ms);
                ms.is_some_and(|ms| self.is_due(machine, ms))
            }
        };
        due.then_some(0)
    }

    /// Compared in the unit of the text, so that nothing is lost to rounding; nan is never due.
    fn is_due(&self, machine: MachineId, ms: f64) -> bool {
        self.since_entry(machine).ms() >= ms
    }

    fn since_entry(&self, machine: MachineId) -> Time {
        self.running[machine.index()].as_ref().map_or(Time::ZERO, |running| self.now.since(running.entered))
    }

    fn take(&mut self, plan: &Plan, machine: MachineId, from: StateId, fired: Fired) {
        self.note(Note::Transition { transition: fired.transition, from, via: fired.via });
        if self.breakpoints.are_armed {
            self.meet_transition(fired.transition, fired.target);
        }
        self.leave(plan, machine);
        self.enter(plan, machine, fired.target);
    }

    /// Runs the onexit actions from the innermost state outwards, then discards what was nested.
    pub(super) fn leave(&mut self, plan: &Plan, machine: MachineId) {
        self.exit(plan, machine);
        self.discard_nested(machine);
    }

    fn exit(&mut self, plan: &Plan, machine: MachineId) {
        for index in 0..self.nested_count(machine) {
            self.exit(plan, self.nested(machine, index));
        }
        if let Some(state) = self.active_state(machine) {
            self.note(Note::Exit(state));
            self.run_all(plan, plan.onexit(state));
        }
    }

    #[inline]
    pub(super) fn discard_nested(&mut self, machine: MachineId) {
        if self.nested_count(machine) > 0 {
            self.discard_all_nested(machine);
        }
    }

    fn discard_all_nested(&mut self, machine: MachineId) {
        let nested = self.running[machine.index()].as_mut().map(|running| std::mem::take(&mut running.nested));
        for machine in nested.unwrap_or_default() {
            self.discard(machine);
        }
    }

    pub(super) fn discard(&mut self, machine: MachineId) {
        self.discard_nested(machine);
        self.running[machine.index()] = None;
        for index in 0..self.program[machine].vars.len() {
            let var = self.program[machine].vars[index];
            self.store.lua.clear(self.store.cell(var));
        }
        self.note(Note::Discard(machine));
    }

    pub(super) fn enter(&mut self, plan: &Plan, machine: MachineId, state: StateId) {
        self.arrive(machine, state);
        if self.breakpoints.are_armed {
            self.meet_state(state);
        }
        for &item in plan.onentry(state) {
            match item {
                EntryItem::Actions(actions) => self.run_all(plan, actions),
                EntryItem::Spawn(index, (machine, start)) => {
                    self.spawn(plan, machine, start, Spawner::Entry { state, index });
                }
            }
        }
    }

    /// Makes a state the active one, its timers started anew, without any action.
    pub(super) fn arrive(&mut self, machine: MachineId, state: StateId) {
        if let Some(running) = &mut self.running[machine.index()] {
            running.state = state;
            running.entered = self.now;
            running.tested = self.step + 1;
            running.decided = None;
        }
        self.visits[state.index()] += 1;
        self.note(Note::Enter(state));
        if self.store.any_stopped() {
            self.allow_blocks_of(state);
        }
    }

    /// A block that ran too long gets another chance when its state is entered anew.
    fn allow_blocks_of(&mut self, entered: StateId) {
        let program = std::sync::Arc::clone(&self.program);
        let state = &program[entered];
        let actions = state.onentry.iter().filter_map(|entry| match entry {
            Entry::Action(block) => Some(*block),
            Entry::Spawn(_) => None,
        });
        let own = program[state.machine].transitions.iter().filter(|&&id| program[id].leaves(entered));
        let guards = own.chain(&state.exits).filter_map(|&id| match program[id].trigger {
            Trigger::Event(event) => Some(program[event].block),
            Trigger::Block(block) | Trigger::AfterBlock(block) => Some(block),
            _ => None,
        });
        for block in actions.chain(state.running.iter().copied()).chain(state.onexit.iter().copied()).chain(guards) {
            self.store.allow_again(block);
        }
    }

    /// Starts a machine in a state.
    pub(super) fn spawn(&mut self, plan: &Plan, machine: MachineId, state: StateId, spawner: Spawner) {
        if self.running[machine.index()].is_some() {
            return self.already_running(machine, spawner);
        }
        if !self.faults.is_empty() {
            self.spawn_is_mended(spawner);
        }
        self.start(machine, state, spawner.state());
        self.enter(plan, machine, state);
    }

    /// Makes a machine run, its variables initialised, before any state is entered.
    pub(super) fn start(&mut self, machine: MachineId, state: StateId, by: Option<StateId>) {
        let start = self.program[state].name.clone();
        self.running[machine.index()] = Some(Running::new(state, self.now, start));
        let parent = by.and_then(|state| self.running[self.program[state].machine.index()].as_mut());
        match parent {
            Some(parent) => parent.nested.push(machine),
            None => self.tops.push(machine),
        }
        self.begin_run(machine, by);
    }

    pub(super) fn begin_run(&mut self, machine: MachineId, by: Option<StateId>) {
        self.note(Note::Spawn { machine, by });
        for index in 0..self.program[machine].vars.len() {
            self.initialise_anew(self.program[machine].vars[index]);
        }
    }

    /// Right after an entry: what may fire is taken in the next step and silences all that is inside; otherwise the
    /// state begins to run.
    pub(super) fn settle(&mut self, plan: &Plan, machine: MachineId) {
        let Some(state) = self.active_state(machine) else { return };
        if plan.running(state).is_empty() && self.nested_count(machine) == 0 {
            return;
        }
        let fired = self.firing(plan, machine, state);
        if let Some(running) = &mut self.running[machine.index()] {
            running.tested = self.step;
            running.decided = fired;
        }
        if fired.is_some() {
            return;
        }
        self.run_all(plan, plan.running(state));
        for index in 0..self.nested_count(machine) {
            self.settle(plan, self.nested(machine, index));
        }
    }

    /// A spawn that was refused before succeeds now.
    #[cold]
    fn spawn_is_mended(&mut self, spawner: Spawner) {
        if let Some(fault) = self.faults.mended(Code::AlreadyRunning, spawner.span(&self.program)) {
            let Fault { code, file, line, column, .. } = fault;
            self.rare(What::Mended(Mended { code, file, line, column }));
        }
    }

    fn already_running(&mut self, machine: MachineId, spawner: Spawner) {
        let program = std::sync::Arc::clone(&self.program);
        let message = format!("machine `{}` is running already; it goes on undisturbed", program[machine].path);
        let help = "a machine runs at most once: write a second machine, or leave the state that spawned it first";
        let state = spawner.state().map(|state| program[state].path.clone()).unwrap_or_default();
        self.fault(Code::AlreadyRunning, spawner.span(&program), message, Some(help.to_string()), state);
    }
}
