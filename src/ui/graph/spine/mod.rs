//! The spine: all states in one column in source order. An edge between neighbours is an arrow in the gap between their
//! boxes; of the others, those that lead forward run on the right and those that lead back on the left. Each end has a
//! row of its box's border for itself, each run a lane. Knows nothing of cells.
//!
//! Rows are settled first (`stack`), and don't depend on how long the texts are; columns follow (`columns`).

mod columns;
mod ends;
mod fit;
mod lanes;
mod stack;

use self::columns::{Columns, FRAME};
use self::fit::{Fitted, fit};
use self::stack::Stack;
use super::glyphs::Way;
use super::layout::{Block, Layout, Point, Route, Words, cell, point, rect};
use super::texts::Texts;
use super::{Graph, Options, words};

/// `None` if no spine of these states and edges is as narrow as asked for.
pub fn layout(graph: &Graph, options: &Options) -> Option<Layout> {
    let texts = Texts::of(graph, options);
    let stack = Stack::new(graph, &texts);
    let Fitted { columns, names, labels } = fit(&stack, &texts, options)?;
    Some(Spine { texts, stack, columns, names, labels }.layout())
}

/// A side of the boxes: the right one for edges that lead down, the left one for those that lead up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// How an edge runs. Rows are those of the drawing.
#[derive(Clone, Copy, Debug)]
enum Run {
    /// Through the gap in this row, with its label towards this side.
    Gap { side: Side, row: usize },
    /// On a lane beside the boxes, between the rows of its ends.
    Beside { side: Side, from: usize, to: usize },
    /// Its ends are not in the graph.
    Nowhere,
}

impl Run {
    fn side(self) -> Option<Side> {
        match self {
            Run::Gap { side, .. } | Run::Beside { side, .. } => Some(side),
            Run::Nowhere => None,
        }
    }
}

/// Rows and columns of everything.
struct Spine {
    texts: Texts,
    stack: Stack,
    columns: Columns,
    /// What is shown of each name and label.
    names: Vec<String>,
    labels: Vec<String>,
}

impl Spine {
    fn layout(self) -> Layout {
        let nodes = 0..self.stack.levels.len();
        let edges = 0..self.stack.runs.len();
        Layout {
            width: cell(self.columns.width()),
            height: cell(self.stack.height),
            blocks: nodes.map(|node| self.block(node)).collect(),
            routes: edges.map(|edge| self.route(edge)).collect(),
            shown: self.texts.shown(self.names, self.labels),
        }
    }

    fn block(&self, node: usize) -> Block {
        let (x, width) = (self.columns.left.extent, self.columns.box_width);
        let level = self.stack.levels[node];
        let text = self.names[node].clone();
        let (name_width, mark) = (words::width(&text), self.texts.mark(node));
        let name_x = x + (width - name_width - mark) / 2;
        let room = rect(x + FRAME / 2, level.name + 1, width - FRAME, 1);
        Block {
            node,
            rect: rect(x, level.top, width, level.height),
            mark: (mark > 0).then(|| point(name_x + name_width + mark - 1, level.name)),
            name: Words { at: point(name_x, level.name), text },
            inside: self.texts.has_room(node).then_some(room),
        }
    }

    fn route(&self, edge: usize) -> Option<Route> {
        match self.stack.runs[edge] {
            Run::Gap { side, row } => Some(self.through_gap(edge, side, row)),
            Run::Beside { side, from, to } => Some(self.beside(edge, side, from, to)),
            Run::Nowhere => None,
        }
    }

    /// An arrow right of the boxes' middle if it leads down, left of it if it leads up, so that both fit into a gap.
    fn through_gap(&self, edge: usize, side: Side, row: usize) -> Route {
        let middle = self.columns.left.extent + self.columns.box_width / 2;
        let (x, head) = match side {
            Side::Left => (middle - 1, Way::Up),
            Side::Right => (middle + 1, Way::Down),
        };
        let label = self.label(edge).map(|text| Words {
            at: match side {
                Side::Left => point(x - 1 - words::width(&text), row),
                Side::Right => point(x + 2, row),
            },
            text,
        });
        Route { points: vec![point(x, row)], label, target: None, head }
    }

    /// Out to the edge's lane, along it and back to the boxes.
    fn beside(&self, edge: usize, side: Side, from: usize, to: usize) -> Route {
        let at = |distance, row| self.at(side, distance, row);
        let lane = self.columns.on(side).of(edge).unwrap_or(1);
        let padding = self.texts.glyphs.label_padding();
        let label = self.label(edge).map(|text| Words {
            at: match side {
                Side::Left => at(1 + padding + words::width(&text), from),
                Side::Right => at(2 + padding, from),
            },
            text,
        });
        Route {
            points: vec![at(1, from), at(lane, from), at(lane, to), at(1, to)],
            label,
            target: None,
            head: match side {
                Side::Left => Way::Right,
                Side::Right => Way::Left,
            },
        }
    }

    fn label(&self, edge: usize) -> Option<String> {
        Some(self.labels[edge].clone()).filter(|label| !label.is_empty())
    }

    /// The cell in `row` at a distance from the border of the boxes.
    fn at(&self, side: Side, distance: usize, row: usize) -> Point {
        let left = self.columns.left.extent;
        match side {
            Side::Left => point(left - distance, row),
            Side::Right => point(left + self.columns.box_width - 1 + distance, row),
        }
    }
}
