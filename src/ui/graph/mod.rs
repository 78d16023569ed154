//! Draws a state machine in the integer cells of a terminal. Knows nothing of the terminal's library, of programs or of records.
//!
//! A [`Graph`] goes through a layout (where the boxes stand, which way each edge runs) onto a canvas of cells. The layout
//! knows no glyphs, the canvas no states. Where a width is too small for lines, the same cells hold a list.

mod canvas;
mod drawing;
mod export;
mod glyphs;
mod layout;
mod list;
mod spine;
mod words;

pub use drawing::{Cell, Drawing, Part};
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
    pub glyphs: Glyphs,
    /// In columns. To keep to it labels and names are shortened, in turns and so that each still differs from the others
    /// ([`Drawing::legend`] has them whole); where that isn't enough, the drawing is a list of all states and edges. Only
    /// below eight columns it may be wider.
    pub max_width: Option<u16>,
    pub place: Place,
    pub rows: Rows,
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
    match spine::layout(graph, options) {
        Some(layout) => canvas::paint(graph, options.glyphs, layout),
        None => list::draw(graph, options.glyphs, options.max_width.map_or(usize::MAX, usize::from)),
    }
}
