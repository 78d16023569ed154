//! A machine's drawing for a place of a certain size, and which of the program's elements each part of the drawing is.

use ratatui::layout::Size;

use super::graph::Spot;
use crate::model::{MachineId, Program, StateId, TransitionId};
use crate::ui::glyphs::Charset;
use crate::ui::graph::{self, Drawing, EdgeKind, Form, Glyphs, Graph, Means, Options, Part, Place, Point, Rows};
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
    /// The states it leads out of and to; none for `*`.
    pub from: Option<StateId>,
    pub to: Option<StateId>,
}

/// How near a machine is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    Boxes,
    Table,
    /// This state and what leads into and out of it.
    Around(StateId),
}

impl Diagram {
    /// As wide as the room where that can be, boxes wider before they would be without lines; with room for what is active
    /// inside where that fits the height.
    pub fn new(program: &Program, machine: MachineId, view: View, size: Size, charset: Charset) -> Diagram {
        let whole = machine_graph::graph(program, machine);
        let states = &program[machine].states;
        let (graph, nodes, form) = match view {
            View::Boxes => all(whole, Form::Boxes),
            View::Table => all(whole, Form::Table),
            View::Around(state) => around(&whole, states.iter().position(|&known| known == state)),
        };
        let glyphs = match charset {
            Charset::Unicode => Glyphs::Unicode,
            Charset::Ascii => Glyphs::Ascii,
        };
        let (max_width, max_height, place) = (Some(size.width), Some(size.height), Place::Middle);
        let within = Options { form, glyphs, max_width, max_height, place, rows: Rows::Two };
        let two = graph::draw(&graph, &within);
        let one = || graph::draw(&graph, &Options { rows: Rows::One, ..within });
        let drawing = if two.height > size.height { one() } else { two };
        let drawing = match (view, drawing.means()) {
            (View::Boxes, Means::Words) => graph::draw(&graph, &Options { form, glyphs, ..Options::default() }),
            _ => drawing,
        };
        let nodes: Vec<Option<StateId>> = nodes.into_iter().map(|node| states.get(node).copied()).collect();
        let edge = |edge: &graph::Edge| {
            let [from, to] = [edge.from, edge.to].map(|node| nodes.get(node).copied().flatten());
            Edge { index: edge.id, kind: edge.kind, from, to }
        };
        Diagram { drawing, edges: graph.edges.iter().map(edge).collect(), nodes }
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
            Part::Line(edge)
            | Part::Label(edge)
            | Part::Head(edge)
            | Part::Target(edge)
            | Part::Crossing { across: edge, .. } => {
                self.transitions(program, machine, edge).next().map(Spot::Transition)
            }
        }
    }

    pub fn node_of(&self, state: StateId) -> Option<usize> {
        self.nodes.iter().position(|&node| node == Some(state))
    }

    /// What the shortened texts at a node are in full: `outo… outofline`; without a node, all of them.
    pub fn legend(&self, node: Option<usize>) -> Vec<String> {
        let state = node.and_then(|node| self.nodes[node]);
        let concerns = |edge: &Edge| node.is_none() || edge.from == state || edge.to == state;
        let edges = || self.edges.iter().enumerate().filter(|(_, edge)| concerns(edge));
        let ends = edges().flat_map(|(_, edge)| [edge.from, edge.to]).flatten().filter_map(|end| self.node_of(end));
        let names = node.into_iter().chain(ends).filter_map(|node| self.drawing.shortened_name(node));
        let labels = edges().filter_map(|(edge, _)| self.drawing.shortened_label(edge));
        let mut entries: Vec<String> = Vec::new();
        for (shown, whole) in names.chain(labels) {
            let entry = format!("{shown} {whole}");
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
        entries
    }
}

/// Which node of the machine each node of a graph is, and the form to draw it in.
type Drawn = (Graph, Vec<usize>, Form);

fn all(graph: Graph, form: Form) -> Drawn {
    let nodes = (0..graph.nodes.len()).collect();
    (graph, nodes, form)
}

fn around(graph: &Graph, node: Option<usize>) -> Drawn {
    let node = node.unwrap_or(graph.nodes.len());
    let (part, nodes) = graph.around(node);
    let middle = nodes.iter().position(|&known| known == node).unwrap_or(nodes.len());
    (part, nodes, Form::Around(middle))
}
