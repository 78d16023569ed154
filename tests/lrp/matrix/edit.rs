//! What an edit does to what runs, as design section 3 has it.

use std::collections::BTreeSet;
use std::rc::Rc;

use lrp::runtime::OnEdit;
use lrp::runtime::record::Change;

use super::comparison::Comparison;
use super::outline::Outline;
use super::running::Running;
use super::tree::*;

/// What the record of a load is to say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// In the order of their kinds and paths.
    pub changes: Vec<Change>,
    pub reason: Option<String>,
    pub again: Vec<String>,
    pub discarded: Vec<String>,
}

/// What becomes of a machine.
enum Fate {
    Goes,
    Again,
}

impl Running {
    pub fn edit(&mut self, tree: Tree, mode: OnEdit) -> Verdict {
        let comparison = Comparison::of(&self.tree, &tree);
        let (before, after) = (std::mem::replace(&mut self.tree, Rc::new(tree)), Rc::clone(&self.tree));
        let (before, after) = (&Outline::of(&before), &Outline::of(&after));
        let mut verdict = Verdict::default();
        if mode == OnEdit::Restart {
            verdict.reason = self.tops.iter().find_map(|&top| self.reason(&comparison, before, after, top));
        }
        if verdict.reason.is_some() {
            self.begin();
        } else {
            self.take_over(&comparison, before, after, mode, &mut verdict);
        }
        verdict.changes = comparison.changes();
        verdict
    }

    /// Why all begins again, because of a machine or those inside it.
    fn reason(&self, comparison: &Comparison, before: &Outline, after: &Outline, machine: Id) -> Option<String> {
        let at = &self.machines[&machine];
        let path = &before.states[&at.state].path;
        if !after.machines.contains_key(&machine) {
            return Some(format!("active machine {} removed", before.machines[&machine].path));
        }
        if !after.states.contains_key(&at.state) {
            return Some(format!("active state {path} removed"));
        }
        if !comparison.same(at.state) {
            return Some(format!("active state {path} changed"));
        }
        at.nested.iter().find_map(|&nested| self.reason(comparison, before, after, nested))
    }

    fn take_over(
        &mut self,
        comparison: &Comparison,
        before: &Outline,
        after: &Outline,
        mode: OnEdit,
        verdict: &mut Verdict,
    ) {
        self.visits.retain(|state, _| after.states.contains_key(state));
        let mut fates = Vec::new();
        if mode == OnEdit::Keep {
            for top in self.tops.clone() {
                self.fates(comparison, after, top, &mut fates);
            }
        }
        let mut again = Vec::new();
        for (machine, fate) in fates {
            self.discard_nested(before, machine);
            let to = match fate {
                Fate::Goes => None,
                Fate::Again => self.start_state(after, machine),
            };
            match to {
                Some(state) => {
                    verdict.again.push(after.machines[&machine].path.clone());
                    again.push((machine, state));
                }
                None => {
                    verdict.discarded.push(before.machines[&machine].path.clone());
                    self.discard(before, machine);
                }
            }
        }
        self.tops.retain(|top| self.machines.contains_key(top));
        let running: BTreeSet<Id> = self.machines.keys().copied().collect();
        self.machines.values_mut().for_each(|at| at.nested.retain(|nested| running.contains(nested)));
        self.take_variables(comparison, before, after, &again);
        let mut fresh = Vec::new();
        for &(machine, state) in &again {
            let by = self.machines[&machine].by;
            self.start(after, machine, state, by);
            fresh.push(machine);
        }
        fresh.extend(self.spawn_missing(before, after, &fresh));
        fresh.into_iter().for_each(|machine| self.settle(after, machine));
    }

    fn fates(&self, comparison: &Comparison, after: &Outline, machine: Id, fates: &mut Vec<(Id, Fate)>) {
        let at = &self.machines[&machine];
        if !after.machines.contains_key(&machine) {
            fates.push((machine, Fate::Goes));
        } else if !after.states.contains_key(&at.state) || !comparison.same_spawns(at.state) {
            fates.push((machine, Fate::Again));
        } else {
            at.nested.iter().for_each(|&nested| self.fates(comparison, after, nested, fates));
        }
    }

    /// What the spawn that runs a machine says now; without one, the state it was last started in.
    fn start_state(&self, after: &Outline, machine: Id) -> Option<Id> {
        let at = &self.machines[&machine];
        let spawns: Vec<&Spawn> = match at.by {
            None => after.tree.spawns.iter().map(|top| &top.spawn).collect(),
            Some(by) => after.states.get(&by).map(|by| by.state.spawns.iter().collect()).unwrap_or_default(),
        };
        match spawns.into_iter().find(|spawn| after.machine(&spawn.machine, at.by) == Some(machine)) {
            Some(spawn) => after.state(&spawn.state, machine).map(|state| state.id),
            None => Some(at.began).filter(|state| after.states.contains_key(state)),
        }
    }

    /// Changed and new ones of what runs on, and those whose initial values read them.
    fn take_variables(&mut self, comparison: &Comparison, before: &Outline, after: &Outline, again: &[(Id, Id)]) {
        self.values.retain(|&id, _| after.vars.iter().any(|at| at.var.id == id));
        let mut touched = BTreeSet::new();
        for at in &after.vars {
            let lives = at.of.is_none_or(|of| self.machines.contains_key(&of));
            if !lives || again.iter().any(|&(machine, _)| Some(machine) == at.of) {
                continue;
            }
            let known = before.vars.iter().any(|old| old.var.id == at.var.id);
            let reads = |name: &String| after.var(name, at.of).is_some_and(|read| touched.contains(&read.var.id));
            if !known || !comparison.same(at.var.id) || at.var.init.of.iter().any(reads) {
                self.initialise(after, at.var, at.of);
                touched.insert(at.var.id);
            }
        }
    }

    /// New spawn statements at top level, and spawns of active states that failed before.
    fn spawn_missing(&mut self, before: &Outline, after: &Outline, fresh: &[Id]) -> Vec<Id> {
        let mut spawned = Vec::new();
        for top in &after.tree.spawns {
            let old = before.tree.spawns.iter().find(|old| old.id == top.id);
            let failed = old.is_none_or(|old| before.spawned(&old.spawn, None).is_none());
            if let Some((machine, state)) = after.spawned(&top.spawn, None).filter(|_| failed)
                && !self.machines.contains_key(&machine)
            {
                self.spawn(after, machine, state, None);
                spawned.push(machine);
            }
        }
        let active = self.machines.iter().filter(|(machine, _)| !fresh.contains(machine)).map(|(_, at)| at.state);
        for state in active.collect::<Vec<_>>() {
            let Some(old) = before.states.get(&state) else { continue };
            for (old, new) in old.state.spawns.iter().zip(&after.states[&state].state.spawns) {
                let failed = before.spawned(old, Some(state)).is_none();
                if let Some((machine, start)) = after.spawned(new, Some(state)).filter(|_| failed)
                    && !self.machines.contains_key(&machine)
                {
                    self.spawn(after, machine, start, Some(state));
                    spawned.push(machine);
                }
            }
        }
        self.sort_tops(after);
        spawned
    }

    /// A step visits the machines in the order of the spawn statements.
    fn sort_tops(&mut self, after: &Outline) {
        let place = |&top: &Id| {
            let named = |it: &TopSpawn| after.machine(&it.spawn.machine, None) == Some(top);
            after.tree.spawns.iter().position(named).unwrap_or(usize::MAX)
        };
        self.tops.sort_by_key(place);
    }
}
