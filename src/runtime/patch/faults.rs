//! Faults across an edit: those stand whose block or spawn is still there unchanged; what the checks found, and what an
//! edit itself breaks, is told anew.

use std::collections::HashMap;
use std::sync::Arc;

use super::{Passage, Verdict};
use crate::model::diff::{same_modules, same_spawn};
use crate::model::renamed::{code_now, place_now};
use crate::model::*;
use crate::runtime::engine::Engine;
use crate::runtime::faults::Moved;
use crate::runtime::record::Fault;
use crate::syntax::{Code, Diagnostic, Span};

impl Engine {
    pub(super) fn faults_that_stand(&mut self, passage: &Passage) -> Vec<Fault> {
        if self.faults.is_empty() {
            return Vec::new();
        }
        let places = Places::of(passage);
        self.faults.edited(self.now, |code, span| places.moved(code, span))
    }

    pub(in crate::runtime) fn report_findings(&mut self) {
        let program = Arc::clone(&self.program);
        for Diagnostic { code, span, message, help, .. } in program.findings.iter().filter(|finding| finding.is_error())
        {
            let state = enclosing_path(&program, *span);
            self.fault(*code, *span, message.clone(), help.clone(), state);
        }
    }

    /// Machines that have nothing to start again in.
    pub(super) fn report_missing(&mut self, verdict: &Verdict) {
        for discarded in &verdict.discarded {
            let Some(missing) = &discarded.missing else { continue };
            let message = format!(
                "machine `{}` runs no longer: it would start again in its state `{}`, which doesn't exist",
                discarded.path, missing.state
            );
            let help = format!("write a state `{}`, or spawn the machine in another one", missing.state);
            self.fault(Code::UnknownState, missing.span, message, Some(help), discarded.path.clone());
        }
    }
}

/// Where blocks and spawns of the old program stand in the new one.
struct Places<'p> {
    passage: &'p Passage<'p>,
    /// Old blocks in the order of their places.
    blocks: Vec<BlockId>,
    spawns: HashMap<Span, (Option<StateId>, &'p Spawn)>,
}

impl<'p> Places<'p> {
    fn of(passage: &'p Passage<'p>) -> Places<'p> {
        let old = passage.old;
        let mut blocks: Vec<BlockId> = (0..old.blocks.len() as u32).map(BlockId).collect();
        blocks.sort_by_key(|&block| old[block].span);
        let tops = old.spawns.iter().map(|spawn| (spawn.span, (None, spawn)));
        let states = (0..old.states.len() as u32).map(StateId);
        let nested = states.flat_map(|id| old[id].spawns().map(move |(_, spawn)| (spawn.span, (Some(id), spawn))));
        Places { passage, blocks, spawns: tops.chain(nested).collect() }
    }

    /// A fault that happened while running, where what it happened in is the same.
    fn moved(&self, code: Code, span: Span) -> Option<Moved> {
        match code {
            Code::AlreadyRunning => self.spawn_moved(span),
            Code::Runtime | Code::NotBoolean | Code::OverTime | Code::OverMemory | Code::NotMilliseconds => {
                self.block_moved(span)
            }
            _ => None,
        }
    }

    fn block_moved(&self, span: Span) -> Option<Moved> {
        let Passage { old, new, .. } = self.passage;
        let after = self.blocks.partition_point(|&block| {
            let start = old[block].span;
            (start.file, start.start) <= (span.file, span.start)
        });
        let was = self.blocks[..after].last().copied()?;
        let around = old[was].span;
        let inside = around.file == span.file && span.end <= around.end;
        let now = if inside { self.passage.block(was)? } else { return None };
        let home = new[now].span;
        let place = |at: u32| {
            let inside = place_now(&old[was].code, &new[now].code, (at - around.start) as usize);
            home.start as usize + inside
        };
        let span = Span::new(home.file, place(span.start), place(span.end));
        Some(Moved { span, source: new.source(span).clone(), state: new.owner_path(now) })
    }

    fn spawn_moved(&self, span: Span) -> Option<Moved> {
        let Passage { old, new, matching } = self.passage;
        let &(state, was) = self.spawns.get(&span)?;
        let same = |it: &&Spawn| same_spawn(old, was, new, it, matching);
        let (now, path) = match state {
            None => (new.spawns.iter().find(same)?, Arc::default()),
            Some(state) => {
                let state = &new[matching.state(state)?];
                (state.spawns().map(|(_, spawn)| spawn).find(same)?, state.path.clone())
            }
        };
        self.may_conflict(now).then(|| Moved { span: now.span, source: new.source(now.span).clone(), state: path })
    }

    /// Whether another spawn can have its machine running already.
    fn may_conflict(&self, spawn: &Spawn) -> bool {
        let new = self.passage.new;
        let nested = new.states.iter().flat_map(|state| state.spawns().map(|(_, spawn)| spawn));
        let other = |it: &Spawn| it.machine == spawn.machine && it.target.is_some() && it.span != spawn.span;
        new.spawns.iter().chain(nested).any(other)
    }
}

impl Passage<'_> {
    /// The new block that reads the same in the same element, but for renamed variables: of equal ones there, the first
    /// stays the first.
    fn block(&self, was: BlockId) -> Option<BlockId> {
        let (before, after) = self.homes(self.old[was].owner)?;
        let Block { code, requires, .. } = &self.old[was];
        let renamed = code_now(self.old, was, self.new, self.matching).unwrap_or_else(|_| code.clone());
        let nth = before.into_iter().filter(|&block| self.old[block].code == *code).position(|block| block == was)?;
        let same = |block: &BlockId| {
            let now = &self.new[*block];
            [code, &renamed].contains(&&now.code) && same_modules(self.old, requires, self.new, &now.requires)
        };
        after.into_iter().filter(same).nth(nth)
    }

    /// All blocks of an element, old and new; for a transition, of all those of its machine.
    fn homes(&self, owner: Owner) -> Option<(Vec<BlockId>, Vec<BlockId>)> {
        let Passage { old, new, matching } = self;
        Some(match owner {
            Owner::Program => (old.hooks(), new.hooks()),
            Owner::Var(var) => (vec![old[var].init], vec![new[matching.var(var)?].init]),
            Owner::Event(event) => (vec![old[event].block], vec![new[matching.event(event)?].block]),
            Owner::State(state) => (old[state].blocks(), new[matching.state(state)?].blocks()),
            Owner::Transition(transition) => {
                let machine = old[transition].machine;
                (old.guards(machine), new.guards(matching.machine(machine)?))
            }
        })
    }
}

/// The innermost state or machine that a place lies in.
fn enclosing_path(program: &Program, span: Span) -> Arc<str> {
    let around = |outer: Span| outer.file == span.file && outer.start <= span.start && span.end <= outer.end;
    let mut path = Arc::default();
    let mut machines = &program.tops;
    while let Some(&machine) = machines.iter().find(|&&machine| around(program[machine].span)) {
        path = program[machine].path.clone();
        let Some(&state) = program[machine].states.iter().find(|&&state| around(program[state].span)) else { break };
        path = program[state].path.clone();
        machines = &program[state].machines;
    }
    path
}
