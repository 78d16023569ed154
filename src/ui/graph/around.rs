//! One state and what leads into and out of it: its box on the left, and for each transition a row with the state at the
//! other end. What leads out of the wildcard source leads out of the state as well and follows below. Knows nothing of cells.

use super::glyphs::Way;
use super::layout::{Block, Layout, Route, Words, cell, point, rect};
use super::texts::{Limits, Texts};
use super::{Graph, Options, words};

/// Columns of a box beside its text, half of them on either side.
const FRAME: usize = 4;
/// Columns of a line beside its label: one at its beginning, one before its head, the head, and one to stand clear of it.
const LINE: usize = 4;
/// Rows between the state and the wildcard source.
const GAP: usize = 1;

/// `None` if no texts keep to the width asked for that still tell what is whose.
pub fn layout(graph: &Graph, node: usize, options: &Options) -> Option<Layout> {
    let star = Star { graph, options, hubs: hubs(graph, node), texts: Texts::of(graph, options) };
    let whole = star.texts.full();
    star.within(whole).or_else(|| whole.longest(|limits| star.within(limits)))
}

/// A box on the left, with its transitions from top to bottom.
#[derive(Clone, Debug)]
struct Hub {
    node: usize,
    /// Those out in the order written, then those in.
    edges: Vec<usize>,
}

/// The node itself, and what else transitions lead out of that don't concern it.
fn hubs(graph: &Graph, node: usize) -> Vec<Hub> {
    let nodes = graph.nodes.len();
    let out_of = |node: usize| {
        let edges = graph.edges.iter().enumerate();
        edges.filter(move |(_, edge)| edge.from == node && edge.to < nodes).map(|(i, _)| i)
    };
    let others = (0..nodes).filter(|&other| other != node);
    let into = others.clone().flat_map(out_of).filter(|&i| graph.edges[i].to == node);
    let own = (node < nodes).then(|| Hub { node, edges: out_of(node).chain(into).collect() });
    let other = others.map(|other| {
        let edges = out_of(other).filter(|&i| graph.edges[i].to != node);
        Hub { node: other, edges: edges.collect() }
    });
    own.into_iter().chain(other.filter(|hub| !hub.edges.is_empty())).collect()
}

struct Star<'a> {
    graph: &'a Graph,
    options: &'a Options,
    hubs: Vec<Hub>,
    texts: Texts,
}

/// How wide the boxes on both sides are, and what is between them.
struct Sizes {
    left: usize,
    line: usize,
    right: usize,
}

impl Star<'_> {
    fn within(&self, limits: Limits) -> Option<Layout> {
        let sizes = self.sizes(limits);
        let width = sizes.left + sizes.line + sizes.right;
        if self.options.max_width.is_some_and(|max| width > usize::from(max)) {
            return None;
        }
        let (names, labels) = (self.texts.names_within(limits)?, self.texts.labels_within(limits)?);
        let mut blocks = Vec::new();
        let mut routes: Vec<Option<Route>> = self.graph.edges.iter().map(|_| None).collect();
        let mut top = 0;
        for hub in &self.hubs {
            let height = hub.edges.len().max(self.texts.rows(hub.node));
            blocks.push(self.hub(hub.node, top, height, &sizes, &names[hub.node]));
            for (y, &edge) in (top..).zip(&hub.edges) {
                let other = self.other(hub, edge);
                blocks.push(self.neighbour(other, y, &sizes, &names[other]));
                routes[edge] = Some(self.route(hub, edge, y, &sizes, &labels[edge]));
            }
            top += height + GAP;
        }
        let shown = self.texts.shown(names, labels);
        Some(Layout { width: cell(width), height: cell(top.saturating_sub(GAP)), blocks, routes, shown })
    }

    fn sizes(&self, limits: Limits) -> Sizes {
        let hubs = &self.hubs;
        let label = |&edge: &usize| match self.texts.label_width(edge, limits) {
            0 => 0,
            width => width + 2 * self.texts.glyphs.label_padding(),
        };
        let others = hubs.iter().flat_map(|hub| hub.edges.iter().map(|&edge| self.other(hub, edge)));
        let right = others.map(|node| FRAME + self.texts.name_width(node, limits)).max();
        let left = hubs.iter().map(|hub| FRAME + self.texts.width(hub.node, limits)).max();
        let labels = hubs.iter().flat_map(|hub| &hub.edges).map(label).max();
        Sizes { left: left.unwrap_or(0), line: labels.map_or(0, |label| LINE + label), right: right.unwrap_or(0) }
    }

    /// The node at the end of an edge that isn't the hub; the hub itself for a loop.
    fn other(&self, hub: &Hub, edge: usize) -> usize {
        let edge = &self.graph.edges[edge];
        if edge.from == hub.node { edge.to } else { edge.from }
    }

    fn hub(&self, node: usize, top: usize, height: usize, sizes: &Sizes, name: &str) -> Block {
        let room = rect(FRAME / 2, top + 1, sizes.left - FRAME, 1);
        Block {
            inside: self.texts.has_room(node).then_some(room),
            ..self.block(node, 0, top, (sizes.left, height), name)
        }
    }

    fn neighbour(&self, node: usize, y: usize, sizes: &Sizes, name: &str) -> Block {
        self.block(node, sizes.left + sizes.line, y, (sizes.right, 1), name)
    }

    fn block(&self, node: usize, x: usize, y: usize, (width, height): (usize, usize), name: &str) -> Block {
        let (after, mark) = (x + FRAME / 2 + words::width(name), self.texts.mark(node));
        Block {
            node,
            rect: rect(x, y, width, height),
            name: Words { at: point(x + FRAME / 2, y), text: name.to_owned() },
            mark: (mark > 0).then(|| point(after + mark - 1, y)),
            inside: None,
        }
    }

    fn route(&self, hub: &Hub, edge: usize, y: usize, sizes: &Sizes, label: &str) -> Route {
        let (left, right) = (point(sizes.left, y), point(sizes.left + sizes.line - 1, y));
        let leads_out = self.graph.edges[edge].from == hub.node;
        let x = sizes.left + LINE / 2 + self.texts.glyphs.label_padding();
        Route {
            points: if leads_out { vec![left, right] } else { vec![right, left] },
            label: (!label.is_empty()).then(|| Words { at: point(x, y), text: label.to_owned() }),
            target: None,
            head: if leads_out { Way::Right } else { Way::Left },
        }
    }
}
