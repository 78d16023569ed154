//! Breakpoints on a condition: Lua expressions that are looked at after each step, while their machine runs.

use std::sync::Arc;

use super::breakpoints::Done;
use super::command::BreakAt;
use super::engine::Engine;
use super::met::Met;
use super::obey::{Refused, refuse};
use crate::lua::{self, Cell, FailureKind, Test};
use crate::model::names::Names;
use crate::model::renamed::{Captured, expression_now};
use crate::model::{MachineId, Matching, Program};
use crate::syntax::nearest::nearest;
use crate::syntax::{Code, Span};

pub(super) struct Condition {
    code: Arc<str>,
    /// Whose variables it sees; none: top level.
    machine: Option<MachineId>,
    block: lua::Block,
    /// When it was last looked at: only becoming true counts.
    seen: Seen,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Seen {
    False,
    True,
    /// It ran too long: not looked at again.
    Stopped,
}

impl Condition {
    pub fn place(&self, program: &Program) -> BreakAt {
        let machine = self.machine.map(|machine| program[machine].path.clone()).unwrap_or_default();
        BreakAt::Condition { condition: self.code.clone(), machine }
    }
}

impl Engine {
    pub(super) fn watch(&mut self, code: &Arc<str>, machine: &str) -> Result<Done, Refused> {
        if self.program.sources.is_empty() {
            return Err(Refused("there is no program yet to watch".to_string()));
        }
        let machine = self.scope_called(machine)?;
        if self.watched(code, machine).is_some() {
            return Ok(Done::Done);
        }
        let block = self.compile_condition(code, machine)?;
        self.breakpoints.conditions.push(Condition { code: code.clone(), machine, block, seen: Seen::False });
        self.look(self.breakpoints.conditions.len() - 1);
        Ok(Done::Done)
    }

    pub(super) fn unwatch(&mut self, code: &str, machine: &str) -> Result<Done, Refused> {
        let machine = self.scope_called(machine)?;
        let Some(index) = self.watched(code, machine) else { return Ok(Done::WasNone) };
        let condition = self.breakpoints.conditions.remove(index);
        self.store.lua.free_block(condition.block);
        Ok(Done::Done)
    }

    fn watched(&self, code: &str, machine: Option<MachineId>) -> Option<usize> {
        self.breakpoints.conditions.iter().position(|known| *known.code == *code && known.machine == machine)
    }

    /// A machine by its path; the empty one is the top level.
    fn scope_called(&self, path: &str) -> Result<Option<MachineId>, Refused> {
        let known = self.program.machines.iter().map(|machine| &*machine.path);
        match self.program.machine(path) {
            None if !path.is_empty() => Err(refuse("machine", path, known)),
            machine => Ok(machine),
        }
    }

    fn compile_condition(&mut self, code: &str, machine: Option<MachineId>) -> Result<lua::Block, Refused> {
        if code.trim().is_empty() {
            return Err(Refused("a condition is a Lua expression, such as `x > 3`".to_string()));
        }
        let broken = |error: lua::SyntaxError| Refused(format!("`{code}`: {}", error.message));
        let facts = self.store.lua.facts(code).map_err(broken)?;
        if let Some(assigned) = facts.writes.first() {
            let name = &assigned.name;
            return Err(Refused(format!("`{code}`: a condition can't assign `{name}`; compare with `{name} == ..`")));
        }
        let program = Arc::clone(&self.program);
        let vars = Names::of(&program).vars_in_scope(machine);
        let scope: Vec<(&str, Cell)> = vars.iter().map(|&var| (&*program[var].name, self.store.cell(var))).collect();
        let at_hand = self.store.lua.at_hand();
        let known = || scope.iter().map(|(name, _)| *name).chain(at_hand.iter().map(String::as_str));
        if let Some(unknown) = facts.reads.iter().find(|read| !known().any(|name| name == read.name)) {
            let near = nearest(&unknown.name, known()).map(|near| format!("; did you mean `{near}`?"));
            let message = format!("`{code}`: `{}` is not a variable in scope here", unknown.name);
            return Err(Refused(message + &near.unwrap_or_default()));
        }
        self.store.lua.compile(code, &scope).map_err(broken)
    }

