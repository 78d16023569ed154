//! A program's machine as the graph to draw: states in source order, the wildcard source last, edges labelled.

use super::glyphs;
use super::graph::{Edge, EdgeKind, Graph, Nested, Node, NodeKind};
use crate::model::transition_names::trigger_text;
use crate::model::{Entry, MachineId, Program, Sources, StateId, Transition, TransitionKind, Trigger};

/// Columns of a block's text in a label.
const BLOCK_WIDTH: usize = 24;

pub fn graph(program: &Program, machine: MachineId) -> Graph {
    let states = &program[machine].states;
    let mut nodes: Vec<Node> = states.iter().map(|&state| node(program, state)).collect();
    let index = |state: StateId| states.iter().position(|&known| known == state);
    let mut edges = Vec::new();
    for (id, &transition) in program[machine].transitions.iter().enumerate() {
        let transition = &program[transition];
        let Some(to) = transition.target.filter(|_| transition.kind != TransitionKind::Exit).and_then(index) else {
            continue;
        };
        let mut edge = |from| {
            edges.push(Edge { from, to, label: label(program, transition), kind: kind(transition), id: id as u32 })
        };
        match &transition.sources {
            Sources::Any => edge(states.len()),
            Sources::These { states, .. } => states.iter().filter_map(|&state| index(state)).for_each(edge),
        }
    }
    for exit in states.iter().flat_map(|&state| program[state].exits.iter().map(move |&exit| (state, exit))) {
        let (from, exit) = (exit.0, &program[exit.1]);
        let ends = (index(from), exit.target.and_then(index));
        if let (Some(from), Some(to)) = ends {
            // Ids of exits lie beyond those of the machine's own transitions.
            edges.push(Edge { from, to, label: label(program, exit), kind: EdgeKind::Exit, id: EXIT });
        }
    }
    if edges.iter().any(|edge| edge.from == states.len()) {
        nodes.push(Node { name: "*".to_string(), kind: NodeKind::Any, inside: None });
    }
    Graph { nodes, edges }
}

/// The id of edges that are exits of nested machines.
pub const EXIT: u32 = u32::MAX;

fn node(program: &Program, state: StateId) -> Node {
    let longest = |machine: MachineId| {
        let names = program[machine].states.iter().map(|&state| &*program[state].name);
        names.max_by_key(|name| name.chars().count()).unwrap_or("")
    };
    let longest: Vec<&str> = spawned(program, state).into_iter().map(longest).collect();
    Node {
        name: program[state].name.to_string(),
        kind: NodeKind::State,
        inside: (!longest.is_empty()).then(|| longest.join(BESIDE)),
    }
}

/// Between the names of states that are active beside each other inside a state.
pub const BESIDE: &str = ", ";

/// The machines that a state spawns, each once.
pub fn spawned(program: &Program, state: StateId) -> Vec<MachineId> {
    let spawns = program[state].onentry.iter().filter_map(|entry| match entry {
        Entry::Spawn(spawn) => spawn.target.map(|(machine, _)| machine),
        Entry::Action(_) => None,
    });
    once(spawns)
}

/// The machines that are spawned where this one is, itself among them: they run beside each other.
pub fn beside(program: &Program, machine: MachineId) -> Vec<MachineId> {
    let tops = once(program.spawns.iter().filter_map(|spawn| spawn.target.map(|(machine, _)| machine)));
    let states = (0..program.states.len() as u32).map(|state| spawned(program, StateId(state)));
    let mut groups = std::iter::once(tops).chain(states);
    groups.find(|group| group.contains(&machine)).unwrap_or_else(|| vec![machine])
}

fn once(machines: impl Iterator<Item = MachineId>) -> Vec<MachineId> {
    machines.fold(Vec::new(), |mut known, machine| {
        if !known.contains(&machine) {
            known.push(machine);
        }
        known
    })
}

fn kind(transition: &Transition) -> EdgeKind {
    match (transition.kind, &transition.sources) {
        (TransitionKind::Exit, _) => EdgeKind::Exit,
        (_, Sources::Any) => EdgeKind::Wildcard,
        (TransitionKind::On, _) => EdgeKind::On,
        (TransitionKind::Eps, _) => EdgeKind::Eps,
        (TransitionKind::Ontime, _) => EdgeKind::Ontime,
    }
}

/// The transition's name, or else what triggers it: `outofline`, `500ms`, `eps`, the beginning of a block.
pub fn label(program: &Program, transition: &Transition) -> String {
    if let Some(name) = &transition.name {
        return name.to_string();
    }
    let text = trigger_text(program, &transition.trigger);
    match transition.trigger {
        Trigger::Always => "eps".to_string(),
        Trigger::After(_) => format!("{text}ms"),
        Trigger::AfterVar(_) | Trigger::AfterUnknown(_) | Trigger::AfterBlock(_) => format!("{} ms", shortened(&text)),
        _ => shortened(&text),
    }
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(BLOCK_WIDTH) {
        Some((end, _)) => format!("{}{}", &text[..end], glyphs::ELLIPSIS),
        None => text.to_string(),
    }
}

/// A machine with the machines that are written in its states or spawned by them. Each is shown once.
pub fn nested(program: &Program, machine: MachineId) -> Nested {
    nested_in(program, machine, &mut vec![machine])
}

fn nested_in(program: &Program, machine: MachineId, shown: &mut Vec<MachineId>) -> Nested {
    let mut children = Vec::new();
    for (index, &state) in program[machine].states.iter().enumerate() {
        for inner in once(program[state].machines.iter().copied().chain(spawned(program, state))) {
            if !shown.contains(&inner) {
                shown.push(inner);
                children.push((index, nested_in(program, inner, shown)));
            }
        }
    }
    Nested { name: program[machine].name.to_string(), graph: graph(program, machine), children }
}
