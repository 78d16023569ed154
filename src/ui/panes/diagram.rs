//! A machine of a program as the drawing sees it, and which of the program's elements each part of the drawing is.

use crate::model::{MachineId, Program, Sources, StateId, Transition, TransitionId, TransitionKind, Trigger};
use crate::ui::format;
use crate::ui::graph::{self, Drawing, Edge, EdgeKind, Graph, Node, NodeKind, Options, Rows};

/// A block as a label has at most this many columns.
const LABEL: u16 = 16;

#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pub drawing: Drawing,
    /// The state of each node; none for `*` and for states of another machine.
    pub nodes: Vec<Option<StateId>>,
    /// The transition of each edge and how it is coloured.
    pub edges: Vec<(TransitionId, EdgeKind)>,
}

impl Diagram {
    /// As wide as the room, as far as that can be; with room for what is active inside where that fits the height.
    pub fn new(program: &Program, machine: MachineId, width: u16, height: u16) -> Diagram {
        let mut plan = Plan { program, nodes: Vec::new(), graph: Graph::default(), edges: Vec::new() };
        plan.add_states(machine);
        plan.add_transitions(machine);
        let options = |rows| Options { max_width: Some(width), rows, ..Options::default() };
        let two = graph::draw(&plan.graph, &options(Rows::Two));
        let drawing = if two.height > height { graph::draw(&plan.graph, &options(Rows::One)) } else { two };
        Diagram { drawing, nodes: plan.nodes, edges: plan.edges }
    }

    pub fn node_of(&self, state: StateId) -> Option<usize> {
        self.nodes.iter().position(|&node| node == Some(state))
    }
}

struct Plan<'a> {
    program: &'a Program,
    nodes: Vec<Option<StateId>>,
    graph: Graph,
    edges: Vec<(TransitionId, EdgeKind)>,
}

impl Plan<'_> {
    fn add_states(&mut self, machine: MachineId) {
        let program = self.program;
        for &state in &program[machine].states {
            let nested = program[state].machines.iter().flat_map(|&inner| &program[inner].states);
            let longest = nested.max_by_key(|&&inner| format::width(&program[inner].name));
            let inside = longest.map(|&inner| program[inner].name.to_string());
            self.add_node(&program[state].name, NodeKind::State, inside, Some(state));
        }
    }

    fn add_transitions(&mut self, machine: MachineId) {
        let program = self.program;
        for &id in &program[machine].transitions {
            self.add_transition(machine, id);
        }
        for &state in &program[machine].states {
            for &id in &program[state].exits {
                let ends = self.node(state).zip(program[id].target.and_then(|target| self.node(target)));
                if let Some((from, to)) = ends {
                    self.add_edge(from, to, id, EdgeKind::Exit);
                }
            }
        }
    }

    fn add_transition(&mut self, machine: MachineId, id: TransitionId) {
        let transition = &self.program[id];
        let Some(to) = transition.target.map(|target| self.target(machine, target)) else { return };
        match &transition.sources {
            Sources::Any => {
                let from = self.wildcard();
                self.add_edge(from, to, id, EdgeKind::Wildcard);
            }
            Sources::These { states, .. } => {
                for &state in states {
                    if let Some(from) = self.node(state) {
                        self.add_edge(from, to, id, kind(transition.kind));
                    }
                }
            }
        }
    }

    fn node(&self, state: StateId) -> Option<usize> {
        self.nodes.iter().position(|&node| node == Some(state))
    }

    /// An exit leads to a state outside, which is drawn once, with a mark.
    fn target(&mut self, machine: MachineId, target: StateId) -> usize {
        if self.program[target].machine == machine
            && let Some(node) = self.node(target)
        {
            return node;
        }
        let name = format!("^{}", self.program[target].name);
        let known = self.graph.nodes.iter().position(|node| node.name == name);
        known.unwrap_or_else(|| self.add_node(&name, NodeKind::State, None, None))
    }

    fn wildcard(&mut self) -> usize {
        let known = self.graph.nodes.iter().position(|node| node.kind == NodeKind::Any);
        known.unwrap_or_else(|| self.add_node("*", NodeKind::Any, None, None))
    }

    fn add_node(&mut self, name: &str, kind: NodeKind, inside: Option<String>, state: Option<StateId>) -> usize {
        self.graph.nodes.push(Node { name: name.into(), kind, inside });
        self.nodes.push(state);
        self.nodes.len() - 1
    }

    fn add_edge(&mut self, from: usize, to: usize, id: TransitionId, kind: EdgeKind) {
        let label = label(self.program, &self.program[id]);
        self.graph.edges.push(Edge { from, to, label, kind, id: id.0 });
        self.edges.push((id, kind));
    }
}

fn kind(kind: TransitionKind) -> EdgeKind {
    match kind {
        TransitionKind::On => EdgeKind::On,
        TransitionKind::Eps => EdgeKind::Eps,
        TransitionKind::Ontime => EdgeKind::Ontime,
        TransitionKind::Exit => EdgeKind::Exit,
    }
}

/// What makes it fire, where that has a name; else its own name.
pub fn label(program: &Program, transition: &Transition) -> String {
    let own = transition.name.as_ref().map(ToString::to_string);
    match &transition.trigger {
        Trigger::Event(event) => program[*event].name.to_string(),
        Trigger::UnknownEvent(name) => format!("{name}?"),
        Trigger::After(ms) => format!("{}ms", format::number(*ms)),
        Trigger::AfterVar(var) => own.unwrap_or_else(|| program[*var].name.to_string()),
        Trigger::AfterUnknown(name) => own.unwrap_or_else(|| format!("{name}?")),
        Trigger::Block(block) | Trigger::AfterBlock(block) => {
            own.unwrap_or_else(|| format::fit(program[*block].code.trim(), LABEL))
        }
        Trigger::Always => own.unwrap_or_default(),
    }
}
