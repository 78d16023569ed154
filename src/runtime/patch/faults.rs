//! Faults across an edit: those stand whose block or spawn is still there unchanged; what the checks found, and what an
//! edit itself breaks, is told anew.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use super::{Passage, Verdict};
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

    pub(super) fn report_findings(&mut self) {
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
    /// By old block.
    now: Vec<Option<BlockId>>,
    spawns: HashMap<Span, (Option<StateId>, &'p Spawn)>,
}

/// Whose a block is, by the new program: of equal ones in one home, the first stays the first.
#[derive(PartialEq, Eq, Hash)]
enum Home {
    Program,
    Var(VarId),
    Event(EventId),
    State(StateId),
    /// The transitions of a machine.
    Machine(MachineId),
}

impl<'p> Places<'p> {
    fn of(passage: &'p Passage<'p>) -> Places<'p> {
        let old = passage.old;
        let mut blocks: Vec<BlockId> = (0..old.blocks.len() as u32).map(BlockId).collect();
        blocks.sort_by_key(|&block| old[block].span);
        let tops = old.spawns.iter().map(|spawn| (spawn.span, (None, spawn)));
        let states = (0..old.states.len() as u32).map(StateId);
        let nested =
            states.flat_map(|id| old[id].spawns().map(move |(_, spawn)| (spawn.span, (Some(id), spawn))));
        Places { passage, blocks, now: blocks_now(passage), spawns: tops.chain(nested).collect() }
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
        let now = self.now[was.index()].filter(|_| around.file == span.file && span.end <= around.end)?;
        let start = (new[now].span.start + (span.start - around.start)) as usize;
        let span = Span::new(new[now].span.file, start, start + (span.end - span.start) as usize);
        Some(Moved { span, source: new.source(span).clone(), state: new.owner_path(now) })
    }

    fn spawn_moved(&self, span: Span) -> Option<Moved> {
        let Passage { new, matching, .. } = self.passage;
        let &(state, was) = self.spawns.get(&span)?;
        let same = |it: &&Spawn| it.machine_name == was.machine_name && it.state_name == was.state_name;
        let (now, path) = match state {
            None => (new.spawns.iter().find(same)?, Arc::default()),
            Some(state) => {
                let state = &new[matching.state(state)?];
                (state.spawns().map(|(_, spawn)| spawn).find(same)?, state.path.clone())
            }
        };
        Some(Moved { span: now.span, source: new.source(now.span).clone(), state: path })
    }
}

/// By old block: the new one that reads the same in the same home.
fn blocks_now(passage: &Passage) -> Vec<Option<BlockId>> {
    let Passage { old, new, .. } = passage;
    let mut there: HashMap<(Home, &str), VecDeque<BlockId>> = HashMap::new();
    for (index, block) in new.blocks.iter().enumerate() {
        let home = home(new, block.owner);
        there.entry((home, &block.code)).or_default().push_back(BlockId(index as u32));
    }
    let mut now = Vec::with_capacity(old.blocks.len());
    for block in &old.blocks {
        let twins = passage.home(block.owner).and_then(|home| there.get_mut(&(home, &*block.code)));
        now.push(twins.and_then(VecDeque::pop_front));
    }
    now
}

fn home(program: &Program, owner: Owner) -> Home {
    match owner {
        Owner::Program => Home::Program,
        Owner::Var(var) => Home::Var(var),
        Owner::Event(event) => Home::Event(event),
        Owner::State(state) => Home::State(state),
        Owner::Transition(transition) => Home::Machine(program[transition].machine),
    }
}

impl Passage<'_> {
    /// Of an old block; none where the owner is gone.
    fn home(&self, owner: Owner) -> Option<Home> {
        match home(self.old, owner) {
            Home::Program => Some(Home::Program),
            Home::Var(var) => self.matching.var(var).map(Home::Var),
            Home::Event(event) => self.matching.event(event).map(Home::Event),
            Home::State(state) => self.matching.state(state).map(Home::State),
            Home::Machine(machine) => self.matching.machine(machine).map(Home::Machine),
        }
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
