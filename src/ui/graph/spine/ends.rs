//! Which side of its boxes each edge of a spine uses, and in which order the ends meet the border. Knows nothing of rows
//! and columns.

use crate::ui::graph::{EdgeKind, Graph};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    Out,
    In,
}

/// One end of an edge.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub edge: usize,
    pub flow: Flow,
}

/// The edges that cross the gap below a node: at most one each way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gap {
    pub down: Option<usize>,
    pub up: Option<usize>,
}

/// The ends at each node, from top to bottom.
pub struct Ends {
    pub left: Vec<Vec<End>>,
    pub right: Vec<Vec<End>>,
    /// Below each node.
    pub gaps: Vec<Gap>,
}

impl Ends {
    /// Ends are ordered so that of two edges at a node the shorter one runs inside the longer one and doesn't cross it.
    pub fn of(graph: &Graph) -> Ends {
        let nodes = graph.nodes.len();
        let mut gaps = vec![Gap::default(); nodes];
        let (mut forward, mut back, mut loops) = (Vec::new(), Vec::new(), Vec::new());
        for (i, edge) in graph.edges.iter().enumerate() {
            if edge.from.max(edge.to) >= nodes || goes_straight(graph, i, &mut gaps) {
                continue;
            }
            match edge.from.cmp(&edge.to) {
                std::cmp::Ordering::Less => forward.push(i),
                std::cmp::Ordering::Equal => loops.push(i),
                std::cmp::Ordering::Greater => back.push(i),
            }
        }
        let mut left = vec![Vec::new(); nodes];
        let mut right = vec![Vec::new(); nodes];
        add(graph, Flow::In, &forward, &mut right);
        for edge in loops {
            let ends = [Flow::Out, Flow::In].map(|flow| End { edge, flow });
            right[graph.edges[edge].from].extend(ends);
        }
        add(graph, Flow::Out, &forward, &mut right);
        add(graph, Flow::Out, &back, &mut left);
        add(graph, Flow::In, &back, &mut left);
        Ends { left, right, gaps }
    }
}

/// Takes the gap for an edge between neighbours if it is still free. An exit needs a line, for its circle.
fn goes_straight(graph: &Graph, i: usize, gaps: &mut [Gap]) -> bool {
    let edge = &graph.edges[i];
    let gap = &mut gaps[edge.from.min(edge.to)];
    let place = match (edge.from, edge.to) {
        _ if edge.kind == EdgeKind::Exit => return false,
        (from, to) if from + 1 == to => &mut gap.down,
        (from, to) if to + 1 == from => &mut gap.up,
        _ => return false,
    };
    if place.is_some() {
        return false;
    }
    *place = Some(i);
    true
}

/// Appends one end of each of `edges` to its node: the other node farthest down comes first, and parallel edges nest.
fn add(graph: &Graph, flow: Flow, edges: &[usize], sides: &mut [Vec<End>]) {
    let mut edges = edges.to_vec();
    let other = |i: usize| match flow {
        Flow::Out => graph.edges[i].to,
        Flow::In => graph.edges[i].from,
    };
    if flow == Flow::In {
        edges.reverse();
    }
    edges.sort_by_key(|&i| std::cmp::Reverse(other(i)));
    for edge in edges {
        let node = match flow {
            Flow::Out => graph.edges[edge].from,
            Flow::In => graph.edges[edge].to,
        };
        sides[node].push(End { edge, flow });
    }
}
