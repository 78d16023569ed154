//! Where things stand: what a layout hands to the canvas. Knows nothing of glyphs.

/// A cell, counted from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Point {
    pub x: u16,
    pub y: u16,
}

/// A rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Rect {
    pub x: u16,
    pub y: u16,
    pub width: u16,
    pub height: u16,
}

/// A place or a length in cells; what is beyond the largest drawing ends at its border.
pub fn cell(at: usize) -> u16 {
    u16::try_from(at).unwrap_or(u16::MAX)
}

pub fn point(x: usize, y: usize) -> Point {
    Point { x: cell(x), y: cell(y) }
}

pub fn rect(x: usize, y: usize, width: usize, height: usize) -> Rect {
    Rect { x: cell(x), y: cell(y), width: cell(width), height: cell(height) }
}

/// A line of text that starts in the cell `at`.
pub struct Words {
    pub at: Point,
    pub text: String,
}

/// A box and what is in it.
pub struct Block {
    pub node: usize,
    pub rect: Rect,
    pub name: Words,
    /// Where the mark of a nested machine stands.
    pub mark: Option<Point>,
    /// Room for the name of the state that is active inside.
    pub inside: Option<Rect>,
}

/// The way of an edge.
pub struct Route {
    /// From the cell beside the source to the cell of the head, over each corner; neighbours differ in one coordinate.
    pub points: Vec<Point>,
    /// Stands on the route, or beside its only cell.
    pub label: Option<Words>,
    /// The name of the state that it leads to, where it doesn't reach its box.
    pub target: Option<Words>,
    /// Which way the head points.
    pub head: super::glyphs::Way,
}

pub struct Layout {
    pub width: u16,
    pub height: u16,
    /// None for a node that isn't shown; where it has several, the first is its own.
    pub blocks: Vec<Block>,
    /// One for each edge, `None` for an edge that isn't shown.
    pub routes: Vec<Option<Route>>,
    pub shown: Shown,
}

/// What is shown of each node's name and each edge's label, and what it is in full. No two texts show the same.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    pub names: Vec<(String, String)>,
    pub labels: Vec<(String, String)>,
}
