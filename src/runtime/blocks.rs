//! Running a program's blocks: each on its own, so that a mistake in one costs that one alone.

use std::ops::Range;
use std::sync::Arc;

use super::engine::Engine;
use super::faults::Happening;
use super::plan::{Calls, Plan};
use super::record::{Answer, Log, What};
use crate::lua::{self, Failure, FailureKind, Num, Ran};
use crate::model::blocks::{Role, place};
use crate::model::*;
use crate::syntax::{Code, Diagnostic, Span};

impl Engine {
    /// Runs actions one after another.
    pub(super) fn run_all(&mut self, plan: &Plan, actions: Calls) {
        if actions.is_empty() {
            return;
        }
        self.count_from_entry(actions.machine);
        let (blocks, functions) = (plan.blocks(actions), plan.functions(actions));
        let mut part = self.store.ready_part(blocks, 0);
        while !part.is_empty() {
            let failed = self.store.lua.run_all(&functions[part.clone()]).map(|at| part.start + at);
            let end = failed.map_or(part.end, |at| at + 1);
            self.ran_all(actions, blocks, part.start..end);
            if let Some(at) = failed {
                self.failed(blocks[at]);
            }
            part = self.store.ready_part(blocks, end);
        }
    }

    /// Which of these conditions is the first that is true: one that fails isn't, nor what is no boolean.
    pub(super) fn first_true(&mut self, plan: &Plan, conditions: Calls) -> Option<usize> {
        self.count_from_entry(conditions.machine);
        let (blocks, functions) = (plan.blocks(conditions), plan.functions(conditions));
        let mut part = self.store.ready_part(blocks, 0);
        while !part.is_empty() {
            let found = self.store.lua.test_all(&functions[part.clone()]).map(|(at, test)| (part.start + at, test));
            let end = found.map_or(part.end, |(at, _)| at + 1);
            self.ran_all(conditions, blocks, part.start..end);
            match found {
                Some((at, lua::Test::True)) => return Some(at),
                Some((at, lua::Test::Failed)) => self.failed(blocks[at]),
                Some((at, lua::Test::NotBoolean(kind))) => self.not_boolean(blocks[at], kind),
                Some((_, lua::Test::False)) | None => {}
            }
            part = self.store.ready_part(blocks, end);
        }
        None
    }

    pub(super) fn run(&mut self, block: BlockId) {
        let Some(function) = self.prepare(block) else { return };
        if matches!(self.store.lua.run(function), Ran::Failed) {
            self.failed(block);
        }
        self.ran(block);
    }

    /// The value of a timeout's block, in milliseconds.
    pub(super) fn milliseconds(&mut self, block: BlockId) -> Option<f64> {
        let function = self.prepare(block)?;
        let result = self.store.lua.number(function);
        self.ran(block);
        match result {
            Num::Number(ms) => Some(ms),
            Num::Failed => {
                self.failed(block);
                None
            }
            Num::NotNumber(kind) => {
                let span = self.program[block].span;
                let message = format!("a timeout is a number of milliseconds, but this block gives {kind}");
                self.why.note_amiss(block, self.step, Answer::Error, &message);
                self.block_fault(block, Code::NotMilliseconds, span, message, None);
                None
            }
        }
    }

    /// Gives a variable its initial value: nil where its block fails.
    pub(super) fn initialise(&mut self, var: VarId) {
        let block = self.program[var].init;
        let cell = self.store.cell(var);
        self.store.lua.clear(cell);
        if let Some(function) = self.prepare(block) {
            if matches!(self.store.lua.init(function, cell), Ran::Failed) {
                self.failed(block);
            }
            self.ran(block);
        }
        self.store.lua.changed(cell);
        self.report(var, "init".into());
    }

    /// As its scope starts anew: a block that ran too long gets another chance.
    pub(super) fn initialise_anew(&mut self, var: VarId) {
        self.store.allow_again(self.program[var].init);
        self.initialise(var);
    }

    fn prepare(&mut self, block: BlockId) -> Option<lua::Block> {
        let function = self.store.ready(block)?;
        self.count_from_entry(self.store.block(block).machine);
        Some(function)
    }

    /// Has `elapsed()` count from when a machine's active state was entered.
    #[inline]
    pub(super) fn count_from_entry(&mut self, machine: Option<MachineId>) {
        let entered = machine.and_then(|machine| self.running[machine.index()].as_ref()).map(|running| running.entered);
        self.store.lua.since(entered.unwrap_or_default().0);
    }

    #[inline]
    fn ran_all(&mut self, calls: Calls, blocks: &[BlockId], these: Range<usize>) {
        if calls.use_variables {
            blocks[these].iter().for_each(|&block| self.note_touched(block));
        }
        self.note_logs();
    }

    fn ran(&mut self, block: BlockId) {
        self.note_touched(block);
        self.note_logs();
    }

    fn note_touched(&mut self, block: BlockId) {
        if self.store.block(block).uses_variables {
            self.changes.touched(block);
        }
    }

    #[inline]
    pub(super) fn note_logs(&mut self) {
        if self.store.lua.has_logs() {
            self.take_logs();
        }
    }

    #[cold]
    pub(super) fn take_logs(&mut self) {
        for line in self.store.lua.take_logs() {
            let place = line.block.and_then(|function| self.store.find(function));
            let (state, file, at) = match place {
                Some(block) => {
                    let span = self.program[block].span;
                    let source = self.program.source(span);
                    let first = source.line(span.start as usize);
                    (self.program.owner_path(block), source.name.clone(), first + line.line.max(1) as usize - 1)
                }
                None => (Arc::default(), Arc::default(), 0),
            };
            self.rare(What::Log(Log { level: line.level.into(), message: line.message, state, file, line: at }));
        }
    }

