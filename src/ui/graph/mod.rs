//! Draws a state machine in the integer cells of a terminal. Knows nothing of the terminal's library, of programs or of records.
//!
//! A [`Graph`] goes through the layout of a [`Form`] (where the boxes stand, which way each edge runs) onto a canvas of
//! cells. The layout knows no glyphs, the canvas no states. Where a width is too small for lines, the same cells hold a list.

mod around;
mod canvas;
mod drawing;
mod export;
mod glyphs;
mod layout;
mod list;
mod spine;
mod table;
mod texts;
mod words;

use std::collections::BTreeSet;

pub use drawing::{Cell, Drawing, Means, Part};
pub use export::{Nested, dot, mermaid};
pub use glyphs::Glyphs;
pub use layout::{Point, Rect};

/// A machine as a drawing sees it. The order of the nodes is the order of the drawing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    pub nodes: Vec<Node>,
    /// In source order. An edge whose ends are not in `nodes` is left out of the drawing.
    pub edges: Vec<Edge>,
}

impl Graph {
    /// What is around a node: its transitions, those out of the wildcard source, and the nodes at their ends. With it
    /// which node of this graph each of its nodes is.
    pub fn around(&self, node: usize) -> (Graph, Vec<usize>) {
        let is_any = |at: usize| self.nodes.get(at).is_some_and(|node| node.kind == NodeKind::Any);
        let concerns = |edge: &&Edge| edge.from == node || edge.to == node || is_any(edge.from);
        let whole = |edge: &&Edge| edge.from.max(edge.to) < self.nodes.len();
        let mut edges: Vec<Edge> = self.edges.iter().filter(concerns).filter(whole).cloned().collect();
        let ends = edges.iter().flat_map(|edge| [edge.from, edge.to]);
        let shown: BTreeSet<usize> = ends.chain([node]).filter(|&at| at < self.nodes.len()).collect();
        let shown: Vec<usize> = shown.into_iter().collect();
        let index = |at: usize| shown.binary_search(&at).unwrap_or(at);
        edges.iter_mut().for_each(|edge| (edge.from, edge.to) = (index(edge.from), index(edge.to)));
        (Graph { nodes: shown.iter().map(|&at| self.nodes[at].clone()).collect(), edges }, shown)
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    pub name: String,
    pub kind: NodeKind,
    /// The longest name of a state that may be active inside; `None` if the state has no nested machine.
    /// The box keeps room for it, so that nothing moves when the active state changes.
    pub inside: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeKind {
    State,
    /// The wildcard source `*`. It belongs last: there it never comes between two states.
    Any,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Indices into [`Graph::nodes`].
    pub from: usize,
    pub to: usize,
    pub label: String,
    pub kind: EdgeKind,
    /// The transition. One from a subset of states gives several edges with the same id.
    pub id: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeKind {
    On,
    Eps,
    Ontime,
    Wildcard,
    Exit,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Options {
    pub form: Form,
    pub glyphs: Glyphs,
    /// In columns. To keep to it labels and names are shortened, in turns and so that each still differs from the others
    /// ([`Drawing::legend`] has them whole); where that isn't enough, the drawing is a list of all states and edges. Only
    /// below eight columns it may be wider.
    pub max_width: Option<u16>,
    /// In rows. A table arranges itself for it; nothing is left out to keep to it.
    pub max_height: Option<u16>,
    pub place: Place,
    pub rows: Rows,
}

/// How near a machine is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// All states as boxes in one column, with a line for each transition.
    #[default]
    Boxes,
    /// All states in one row each where that can be, with an arrow for each transition to the name of its target.
    Table,
    /// A node with a row for each transition into and out of it, the others below: for [`Graph::around`].
    Around(usize),
}

/// Where in the given width the boxes stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Place {
    /// As far left as the lines allow: for paper.
    #[default]
    Left,
    /// In the middle, as long as the lines on both sides have room, so that edits leave them there: for a screen.
    Middle,
}

/// What a box shows of a nested machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Rows {
    /// A mark beside the name and below it a row for the active nested state.
    #[default]
    Two,
    /// Only the mark: for dense machines.
    One,
}

/// The drawing of `graph`: the same for the same input, whatever is active.
pub fn draw(graph: &Graph, options: &Options) -> Drawing {
    let layout = match options.form {
        Form::Boxes => spine::layout(graph, options),
        Form::Table => table::layout(graph, options),
        Form::Around(node) => around::layout(graph, node, options),
    };
    match layout {
        Some(layout) => canvas::paint(graph, options.glyphs, layout),
        None => list::draw(graph, options.glyphs, options.max_width.map_or(usize::MAX, usize::from)),
    }
}
