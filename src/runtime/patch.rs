//! Taking a program over while the old one runs: what the edit doesn't concern stays as it is.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use super::engine::{Engine, Running};
use super::machine::Spawner;
use super::plan::Plan;
use super::record::What;
use crate::model::blocks::syntax_diagnostic;
use crate::model::diff::{same_actions, same_block, same_modules};
use crate::model::*;
use crate::syntax::{Code, Diagnostic, Source, Span};

impl Engine {
    pub(super) fn load(&mut self, edit: Edit) {
        let old = Arc::clone(&self.program);
        let first = old.sources.is_empty();
        let comparison = edit.comparison(&old);
        let mut new = edit.program;
        let changes = if first { Vec::new() } else { comparison.changes.clone() };
        let reason = self.why_restart(&new);
        self.follow(&comparison.matching, &new);
        self.take_over_modules(&old, &new);
        for uncompiled in self.store.take_over(&old, &new, &comparison.matching) {
            let span = new[uncompiled.block].span;
            let finding = syntax_diagnostic(new.source(span), span, &uncompiled.error);
            if !new.findings.iter().any(|known| known.span == finding.span) {
                Arc::make_mut(&mut new).findings.push(finding);
            }
        }
        let still = self.faults.edited(self.now, |code, span| moved(&old, &new, code, span));
        self.plan = Rc::new(Plan::of(&new, &self.store));
        self.changes.follow(&new);
        self.program = new;
        let load = self.load_record(changes, reason.clone());
        self.rare(What::Load(load));
        still.into_iter().for_each(|fault| self.rare(What::Error(fault)));
        self.report_findings();
        match reason {
            Some(reason) => self.restart(&reason),
            None if first => self.begin(),
            None => self.apply(&old),
        }
    }

    /// The one case in which a program can't go on: what is active is gone, or would have done something else.
    fn why_restart(&self, new: &Program) -> Option<String> {
        self.tops.iter().find_map(|&machine| self.why_restart_in(machine, new))
    }

    fn why_restart_in(&self, machine: MachineId, new: &Program) -> Option<String> {
        let running = self.running[machine.index()].as_ref()?;
        let path = &self.program[machine].path;
        if new.machine(path).is_none() {
            return Some(format!("active machine {path} removed"));
        }
        let state = &self.program[running.state];
        match new.state(&state.path) {
            None => Some(format!("active state {} removed", state.path)),
            Some(now) if !same_actions(&self.program, running.state, new, now) => {
                Some(format!("active state {} changed", state.path))
            }
            Some(_) => running.nested.iter().find_map(|&nested| self.why_restart_in(nested, new)),
        }
    }

    /// From the old program's ids to the new one's; what is gone is no longer there.
    fn follow(&mut self, matching: &Matching, new: &Program) {
        let mut running: Vec<Option<Running>> = new.machines.iter().map(|_| None).collect();
        for (index, was) in self.running.iter().enumerate() {
            let Some(was) = was else { continue };
            let (Some(machine), Some(state)) = (matching.machine(MachineId(index as u32)), matching.state(was.state))
            else {
                continue;
            };
            let nested = was.nested.iter().filter_map(|&nested| matching.machine(nested)).collect();
            running[machine.index()] = Some(Running { state, entered: was.entered, nested, decided: None });
        }
        let mut visits = vec![0; new.states.len()];
        for (index, &count) in self.visits.iter().enumerate() {
            if let Some(now) = matching.state(StateId(index as u32)) {
                visits[now.index()] = count;
            }
        }
        self.tops = self.tops.iter().filter_map(|&machine| matching.machine(machine)).collect();
        self.running = running;
        self.visits = visits;
    }

    fn report_findings(&mut self) {
        let program = Arc::clone(&self.program);
        for Diagnostic { code, span, message, help, .. } in program.findings.iter().filter(|finding| finding.is_error())
        {
            let state = enclosing_path(&program, *span);
            self.fault(*code, *span, message.clone(), help.clone(), state);
        }
    }

    /// What an edit asks for where nothing has to start again.
    fn apply(&mut self, old: &Program) {
        let program = Arc::clone(&self.program);
        for var in self.to_initialise(old) {
            self.initialise(var);
        }
        let plan = Rc::clone(&self.plan);
        let mut spawned = Vec::new();
        for (index, spawn) in program.spawns.iter().enumerate() {
            if let Some((machine, state)) = spawn.target
                && !self.runs(machine)
                && !spawned_before(old, &program[machine].path)
            {
                self.spawn(&plan, machine, state, Spawner::Top { index });
                spawned.push(machine);
            }
        }
        self.order_tops();
        for machine in (0..program.machines.len()).map(|index| MachineId(index as u32)) {
            spawned.extend(self.retry_spawns(old, &plan, machine));
        }
        for machine in spawned {
            self.settle(&plan, machine);
        }
    }

    /// New variables whose scope runs, those with another initial value, and those whose initial value reads them.
    fn to_initialise(&self, old: &Program) -> Vec<VarId> {
        let program = &self.program;
        let alive: Vec<VarId> = (0..program.vars.len() as u32).map(VarId).filter(|&var| self.is_alive(var)).collect();
        let before: HashMap<&str, BlockId> = old.vars.iter().map(|var| (&*var.path, var.init)).collect();
        let mut found: Vec<bool> = vec![false; program.vars.len()];
        for &var in &alive {
            let was = before.get(&*program[var].path);
            found[var.index()] = was.is_none_or(|&was| !same_block(old, was, program, program[var].init));
        }
        let mut grown = true;
        while grown {
            grown = false;
            for &var in &alive {
                if !found[var.index()] && program[program[var].init].uses.iter().any(|read| found[read.index()]) {
                    found[var.index()] = true;
                    grown = true;
                }
            }
        }
        let locals = alive.into_iter().filter(|&var| program[var].machine.is_some());
        program.globals.iter().copied().chain(locals).filter(|var| found[var.index()]).collect()
    }