    #[cold]
    fn failed(&mut self, block: BlockId) {
        let failure = self.store.lua.take_failure();
        if let Some(missing) = self.robots.no_message(&failure.message) {
            return self.waiting_for_message(block, &failure, missing);
        }
        let (code, help) = match failure.kind {
            FailureKind::Runtime => (Code::Runtime, None),
            FailureKind::OverTime => {
                (Code::OverTime, Some("it is not run again until it is edited or its state is entered anew"))
            }
            FailureKind::OverMemory => {
                (Code::OverMemory, Some("it is not run again until it is edited or its state is entered anew"))
            }
        };
        if code != Code::Runtime {
            self.store.stop(block);
        }
        self.why.note_amiss(block, self.step, Answer::Error, &failure.message);
        let span = self.failure_span(block, &failure);
        match self.found_before(block, &failure) {
            Some(found) => self.block_fault(block, found.code, found.span, found.message, found.help),
            None => self.block_fault(block, code, span, failure.message, help.map(str::to_string)),
        }
    }

    /// An unknown name was reported when the program was read: it is the same fault, and now it has happened.
    fn found_before(&self, block: BlockId, failure: &Failure) -> Option<Diagnostic> {
        let variable = failure.message.strip_prefix("there is no variable or function '");
        let variable = variable.and_then(|name| name.split('\'').next());
        self.found_in(block, |finding| {
            let name = self.program.source(finding.span).slice(finding.span);
            match finding.code {
                Code::UnknownVariable => variable == Some(name),
                Code::UnknownField => {
                    let told = [format!("`{name}`"), format!(".{name}`"), format!("'{name}'")];
                    told.iter().any(|told| failure.message.contains(told))
                }
                _ => false,
            }
        })
    }

    /// What was found in a block when the program was read.
    fn found_in(&self, block: BlockId, is_it: impl Fn(&Diagnostic) -> bool) -> Option<Diagnostic> {
        let within = self.program[block].span;
        let inside = |Span { file, start, end }: Span| {
            (file, start >= within.start, end <= within.end) == (within.file, true, true)
        };
        self.program.findings.iter().find(|finding| inside(finding.span) && is_it(finding)).cloned()
    }

    fn failure_span(&self, block: BlockId, failure: &Failure) -> Span {
        let span = self.program[block].span;
        let is_field = ["(field '", "(method '"].iter().any(|field| failure.message.contains(field));
        let role = if is_field { Role::Field } else { Role::Name };
        place(self.program.source(span), span, failure.line, failure.token.as_deref().map(|token| (token, role)))
    }

    /// Not a mistake: the robot has not spoken, or not lately. Said once for each input.
    fn waiting_for_message(&mut self, block: BlockId, failure: &Failure, missing: super::robot::NoMessage) {
        let super::robot::NoMessage { bridge, input, why } = &missing;
        let lacks = format!("`{bridge}.{input}` {why}");
        self.why.note_amiss(block, self.step, Answer::NoMessage, &lacks);
        // Before the first step nothing can have come.
        if self.step == 0 || !self.robots.is_news(&missing) {
            return;
        }
        let span = self.failure_span(block, failure);
        let source = self.program.source(span);
        let line = source.line(span.start as usize);
        let message = format!("{lacks}; what needs it is skipped until one comes");
        let log = Log {
            level: super::record::Level::Info,
            message,
            state: self.program.owner_path(block),
            file: source.name.clone(),
            line,
        };
        self.rare(What::Log(log));
    }

    #[cold]
    fn not_boolean(&mut self, block: BlockId, kind: &str) {
        let message = format!("it gives {kind}, not true or false");
        self.why.note_amiss(block, self.step, Answer::NotBoolean, &message);
        let known =
            |finding: &Diagnostic| matches!(finding.code, Code::EventAssigns | Code::Smalltalk) && finding.is_error();
        if let Some(found) = self.found_in(block, known) {
            return self.block_fault(block, found.code, found.span, found.message, found.help);
        }
        let span = self.program[block].span;
        let (what, help) = match self.program[block].owner {
            Owner::Event(event) => {
                (format!("event `{}`", self.program[event].name), "compare with something: `x > 0`, `x ~= nil`")
            }
            _ => ("this trigger".to_string(), "compare with something: `x > 0`, `x ~= nil`"),
        };
        let message = format!("{what} gives {kind}, not true or false; it doesn't occur");
        self.block_fault(block, Code::NotBoolean, span, message, Some(help.to_string()));
    }

    pub(super) fn not_milliseconds(&mut self, transition: TransitionId, var: VarId) {
        let program = Arc::clone(&self.program);
        let message =
            format!("timeout `{}` is not a number of milliseconds; the transition is not taken", program[var].name);
        let state = program[program[transition].machine].path.clone();
        self.fault(Code::NotMilliseconds, program[transition].span, message, None, state);
    }

    fn block_fault(&mut self, block: BlockId, code: Code, span: Span, message: String, help: Option<String>) {
        let state = self.program.owner_path(block);
        self.fault(code, span, message, help, state);
    }

    pub(super) fn fault(&mut self, code: Code, span: Span, message: String, help: Option<String>, state: Arc<str>) {
        let happening = Happening { code, span, message, help, state };
        if let Some(fault) = self.faults.happened(self.now, self.program.source(span), happening) {
            self.meet_fault(code, span, &fault);
            self.rare(What::Error(fault));
        }
    }
}
