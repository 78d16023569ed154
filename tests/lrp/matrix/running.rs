//! How a tree runs, as design section 2 has it: the part of the language that the matrix uses, in whole numbers.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::outline::Outline;
use super::tree::*;

#[derive(Clone)]
pub struct Running {
    pub tree: Rc<Tree>,
    /// Program time, ms.
    pub now: i64,
    /// In the order of the spawn statements.
    pub tops: Vec<Id>,
    pub machines: BTreeMap<Id, At>,
    /// None: it has no value that counts.
    pub values: BTreeMap<Id, Option<i64>>,
    pub visits: BTreeMap<Id, u64>,
}

/// Where a machine is.
#[derive(Clone, Debug)]
pub struct At {
    pub state: Id,
    pub entered: i64,
    pub nested: Vec<Id>,
    /// The state that spawned it.
    pub by: Option<Id>,
    /// The state it was spawned in.
    pub began: Id,
}

impl Running {
    pub fn new(tree: Tree) -> Running {
        let (machines, values, visits) = Default::default();
        let mut running = Running { tree: Rc::new(tree), now: 0, tops: Vec::new(), machines, values, visits };
        running.begin();
        running
    }

    /// From scratch.
    pub fn begin(&mut self) {
        let tree = Rc::clone(&self.tree);
        let outline = Outline::of(&tree);
        (self.machines, self.values, self.visits) = Default::default();
        self.tops.clear();
        for var in &tree.vars {
            self.initialise(&outline, var, None);
        }
        for top in &tree.spawns {
            if let Some((machine, state)) = outline.spawned(&top.spawn, None) {
                self.spawn(&outline, machine, state, None);
            }
        }
        for top in self.tops.clone() {
            self.settle(&outline, top);
        }
    }

    pub fn initialise(&mut self, outline: &Outline, var: &Var, scope: Option<Id>) {
        let of = var.init.of.iter().map(|name| self.value(outline, name, scope));
        let sum = of.sum::<Option<i64>>();
        self.values.insert(var.id, sum.map(|sum| sum + var.init.and));
    }

    fn value(&self, outline: &Outline, name: &str, scope: Option<Id>) -> Option<i64> {
        let at = outline.var(name, scope)?;
        self.values.get(&at.var.id).copied().flatten()
    }

    pub fn spawn(&mut self, outline: &Outline, machine: Id, state: Id, by: Option<Id>) {
        if self.machines.contains_key(&machine) {
            return;
        }
        match by {
            None => self.tops.push(machine),
            Some(by) => self.machines.get_mut(&outline.states[&by].of).expect("it runs").nested.push(machine),
        }
        self.start(outline, machine, state, by);
    }

    /// Where it stands among the others is known.
    pub fn start(&mut self, outline: &Outline, machine: Id, state: Id, by: Option<Id>) {
        let at = At { state, entered: self.now, nested: Vec::new(), by, began: state };
        self.machines.insert(machine, at);
        for var in &outline.machines[&machine].machine.vars {
            self.initialise(outline, var, Some(machine));
        }
        self.enter(outline, machine, state);
    }

    fn enter(&mut self, outline: &Outline, machine: Id, id: Id) {
        let at = self.machines.get_mut(&machine).expect("it runs");
        (at.state, at.entered) = (id, self.now);
        *self.visits.entry(id).or_default() += 1;
        let state = outline.states[&id].state;
        self.act(outline, &state.onentry, machine);
        for spawn in &state.spawns {
            if let Some((machine, start)) = outline.spawned(spawn, Some(id)) {
                self.spawn(outline, machine, start, Some(id));
            }
        }
    }

    fn act(&mut self, outline: &Outline, actions: &[Action], scope: Id) {
        actions.iter().for_each(|action| self.do_one(outline, action, Some(scope)));
    }

    /// Costs itself alone where its variable isn't there or has no value.
    pub fn do_one(&mut self, outline: &Outline, action: &Action, scope: Option<Id>) {
        let Some(at) = outline.var(&action.var, scope) else { return };
        if let Some(Some(value)) = self.values.get_mut(&at.var.id) {
            *value = match action.does {
                Does::Add(n) => *value + n,
                Does::Double => *value * 2,
            };
        }
    }

