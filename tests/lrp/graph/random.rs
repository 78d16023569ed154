//! Drawings of random machines, and of random texts.

use lrp::ui::graph::{Edge, EdgeKind, Glyphs, Graph, Node, NodeKind, Options, Rows, draw};
use proptest::prelude::*;

use super::{ASCII, ONE_ROW, UNICODE, meant, narrowed, shortens};
use crate::tracer::{columns, trace};

/// A graph of up to `most` states, the last of them perhaps `*`, with up to four times as many edges of all kinds.
fn any_graph(most: usize) -> impl Strategy<Value = Graph> {
    (2..=most, any::<bool>()).prop_flat_map(|(count, wildcard)| {
        let nodes = prop::collection::vec((any_name(), prop::option::weighted(0.2, any_name())), count);
        let edge = (0..count, 0..count, any_label(), 0..4usize);
        (nodes, prop::collection::vec(edge, 0..=4 * count))
            .prop_map(move |(nodes, edges)| built(nodes, edges, wildcard))
    })
}

fn built(nodes: Vec<(String, Option<String>)>, edges: Vec<(usize, usize, String, usize)>, wildcard: bool) -> Graph {
    let last = nodes.len() - 1;
    let is_any = |i: usize| wildcard && i == last;
    let node = |(i, (name, inside))| match is_any(i) {
        true => Node { name: "*".to_owned(), kind: NodeKind::Any, inside: None },
        false => Node { name: format!("{name}{i}"), kind: NodeKind::State, inside },
    };
    let edge = |(id, (from, to, label, kind)): (usize, (usize, usize, String, usize))| {
        let kind = [EdgeKind::On, EdgeKind::Eps, EdgeKind::Ontime, EdgeKind::Exit][kind];
        let kind = if is_any(from) { EdgeKind::Wildcard } else { kind };
        Edge { from, to, label, kind, id: id as u32 }
    };
    let edges = edges.into_iter().enumerate().map(edge).filter(|edge| !is_any(edge.to));
    Graph { edges: edges.collect(), nodes: nodes.into_iter().enumerate().map(node).collect() }
}

/// Letters of all widths, an accent that combines with the letter before it, and signs that lines are made of.
fn any_name() -> impl Strategy<Value = String> {
    "[a-z_]([a-zA-Zäé界線😀_-]|e\u{301}){0,9}"
}

fn any_label() -> impl Strategy<Value = String> {
    "|[a-zäß線🤖]{1,3}|[a-z-]{1,14}|[0-9]{1,5}ms|[ov.'|+=~:<>^-]{1,4}|[a-z]{1,5}\\.x [<>=+|-] [0-9]{1,4}"
}

fn read_back(graph: &Graph) -> Result<(), TestCaseError> {
    for options in [UNICODE, ASCII, ONE_ROW] {
        let drawing = draw(graph, &options);
        let text = drawing.text();
        prop_assert_eq!(trace(&text), Ok(meant(graph)), "{:?}\n{}", options, text);
        prop_assert_eq!(&draw(graph, &options), &drawing);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn machines_are_read_as_they_are(graph in any_graph(40)) {
        read_back(&graph)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, ..ProptestConfig::default() })]

    #[test]
    fn large_machines_are_read_as_they_are(graph in any_graph(100)) {
        read_back(&graph)?;
    }
}

proptest! {
    #[test]
    fn narrow_drawings_keep_every_edge(graph in any_graph(20), width in 20..160u16) {
        for options in [UNICODE, ASCII] {
            if let Some(seen) = narrowed(&graph, width, &options) {
                let seen = seen.map_err(TestCaseError::fail)?;
                prop_assert!(shortens(&seen, &meant(&graph)), "{:#?}", seen);
            }
        }
    }

    /// Whatever the texts are, nothing in the drawing moves the cursor or runs over its right end.
    #[test]
    fn any_text_can_be_drawn(
        texts in prop::collection::vec(".{0,12}", 1..12),
        ends in prop::collection::vec((0..9usize, 0..9usize), 0..30),
        width in prop::option::of(0..50u16),
    ) {
        let text = |i: usize| texts[i % texts.len()].clone();
        let inside = |i: usize| i.is_multiple_of(2).then(|| text(i + 1));
        let node = |i: usize| Node { name: text(i), kind: NodeKind::State, inside: inside(i) };
        // Some ends are no node.
        let edge = |(i, &(from, to))| Edge { from, to, label: text(i), kind: EdgeKind::On, id: 0 };
        let graph = Graph {
            nodes: (0..8).map(node).collect(),
            edges: ends.iter().enumerate().map(edge).collect(),
        };
        for glyphs in [Glyphs::Unicode, Glyphs::Ascii] {
            let drawing = draw(&graph, &Options { glyphs, max_width: width, rows: Rows::Two });
            prop_assert_eq!(drawing.text().lines().count(), usize::from(drawing.height));
            for line in drawing.text().lines() {
                prop_assert!(!line.contains(char::is_control), "{:?}", line);
                prop_assert!(columns(line) <= usize::from(drawing.width), "{:?}", line);
            }
        }
    }
}
