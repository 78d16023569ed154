//! Draws a state machine in the integer cells of a terminal. Knows nothing of the terminal's library, of programs or of records.
//!
//! A [`Graph`] goes through a layout (where the boxes stand, which way each edge runs) onto a canvas of cells. The layout
//! knows no glyphs, the canvas no states; a second layout can stand beside the first and leave the canvas as it is.

mod canvas;
mod drawing;
mod export;
mod glyphs;
mod layout;
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
    /// In columns. To keep to it labels are shortened first, then names; no line is ever left out, so a drawing with
    /// very many lines may still be wider.
    pub max_width: Option<u16>,
    pub rows: Rows,
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
    canvas::paint(graph, options.glyphs, spine::layout(graph, options))
}
