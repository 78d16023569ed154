//! A fixed script of edits, and what of a drawing each moves that it doesn't concern. Knows nothing of layouts: it compares
//! the cells of two drawings.

use lrp::ui::graph::{Drawing, Edge, EdgeKind, Graph, Node, NodeKind, Options, draw};

/// The graph after an edit.
pub struct Edit {
    after: Graph,
    /// Where each of its nodes and edges was before; none for those that the edit made or changed.
    nodes: Vec<Option<usize>>,
    edges: Vec<Option<usize>>,
}

impl Edit {
    fn nothing(graph: &Graph) -> Edit {
        let (nodes, edges) = (0..graph.nodes.len(), 0..graph.edges.len());
        Edit { after: graph.clone(), nodes: nodes.map(Some).collect(), edges: edges.map(Some).collect() }
    }

    fn state_added(graph: &Graph, at: usize) -> Edit {
        let mut edit = Edit::nothing(graph);
        edit.after.nodes.insert(at, Node { name: "added".into(), kind: NodeKind::State, inside: None });
        edit.nodes.insert(at, None);
        let moved = |end: &mut usize| *end += usize::from(*end >= at);
        edit.after.edges.iter_mut().for_each(|edge| {
            moved(&mut edge.from);
            moved(&mut edge.to);
        });
        edit
    }

    fn state_removed(graph: &Graph, at: usize) -> Edit {
        let mut edit = Edit::nothing(graph);
        edit.after.nodes.remove(at);
        edit.nodes.remove(at);
        edit.edges.retain(|edge| edge.is_some_and(|edge| graph.edges[edge].from != at && graph.edges[edge].to != at));
        edit.after.edges.retain(|edge| edge.from != at && edge.to != at);
        let moved = |end: &mut usize| *end -= usize::from(*end > at);
        edit.after.edges.iter_mut().for_each(|edge| {
            moved(&mut edge.from);
            moved(&mut edge.to);
        });
        edit
    }

    fn edge_added(graph: &Graph, from: usize, to: usize) -> Edit {
        let mut edit = Edit::nothing(graph);
        edit.after.edges.push(Edge { from, to, label: "added".into(), kind: EdgeKind::On, id: u32::MAX });
        edit.edges.push(None);
        edit
    }

    fn edge_removed(graph: &Graph, at: usize) -> Edit {
        let mut edit = Edit::nothing(graph);
        edit.after.edges.remove(at);
        edit.edges.remove(at);
        edit
    }

    fn edge_renamed(graph: &Graph, at: usize) -> Edit {
        let mut edit = Edit::nothing(graph);
        edit.after.edges[at].label.push_str("more");
        edit.edges[at] = None;
        edit
    }

    fn state_renamed(graph: &Graph, at: usize) -> Edit {
        let mut edit = Edit::nothing(graph);
        edit.after.nodes[at].name.push_str("more");
        edit.nodes[at] = None;
        edit
    }
}

/// Each on the graph as it was at first.
pub fn script(graph: &Graph) -> Vec<Edit> {
    let states = graph.nodes.iter().filter(|node| node.kind == NodeKind::State).count();
    let (middle, edge) = (states / 2, graph.edges.len() / 2);
    vec![
        Edit::state_added(graph, middle),
        Edit::state_added(graph, states),
        Edit::state_removed(graph, middle),
        Edit::edge_added(graph, 0, states - 1),
        Edit::edge_added(graph, states - 1, 0),
        Edit::edge_added(graph, middle, middle),
        Edit::edge_added(graph, middle - 1, middle),
        Edit::edge_removed(graph, edge),
        Edit::edge_renamed(graph, edge),
        Edit::state_renamed(graph, middle),
    ]
}

/// How many states and edges an edit moved that it doesn't concern. That rows come and go above a state is no movement;
/// all else is: another column, another height, another lane.
#[derive(Clone, Copy, Default)]
pub struct Moved {
    pub states: usize,
    pub edges: usize,
}

impl Moved {
    pub fn by(edit: &Edit, before: &Graph, options: &Options) -> Moved {
        let (old, new) = (draw(before, options), draw(&edit.after, options));
        let touched = |node: usize| {
            let others = |graph: &Graph, node: usize| {
                let mut at: Vec<_> = graph.edges.iter().filter(|e| e.from == node || e.to == node).collect();
                at.sort_by_key(|edge| edge.id);
                at.iter().map(|edge| edge.label.clone()).collect::<Vec<_>>()
            };
            edit.nodes[node].is_none_or(|known| others(before, known) != others(&edit.after, node))
        };
        let shape = |drawing: &Drawing, node: usize| drawing.node_rect(node).map(|r| (r.x, r.width, r.height));
        let known = |(now, then): (usize, &Option<usize>)| then.map(|then| (now, then));
        let nodes = edit.nodes.iter().enumerate().filter_map(known);
        let edges = edit.edges.iter().enumerate().filter_map(known);
        Moved {
            states: nodes.filter(|&(now, then)| !touched(now) && shape(&new, now) != shape(&old, then)).count(),
            edges: edges.filter(|&(now, then)| columns(&new, now) != columns(&old, then)).count(),
        }
    }

    pub fn plus(self, other: Moved) -> Moved {
        Moved { states: self.states + other.states, edges: self.edges + other.edges }
    }
}

/// The columns that an edge reaches from and to.
fn columns(drawing: &Drawing, edge: usize) -> Option<(u16, u16)> {
    let columns = || drawing.edge_cells(edge).map(|at| at.x);
    columns().min().zip(columns().max())
}
