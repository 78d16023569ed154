//! What transitions are called, as they have no names of their own: in lists of changes, as places of breakpoints, and in
//! sentences. A name is for reading: whether two transitions are the same is for the matching to say.

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

use super::ids::*;
use super::program::*;
use super::suggestion::listed;

/// The transitions of a machine in their order: `follower: on bumping * -> bumpback`; of equal ones the second ends with
/// `#2`.
pub fn transition_names(program: &Program, machine: MachineId) -> impl Iterator<Item = (TransitionId, Arc<str>)> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    program[machine].transitions.iter().map(move |&id| {
        let name = full(program, &program[id]);
        let nth = seen.entry(name.clone()).and_modify(|earlier| *earlier += 1).or_insert(1);
        (id, if *nth == 1 { name.into() } else { format!("{name} #{nth}").into() })
    })
}

/// The names of a program's transitions, made up for one machine at a time as they are asked for.
pub struct TransitionNames<'p> {
    program: &'p Program,
    known: RefCell<HashMap<TransitionId, Arc<str>>>,
}

impl<'p> TransitionNames<'p> {
    pub fn of(program: &'p Program) -> Self {
        TransitionNames { program, known: RefCell::default() }
    }

    pub fn name(&self, id: TransitionId) -> Arc<str> {
        let mut known = self.known.borrow_mut();
        if !known.contains_key(&id) {
            known.extend(transition_names(self.program, self.program[id].machine));
        }
        known[&id].clone()
    }

    pub fn called(&self, name: &str) -> Option<TransitionId> {
        let machines = self.program.machines.iter().zip(0..);
        let mut its = machines
            .filter(|(machine, _)| name.strip_prefix(&*machine.path).is_some_and(|rest| rest.starts_with(": ")));
        its.find_map(|(_, index)| {
            let mut names = transition_names(self.program, MachineId(index));
            names.find(|(_, known)| **known == *name).map(|(id, _)| id)
        })
    }

    pub fn all(&self) -> Vec<Arc<str>> {
        (0..self.program.transitions.len() as u32).map(|index| self.name(TransitionId(index))).collect()
    }
}

fn full(program: &Program, transition: &Transition) -> String {
    let said = said(transition, &trigger_text(program, &transition.trigger), |names| names.join(" "));
    let name = transition.name.as_ref().map(|name| format!(" {name}")).unwrap_or_default();
    format!("{}: {said}{name}", program[transition.machine].path)
}

/// In a sentence: `(on stop (a b) -> c)`
pub fn spelled(program: &Program, id: TransitionId) -> String {
    let transition = &program[id];
    let trigger = match &transition.trigger {
        Trigger::Block(_) | Trigger::AfterBlock(_) => "[..]".to_string(),
        other => trigger_text(program, other),
    };
    format!("({})", said(transition, &trigger, |names| listed(names).replace(", ", " ")))
}

fn said(transition: &Transition, trigger: &str, row: impl Fn(&[&str]) -> String) -> String {
    let sources = match &transition.sources {
        Sources::Any => "*".to_string(),
        Sources::These { names, .. } if names.len() == 1 => names[0].to_string(),
        Sources::These { names, .. } => format!("({})", row(&names.iter().map(|name| &**name).collect::<Vec<_>>())),
    };
    let space = if trigger.is_empty() { "" } else { " " };
    format!("{} {trigger}{space}{sources} -> {}", transition.kind.form(), transition.target_name)
}

/// As written: an event's name, a number or variable of milliseconds, a block in its brackets; nothing for eps.
pub fn trigger_text(program: &Program, trigger: &Trigger) -> String {
    match trigger {
        Trigger::Always => String::new(),
        Trigger::Event(event) => program[*event].name.to_string(),
        Trigger::UnknownEvent(name) | Trigger::AfterUnknown(name) => name.to_string(),
        Trigger::After(ms) => ms.to_string(),
        Trigger::AfterVar(var) => program[*var].name.to_string(),
        Trigger::Block(block) | Trigger::AfterBlock(block) => {
            let words: Vec<&str> = program[*block].code.split_whitespace().collect();
            format!("[{}]", words.join(" "))
        }
    }
}
