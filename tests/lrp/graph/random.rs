//! Drawings of random machines, and of random texts.

use lrp::ui::graph::{Edge, EdgeKind, Form, Glyphs, Graph, Node, NodeKind, Options, draw};
use proptest::prelude::*;

use super::{ALL, ASCII, MIDDLE, NARROWEST, UNICODE, around, meant, printed, read_around};
use crate::tracer::{columns, trace};

/// A graph of up to `most` states, the last of them perhaps `*`, with up to four times as many edges of all kinds.
fn any_graph(most: usize) -> impl Strategy<Value = Graph> {
    (2..=most, any::<bool>()).prop_flat_map(|(count, wildcard)| {
        let nodes = prop::collection::vec((any_name(), prop::option::weighted(0.2, any_name())), count);
        let sources = prop_oneof![4 => prop::collection::vec(0..count, 1), 1 => prop::collection::vec(0..count, 2..5)];
        let transition = (sources, 0..count, any_label(), 0..4usize);
        (nodes, prop::collection::vec(transition, 0..=4 * count))
            .prop_map(move |(nodes, transitions)| built(nodes, transitions, wildcard))
    })
}

/// Sources, target, label and kind.
type Transition = (Vec<usize>, usize, String, usize);

/// A transition out of several states has an edge from each; no more edges are made than there may be.
fn built(nodes: Vec<(String, Option<String>)>, transitions: Vec<Transition>, wildcard: bool) -> Graph {
    let (last, most) = (nodes.len() - 1, 4 * nodes.len());
    let is_any = |i: usize| wildcard && i == last;
    let node = |(i, (name, inside))| match is_any(i) {
        true => Node { name: "*".to_owned(), kind: NodeKind::Any, inside: None },
        false => Node { name: format!("{name}{i}"), kind: NodeKind::State, inside },
    };
    let edges = transitions.into_iter().enumerate().flat_map(|(id, (from, to, label, kind))| {
        let kind = [EdgeKind::On, EdgeKind::Eps, EdgeKind::Ontime, EdgeKind::Exit][kind];
        from.into_iter().map(move |from| {
            let kind = if is_any(from) { EdgeKind::Wildcard } else { kind };
            Edge { from, to, label: label.clone(), kind, id: id as u32 }
        })
    });
    let edges = edges.filter(|edge| !is_any(edge.to)).take(most).collect();
    Graph { edges, nodes: nodes.into_iter().enumerate().map(node).collect() }
}

/// Letters of all widths, an accent that combines with the letter before it, and signs that lines are made of.
fn any_name() -> impl Strategy<Value = String> {
    "[a-z_]([a-zA-Zäé界線😀_-]|e\u{301}){0,9}"
}

fn any_label() -> impl Strategy<Value = String> {
    "|[a-zäß線🤖]{1,3}|[a-z-]{1,14}|[0-9]{1,5}ms|[ov.'|+=~:<>^-]{1,4}|[a-z]{1,5}\\.x [<>=+|-] [0-9]{1,4}"
}

fn read_back(graph: &Graph) -> Result<(), TestCaseError> {
    for options in ALL {
        let drawing = draw(graph, &options);
        let text = drawing.text();
        prop_assert_eq!(trace(&text), Ok(meant(graph)), "{:?}\n{}", options, text);
        prop_assert_eq!(&draw(graph, &options), &drawing);
    }
    Ok(())
}

fn read_back_within(graph: &Graph, width: u16) -> Result<(), TestCaseError> {
    for options in ALL.into_iter().chain([MIDDLE]) {
        let text = printed(graph, width, &options).map_err(TestCaseError::fail)?;
        prop_assert_eq!(trace(&text), Ok(meant(graph)), "{:?} in {}\n{}", options, width, text);
    }
    Ok(())
}

fn read_around_within(graph: &Graph, width: u16) -> Result<(), TestCaseError> {
    for (node, options) in (0..graph.nodes.len()).flat_map(|node| [(node, UNICODE), (node, ASCII)]) {
        let (part, options) = around(graph, node, &options);
        let text = printed(&part, width, &options).map_err(TestCaseError::fail)?;
        prop_assert_eq!(read_around(&text, graph, node), Ok(()), "{:?} in {}\n{}", options, width, text);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn machines_are_read_as_they_are(graph in any_graph(40)) {
        read_back(&graph)?;
    }

    #[test]
    fn narrow_machines_are_read_as_they_are(graph in any_graph(12), width in NARROWEST..100) {
        read_back_within(&graph, width)?;
    }

    #[test]
    fn surroundings_are_read_as_they_are(graph in any_graph(12), width in NARROWEST..100) {
        read_around_within(&graph, width)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20, ..ProptestConfig::default() })]

    #[test]
    fn large_machines_are_read_as_they_are(graph in any_graph(100), width in NARROWEST..300) {
        read_back(&graph)?;
        read_back_within(&graph, width)?;
    }
}

proptest! {
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
        let forms = [Form::Boxes, Form::Table, Form::Around(3), Form::Around(9)];
        for (glyphs, form) in forms.into_iter().flat_map(|form| [(Glyphs::Unicode, form), (Glyphs::Ascii, form)]) {
            let drawing = draw(&graph, &Options { form, glyphs, max_width: width, max_height: width, ..UNICODE });
            prop_assert_eq!(drawing.text().lines().count(), usize::from(drawing.height));
            for line in drawing.text().lines() {
                prop_assert!(!line.contains(char::is_control), "{:?}", line);
                prop_assert!(columns(line) <= usize::from(drawing.width), "{:?}", line);
            }
        }
    }
}
