//! Breakpoints set in a walk: where they have to be after an edit, going by texts and names alone.

use std::collections::{BTreeMap, BTreeSet};

use lrp::model::transition_names::TransitionNames;
use lrp::model::{Program, TransitionId};
use lrp::runtime::record::{Load, Op, Setter};
use lrp::runtime::{BreakAt, Breaking, Command, Engine};
use lrp::ui::view::{name, owner};

use super::kept::called;
use crate::plot::Choices;

/// Conditions with locals and keys that are called like the variable, which is `@`.
const CONDITIONS: [&str; 3] =
    ["({ NAME = 1 }).NAME == @", "(function(NAME) return NAME end)(2) == @", "(function(k) return k == @ end)(3)"];

/// A condition as it was set, and its variable by path.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    pattern: String,
    var: String,
}

impl Watched {
    pub fn draw(choices: &mut Choices, program: &Program) -> Option<Watched> {
        let var = choices.of(&program.vars)?;
        let pattern = choices.of(&CONDITIONS)?.replace("NAME", &var.name);
        Some(Watched { pattern, var: var.path.to_string() })
    }

    fn at(&self) -> BreakAt {
        let condition = self.pattern.replace('@', name(&self.var)).into();
        BreakAt::Condition { condition, machine: owner(&self.var).unwrap_or_default().into() }
    }

    pub fn set(&self) -> Command {
        Command::Break { at: self.at(), mode: Breaking::Set }
    }

    pub fn is_set(&self, engine: &Engine) -> bool {
        engine.breakpoints().iter().any(|it| it.at == self.at())
    }

    /// By the name that its variable has after an edit; nothing where that is gone.
    pub fn follow(&self, load: &Load, program: &Program) -> Option<Watched> {
        let var = called(load, &self.var);
        let is_there = program.vars.iter().any(|it| *it.path == *var);
        is_there.then(|| Watched { var, ..self.clone() })
    }
}

pub fn set_at_transition(choices: &mut Choices, program: &Program) -> Option<Command> {
    let id = TransitionId(choices.below(program.transitions.len()) as u32);
    let there = program.transitions.get(id.0 as usize)?;
    let transition = TransitionNames::of(program).name(id);
    let command = Command::Break { at: BreakAt::Transition { transition }, mode: Breaking::Set };
    there.breakpoint.is_none().then_some(command)
}

/// A transition is its machine, its text, and how many equal ones stand before it.
type Written = (String, String, usize);

/// All there are without a `(break)`, and those that were broken at by command.
pub struct AtTransitions {
    all: BTreeSet<Written>,
    set: BTreeSet<Written>,
    /// Some uses say the old name of what was renamed: their text changes when the rename is finished, and nothing else.
    is_halfway: bool,
}

impl AtTransitions {
    pub fn of(engine: &Engine) -> AtTransitions {
        let program = engine.program();
        let names = TransitionNames::of(program);
        let told = engine.breakpoints().iter().filter(|it| it.by == Setter::Command);
        let told: BTreeSet<TransitionId> = told
            .filter_map(|it| match &it.at {
                BreakAt::Transition { transition } => names.called(transition),
                _ => None,
            })
            .collect();
        let mut seen: BTreeMap<(String, String), usize> = BTreeMap::new();
        let (mut all, mut set) = (BTreeSet::new(), BTreeSet::new());
        for (index, transition) in program.transitions.iter().enumerate() {
            let text = program.source(transition.span).slice(transition.span);
            let text = text.replace(" (break))", ")");
            let machine = program[transition.machine].path.to_string();
            let nth = seen.entry((machine.clone(), text.clone())).or_insert(0);
            let written = (machine, text, *nth);
            *nth += 1;
            if transition.breakpoint.is_some() {
                continue;
            }
            if told.contains(&TransitionId(index as u32)) {
                set.insert(written.clone());
            }
            all.insert(written);
        }
        AtTransitions { all, set, is_halfway: program.alias.is_some() }
    }

    /// What is written as before is broken at as before, and nothing else.
    pub fn check(&self, after: &AtTransitions, load: &Load) -> Result<(), String> {
        let is_rename = load.changes.iter().any(|change| change.op == Op::Renamed);
        if is_rename || self.is_halfway {
            let alone = load.changes.len() == usize::from(is_rename);
            return match alone && self.set.len() != after.set.len() {
                true => Err(format!("{:?} became {:?}", self.set, after.set)),
                false => Ok(()),
            };
        }
        let stay = |set: &BTreeSet<Written>| -> BTreeSet<Written> {
            set.iter().filter(|it| self.all.contains(*it) && after.all.contains(*it)).cloned().collect()
        };
        let (was, now) = (stay(&self.set), stay(&after.set));
        match was == now && after.set.is_subset(&self.all) {
            true => Ok(()),
            false => Err(format!("breakpoints at {was:?} became {:?}", after.set)),
        }
    }
}
