//! Where a program can pause: the states and transitions with a `(break)`, what such places are called, and where they
//! are after an edit. Knows nothing of pausing.

use std::cell::OnceCell;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::change::{Change, Element, Op};
use super::diff::{same_block, transition_key};
use super::ids::*;
use super::matching::Matching;
use super::program::*;

/// A state that is entered, or a transition that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Spot {
    State(StateId),
    Transition(TransitionId),
}

impl Spot {
    /// Whether a `(break)` stands there.
    pub fn is_in_source(self, program: &Program) -> bool {
        match self {
            Spot::State(state) => program[state].breakpoint.is_some(),
            Spot::Transition(transition) => program[transition].breakpoint.is_some(),
        }
    }
}

/// All with a `(break)`: states, then transitions.
pub fn in_source(program: &Program) -> impl Iterator<Item = Spot> + '_ {
    let states = (0..program.states.len() as u32).map(|index| Spot::State(StateId(index)));
    let transitions = (0..program.transitions.len() as u32).map(|index| Spot::Transition(TransitionId(index)));
    states.chain(transitions).filter(|spot| spot.is_in_source(program))
}

/// What spots are called: a state by its path, a transition as lists of changes name it.
pub struct SpotNames<'p> {
    program: &'p Program,
    transitions: OnceCell<Vec<Arc<str>>>,
}

impl<'p> SpotNames<'p> {
    pub fn of(program: &'p Program) -> Self {
        SpotNames { program, transitions: OnceCell::new() }
    }

    pub fn name(&self, spot: Spot) -> Arc<str> {
        match spot {
            Spot::State(state) => self.program[state].path.clone(),
            Spot::Transition(transition) => self.transitions()[transition.index()].clone(),
        }
    }

    /// By id: `follower: on bumping * -> bumpback`; of equal ones the second ends with `#2`.
    pub fn transitions(&self) -> &[Arc<str>] {
        self.transitions.get_or_init(|| {
            let mut seen: HashMap<String, usize> = HashMap::new();
            let mut name = |transition| {
                let key = transition_key(self.program, transition);
                let earlier = seen.entry(key.clone()).or_insert(0);
                *earlier += 1;
                if *earlier == 1 { key.into() } else { format!("{key} #{earlier}").into() }
            };
            self.program.transitions.iter().map(&mut name).collect()
        })
    }

    pub fn transition_called(&self, name: &str) -> Option<TransitionId> {
        let index = self.transitions().iter().position(|known| **known == *name)?;
        Some(TransitionId(index as u32))
    }
}

/// Where the spots of one program are in the next.
pub struct Following<'p> {
    old: &'p Program,
    new: &'p Program,
    matching: &'p Matching,
    names: SpotNames<'p>,
    now: OnceCell<HashMap<Arc<str>, TransitionId>>,
}

impl<'p> Following<'p> {
    pub fn new(old: &'p Program, new: &'p Program, matching: &'p Matching) -> Self {
        Following { old, new, matching, names: SpotNames::of(old), now: OnceCell::new() }
    }

    pub fn spot(&self, spot: Spot) -> Option<Spot> {
        match spot {
            Spot::State(state) => self.matching.state(state).map(Spot::State),
            Spot::Transition(transition) => self.transition(transition).map(Spot::Transition),
        }
    }

    /// Of the same name, or the same but for what was renamed.
    fn transition(&self, id: TransitionId) -> Option<TransitionId> {
        let machine = self.matching.machine(self.old[id].machine)?;
        let name = &self.names.transitions()[id.index()];
        let named = self.now().get(name).copied().filter(|&now| self.new[now].machine == machine);
        let same = |&other: &TransitionId| self.is_same(&self.old[id], &self.new[other]);
        named.or_else(|| self.new[machine].transitions.iter().copied().find(same))
    }

    fn now(&self) -> &HashMap<Arc<str>, TransitionId> {
        self.now.get_or_init(|| {
            let names = SpotNames::of(self.new);
            let ids = (0..).map(TransitionId);
            names.transitions().iter().cloned().zip(ids).collect()
        })
    }

    fn is_same(&self, a: &Transition, b: &Transition) -> bool {
        let same_target = match (a.target, b.target) {
            (Some(a), Some(b)) => self.matching.state(a) == Some(b),
            (None, None) => a.target_name == b.target_name,
            _ => false,
        };
        let same_sources = match (&a.sources, &b.sources) {
            (Sources::Any, Sources::Any) => true,
            (Sources::These { states: a, names: all_a }, Sources::These { states: b, names: all_b }) => {
                let followed = a.iter().map(|&state| self.matching.state(state));
                all_a.len() == all_b.len() && followed.eq(b.iter().copied().map(Some))
            }
            _ => false,
        };
        a.kind == b.kind && a.name == b.name && same_target && same_sources && self.same_trigger(&a.trigger, &b.trigger)
    }

    fn same_trigger(&self, a: &Trigger, b: &Trigger) -> bool {
        match (a, b) {
            (Trigger::Event(a), Trigger::Event(b)) => self.matching.event(*a) == Some(*b),
            (Trigger::AfterVar(a), Trigger::AfterVar(b)) => self.matching.var(*a) == Some(*b),
            (Trigger::Block(a), Trigger::Block(b)) | (Trigger::AfterBlock(a), Trigger::AfterBlock(b)) => {
                same_block(self.old, *a, self.new, *b, self.matching)
            }
            (a, b) => a == b,
        }
    }
}

/// How the `(break)`s of two programs differ; nothing else about their elements changes with them.
pub fn changes(old: &Program, new: &Program, matching: &Matching) -> Vec<Change> {
    let (was, now) = (SpotNames::of(old), SpotNames::of(new));
    let following = Following::new(old, new, matching);
    let change = |op, path| Change { op, kind: Element::Breakpoint, path, to: None };
    let mut kept = HashSet::new();
    let mut changes = Vec::new();
    for spot in in_source(old) {
        match following.spot(spot).filter(|now| now.is_in_source(new)) {
            Some(now) => drop(kept.insert(now)),
            None => changes.push(change(Op::Removed, was.name(spot))),
        }
    }
    let added = in_source(new).filter(|spot| !kept.contains(spot));
    changes.extend(added.map(|spot| change(Op::Added, now.name(spot))));
    changes
}