    /// At the end of a step: those that have become true are met.
    #[inline]
    pub(super) fn test_conditions(&mut self) {
        for index in 0..self.breakpoints.conditions.len() {
            if self.look(index) == Rise::Rose {
                let Condition { code, machine, .. } = &self.breakpoints.conditions[index];
                let met = Met::Condition { code: code.clone(), machine: *machine };
                self.breakpoints.met.push(met);
            }
        }
    }

    fn look(&mut self, index: usize) -> Rise {
        let before = self.breakpoints.conditions[index].seen;
        let now = if before == Seen::Stopped { before } else { self.evaluate(index) };
        self.breakpoints.conditions[index].seen = now;
        if (before, now) == (Seen::False, Seen::True) { Rise::Rose } else { Rise::None }
    }

    fn evaluate(&mut self, index: usize) -> Seen {
        let Condition { block, machine, .. } = self.breakpoints.conditions[index];
        if machine.is_some_and(|machine| !self.runs(machine)) {
            return Seen::False;
        }
        self.count_from_entry(machine);
        let result = self.store.lua.test(block);
        self.note_logs();
        match result {
            Test::True => Seen::True,
            Test::False => Seen::False,
            Test::NotBoolean(kind) => {
                let why = format!("it gives {kind}, not true or false");
                self.condition_fault(index, Code::NotBoolean, &why);
                Seen::False
            }
            Test::Failed => self.condition_failed(index),
        }
    }

    /// What needs a message that hasn't come is not true yet, and no mistake.
    #[cold]
    fn condition_failed(&mut self, index: usize) -> Seen {
        let failure = self.store.lua.take_failure();
        let (code, seen) = match failure.kind {
            FailureKind::Runtime => (Code::Runtime, Seen::False),
            FailureKind::OverTime => (Code::OverTime, Seen::Stopped),
            FailureKind::OverMemory => (Code::OverMemory, Seen::Stopped),
        };
        if self.robots.no_message(&failure.message).is_none() {
            self.condition_fault(index, code, &failure.message);
        }
        seen
    }

    /// It stands in no text: the place to look at is its machine.
    fn condition_fault(&mut self, index: usize, code: Code, why: &str) {
        let program = Arc::clone(&self.program);
        let Condition { code: condition, machine, .. } = &self.breakpoints.conditions[index];
        let message = format!("breakpoint condition `{condition}`: {why}");
        let (span, state) = match *machine {
            Some(machine) => (program[machine].name_span, program[machine].path.clone()),
            None => (Span::default(), Arc::default()),
        };
        self.fault(code, span, message, None, state);
    }

    /// Compiled anew, as the variables may be other ones.
    pub(super) fn follow_conditions(&mut self, old: &Program, matching: &Matching) {
        for condition in std::mem::take(&mut self.breakpoints.conditions) {
            self.store.lua.free_block(condition.block);
            let place = condition.place(old);
            let machine = match condition.machine {
                None => None,
                Some(machine) => match matching.machine(machine) {
                    Some(now) => Some(now),
                    None => {
                        self.breakpoint_gone(&place, "its machine is no longer there");
                        continue;
                    }
                },
            };
            let renamed = expression_now(&condition.code, old, condition.machine, &self.program, matching);
            let renamed = renamed
                .map_err(|Captured(name)| Refused(format!("its variable is called `{name}` now, as a local in it")));
            match renamed.and_then(|code| Ok((self.compile_condition(&code, machine)?, code))) {
                Ok((block, code)) => {
                    let seen = if condition.seen == Seen::True { Seen::True } else { Seen::False };
                    self.breakpoints.conditions.push(Condition { code, machine, block, seen });
                }
                Err(Refused(why)) => self.breakpoint_gone(&place, &why),
            }
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Rise {
    None,
    Rose,
}