    pub fn step(&mut self, now: i64) {
        self.now = now;
        let tree = Rc::clone(&self.tree);
        let outline = Outline::of(&tree);
        for top in self.tops.clone() {
            self.step_machine(&outline, top);
        }
    }

    fn step_machine(&mut self, outline: &Outline, machine: Id) {
        if let Some(to) = self.firing(outline, machine) {
            self.go(outline, machine, to);
            self.settle(outline, machine);
            return;
        }
        self.act(outline, &outline.states[&self.machines[&machine].state].state.running, machine);
        for nested in self.machines[&machine].nested.clone() {
            self.step_machine(outline, nested);
        }
    }

    /// As a transition does, or someone by hand.
    pub fn go(&mut self, outline: &Outline, machine: Id, to: Id) {
        self.leave(outline, machine);
        self.discard_nested(outline, machine);
        self.enter(outline, machine, to);
    }

    /// Right after an entry: the state begins to run, unless it is left in the next step.
    pub fn settle(&mut self, outline: &Outline, machine: Id) {
        if self.firing(outline, machine).is_some() {
            return;
        }
        self.act(outline, &outline.states[&self.machines[&machine].state].state.running, machine);
        for nested in self.machines[&machine].nested.clone() {
            self.settle(outline, nested);
        }
    }

    fn leave(&mut self, outline: &Outline, machine: Id) {
        let at = self.machines[&machine].clone();
        at.nested.iter().for_each(|&nested| self.leave(outline, nested));
        self.act(outline, &outline.states[&at.state].state.onexit, machine);
    }

    pub fn discard_nested(&mut self, outline: &Outline, machine: Id) {
        let nested = self.machines.get_mut(&machine).map(|at| std::mem::take(&mut at.nested));
        nested.unwrap_or_default().into_iter().for_each(|nested| self.discard(outline, nested));
    }

    pub fn discard(&mut self, outline: &Outline, machine: Id) {
        self.discard_nested(outline, machine);
        self.machines.remove(&machine);
        for at in outline.vars.iter().filter(|at| at.of == Some(machine)) {
            self.values.remove(&at.var.id);
        }
    }

    /// The machine's own transitions, then exits of machines written in its state.
    fn firing(&self, outline: &Outline, machine: Id) -> Option<Id> {
        let at = &self.machines[&machine];
        let to = |it: &Transition| outline.state(&it.to, machine).map(|state| state.id);
        let own = outline.machines[&machine].machine.transitions.iter();
        let own = own.filter(|it| !it.is_exit());
        let own = own.filter(|it| self.holds(outline, it, machine)).find_map(to);
        let inside = || outline.states[&at.state].state.machines.iter().filter(|it| self.machines.contains_key(&it.id));
        let exits = inside().flat_map(|inner| inner.transitions.iter().map(|it| (inner.id, it)));
        let mut exits = exits.filter(|(_, it)| it.is_exit());
        own.or_else(|| exits.find_map(|(inner, it)| self.holds(outline, it, inner).then(|| to(it)).flatten()))
    }

    fn holds(&self, outline: &Outline, transition: &Transition, machine: Id) -> bool {
        let at = &self.machines[&machine];
        outline.state(&transition.from, machine).is_some_and(|from| from.id == at.state)
            && match &transition.trigger {
                Trigger::Eps => true,
                Trigger::After(ms) => self.now - at.entered >= *ms,
                Trigger::Block(over) | Trigger::Exit(over) => self.is_over(outline, over, machine),
                Trigger::Event(name) => {
                    outline.event(name, machine).is_some_and(|event| self.is_over(outline, &event.event.when, event.of))
                }
            }
    }

    fn is_over(&self, outline: &Outline, over: &Over, scope: Id) -> bool {
        self.value(outline, &over.var, Some(scope)).is_some_and(|value| value > over.limit)
    }
}
