//! A machine's drawing for a place of a certain size, and which of the program's elements each part of the drawing is.

use ratatui::layout::Size;

use super::graph::Spot;
use crate::model::{MachineId, Program, StateId, TransitionId};
use crate::ui::glyphs::Charset;
use crate::ui::graph::{self, Drawing, EdgeKind, Glyphs, Options, Part, Place, Point, Rows};
use crate::ui::machine_graph;

#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pub drawing: Drawing,
    /// The state of each node; none for `*`.
    pub nodes: Vec<Option<StateId>>,
    pub edges: Vec<Edge>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Which of the machine's transitions.
    pub index: u32,
    pub kind: EdgeKind,
    /// The state it leads out of; none for `*`.
    pub from: Option<StateId>,
}

impl Diagram {
    /// As wide as the room, as far as that can be; with a row for what is active inside where that fits the height.
    pub fn new(program: &Program, machine: MachineId, size: Size, charset: Charset) -> Diagram {
        let graph = machine_graph::graph(program, machine);
        let glyphs = match charset {
            Charset::Unicode => Glyphs::Unicode,
            Charset::Ascii => Glyphs::Ascii,
        };
        let (max_width, place) = (Some(size.width), Place::Middle);
        let options = |rows| Options { max_width, place, rows, glyphs };
        let two = graph::draw(&graph, &options(Rows::Two));
        let drawing = if two.height > size.height { graph::draw(&graph, &options(Rows::One)) } else { two };
        let states = &program[machine].states;
        let edge = |edge: &graph::Edge| Edge { index: edge.id, kind: edge.kind, from: states.get(edge.from).copied() };
        Diagram {
            drawing,
            nodes: (0..graph.nodes.len()).map(|node| states.get(node).copied()).collect(),
            edges: graph.edges.iter().map(edge).collect(),
        }
    }

    /// The transition of the machine that an edge stands for; for an exit those out of its state that might be it.
    pub fn transitions<'a>(
        &'a self,
        program: &'a Program,
        machine: MachineId,
        edge: usize,
    ) -> impl Iterator<Item = TransitionId> + 'a {
        let Edge { index, from, .. } = self.edges[edge];
        let own = program[machine].transitions.get(index as usize).copied();
        let exits = from.filter(|_| index == machine_graph::EXIT).map(|state| &program[state].exits);
        own.into_iter().chain(exits.into_iter().flatten().copied())
    }

    /// What stands in a cell of the drawing.
    pub fn at(&self, program: &Program, machine: MachineId, at: Point) -> Option<Spot> {
        match self.drawing.cell(at.x, at.y).part {
            Part::Blank => None,
            Part::Box(node) | Part::Name(node) | Part::Mark(node) | Part::Inside(node) => {
                Some(self.nodes[node].map_or(Spot::Machine(machine), Spot::State))
            }
            Part::Line(edge) | Part::Label(edge) | Part::Head(edge) | Part::Crossing { across: edge, .. } => {
                self.transitions(program, machine, edge).next().map(Spot::Transition)
            }
        }
    }

    pub fn node_of(&self, state: StateId) -> Option<usize> {
        self.nodes.iter().position(|&node| node == Some(state))
    }
}