    fn order_tops(&mut self) {
        let program = Arc::clone(&self.program);
        let place = |machine: &MachineId| {
            let spawns = program.spawns.iter();
            spawns
                .map(|spawn| spawn.target)
                .position(|target| target.is_some_and(|(target, _)| target == *machine))
                .unwrap_or(usize::MAX)
        };
        self.tops.sort_by_key(place);
    }

    /// An active state's spawns that named something unknown are tried again when it exists.
    fn retry_spawns(&mut self, old: &Program, plan: &Plan, machine: MachineId) -> Vec<MachineId> {
        let program = Arc::clone(&self.program);
        let Some(state) = self.active_state(machine) else { return Vec::new() };
        let Some(was) = old.state(&program[state].path) else { return Vec::new() };
        let mut spawned = Vec::new();
        for (index, (before, after)) in (0..).zip(old[was].onentry.iter().zip(&program[state].onentry)) {
            if let (
                Entry::Spawn(Spawn { target: None, .. }),
                Entry::Spawn(Spawn { target: Some((machine, start)), .. }),
            ) = (before, after)
                && !self.runs(*machine)
            {
                self.spawn(plan, *machine, *start, Spawner::Entry { state, index });
                spawned.push(*machine);
            }
        }
        self.order_nested(machine, state);
        spawned
    }

    /// Nested machines take their steps in the order of the spawn statements, however late one succeeded.
    fn order_nested(&mut self, machine: MachineId, state: StateId) {
        let items = &self.program[state].onentry;
        let spawns =
            |item: &Entry, machine| matches!(item, Entry::Spawn(Spawn { target: Some((it, _)), .. }) if *it == machine);
        let place = |machine: &MachineId| items.iter().position(|item| spawns(item, *machine)).unwrap_or(usize::MAX);
        if let Some(running) = &mut self.running[machine.index()] {
            running.nested.sort_by_key(place);
        }
    }
}

fn spawned_before(old: &Program, machine: &str) -> bool {
    old.spawns.iter().filter_map(|spawn| spawn.target).any(|(target, _)| &*old[target].path == machine)
}

/// Where a fault of the old program stands in the new one, when it is a block's and the block is the same.
fn moved(old: &Program, new: &Program, code: Code, span: Span) -> Option<(Span, Source)> {
    let happens_while_running =
        matches!(code, Code::Runtime | Code::NotBoolean | Code::OverTime | Code::OverMemory | Code::NotMilliseconds);
    if code == Code::AlreadyRunning {
        let now = spawn_moved(old, new, span)?;
        return Some((now, new.source(now).clone()));
    }
    let holds =
        |block: &&Block| block.span.file == span.file && block.span.start <= span.start && span.end <= block.span.end;
    let was = old.blocks.iter().find(holds).filter(|_| happens_while_running)?;
    let owner = old.owner_path_of(was);
    let twins = |program: &Program| -> Vec<Span> {
        let same = |block: &&Block| {
            block.code == was.code
                && program.owner_path_of(block) == owner
                && same_modules(old, &was.requires, program, &block.requires)
        };
        program.blocks.iter().filter(same).map(|block| block.span).collect()
    };
    let nth = twins(old).iter().position(|&span| span == was.span)?;
    let now = *twins(new).get(nth)?;
    let offset = (span.start - was.span.start) as usize;
    let start = now.start as usize + offset;
    let span = Span::new(now.file, start, start + (span.end - span.start) as usize);
    Some((span, new.source(span).clone()))
}

/// Where the spawn of a place in the old program stands in the new one.
fn spawn_moved(old: &Program, new: &Program, span: Span) -> Option<Span> {
    let spawns = |program: &Program| -> Vec<(Arc<str>, Spawn)> {
        let entries = program
            .states
            .iter()
            .flat_map(|state| state.onentry.iter().map(|entry| (state.path.clone(), entry.clone())));
        let nested = entries.filter_map(|(state, entry)| match entry {
            Entry::Spawn(spawn) => Some((state, spawn)),
            Entry::Action(_) => None,
        });
        let tops = program.spawns.iter().map(|spawn| (Arc::default(), spawn.clone()));
        tops.chain(nested).collect()
    };
    let (state, was) = spawns(old).into_iter().find(|(_, spawn)| spawn.span == span)?;
    let same = |it: &Spawn| it.machine_name == was.machine_name && it.state_name == was.state_name;
    spawns(new).into_iter().find(|(at, spawn)| *at == state && same(spawn)).map(|(_, spawn)| spawn.span)
}

/// The innermost state or machine that a place lies in.
fn enclosing_path(program: &Program, span: Span) -> Arc<str> {
    let around = |outer: Span| outer.file == span.file && outer.start <= span.start && span.end <= outer.end;
    let machines = program.machines.iter().map(|machine| (machine.span, &machine.path));
    let states = program.states.iter().map(|state| (state.span, &state.path));
    let innermost =
        machines.chain(states).filter(|(outer, _)| around(*outer)).min_by_key(|(outer, _)| outer.end - outer.start);
    innermost.map(|(_, path)| path.clone()).unwrap_or_default()
}
