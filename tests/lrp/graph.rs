//! The drawings of state machines: what they look like, and that a reader finds in them what was put in, nothing else.

use std::path::PathBuf;

use proptest::prelude::*;

use lrp::ui::graph::{Edge, EdgeKind, Glyphs, Graph, Node, NodeKind, Options, Rows, draw};

use crate::tracer::{Seen, trace};

const UNICODE: Options = Options {
    glyphs: Glyphs::Unicode,
    max_width: None,
    rows: Rows::Two,
};
const ASCII: Options = Options {
    glyphs: Glyphs::Ascii,
    max_width: None,
    rows: Rows::Two,
};

const ONE_ROW: Options = Options {
    rows: Rows::One,
    ..UNICODE
};

/// A graph in a line of words: nodes `a b(room) *`, edges `a->b label`; a label's first character may tell the kind.
fn graph(nodes: &str, edges: &[&str]) -> Graph {
    let nodes: Vec<Node> = nodes.split_whitespace().map(node).collect();
    let index = |name: &str| {
        nodes
            .iter()
            .position(|node| node.name == name)
            .unwrap_or_else(|| panic!("no node {name}"))
    };
    let edges = edges.iter().enumerate().map(|(id, text)| {
        let (ends, label) = text.split_once(' ').unwrap_or((text, ""));
        let (from, to) = ends.split_once("->").expect("an arrow");
        Edge {
            from: index(from),
            to: index(to),
            label: label.to_owned(),
            kind: kind(from, label),
            id: id as u32,
        }
    });
    let edges = edges.collect();
    Graph { nodes, edges }
}

fn node(word: &str) -> Node {
    let (name, inside) = match word.split_once('(') {
        Some((name, room)) => (name, Some(room.trim_end_matches(')').to_owned())),
        None => (word, None),
    };
    let kind = if name == "*" {
        NodeKind::Any
    } else {
        NodeKind::State
    };
    Node {
        name: name.to_owned(),
        kind,
        inside,
    }
}

fn kind(from: &str, label: &str) -> EdgeKind {
    match label {
        _ if from == "*" => EdgeKind::Wildcard,
        "eps" => EdgeKind::Eps,
        _ if label.starts_with("exit") => EdgeKind::Exit,
        _ if label.ends_with("ms") && label.starts_with(|c: char| c.is_ascii_digit()) => {
            EdgeKind::Ontime
        }
        _ => EdgeKind::On,
    }
}

fn tick_tock() -> Graph {
    graph("tick tock", &["tick->tock 500ms", "tock->tick 500ms"])
}

fn line_follower() -> Graph {
    graph(
        "moving looking(returnright) bumpback bumpturn end *",
        &[
            "moving->looking outofline",
            "looking->moving intheline",
            "bumpback->bumpturn 1000ms",
            "bumpturn->looking 3000ms",
            "*->bumpback bumping",
            "*->end ending",
        ],
    )
}

fn search() -> Graph {
    graph(
        "lookleft returnleft lookright returnright",
        &[
            "lookleft->returnleft treturnleft",
            "returnleft->lookright tlookright",
            "lookright->returnright treturnright",
            "returnright->lookleft tlookleft",
        ],
    )
}

/// Five states, each with an edge to every other.
fn full() -> Graph {
    let names = ["alpha", "beta", "gamma", "delta", "omega"];
    let mut edges = Vec::new();
    for from in names {
        for to in names.iter().filter(|to| **to != from) {
            edges.push(format!("{from}->{to} {}2{}", &from[..1], &to[..1]));
        }
    }
    graph(
        &names.join(" "),
        &edges.iter().map(String::as_str).collect::<Vec<_>>(),
    )
}

/// A ring of twelve with six chords.
fn ring() -> Graph {
    let ring = (0..12).map(|i| format!("s{i}->s{} next{i}", (i + 1) % 12));
    let chords = (0..6).map(|i| format!("s{i}->s{} chord{i}", i + 6));
    let edges: Vec<String> = ring.chain(chords).collect();
    let names: Vec<String> = (0..12).map(|i| format!("s{i}")).collect();
    graph(
        &names.join(" "),
        &edges.iter().map(String::as_str).collect::<Vec<_>>(),
    )
}

fn loops() -> Graph {
    graph(
        "idle work(step) done",
        &[
            "idle->idle again",
            "idle->work start",
            "work->work retry",
            "work->work 250ms",
            "work->idle eps",
            "work->done exit done",
            "done->idle eps",
        ],
    )
}

/// Compares a drawing with its file; `UPDATE=1` writes the file instead.
fn same_as_file(name: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/corpus/graph")
        .join(format!("{name}.txt"));
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, text).expect("the file can be written");
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        text == expected,
        "{} differs; UPDATE=1 rewrites it. Now it is\n{text}",
        path.display()
    );
}

#[test]
fn drawings_look_like_their_files() {
    for (name, graph) in fixed_cases() {
        same_as_file(name, &draw(&graph, &UNICODE).text());
        same_as_file(&format!("{name}_ascii"), &draw(&graph, &ASCII).text());
    }
}

/// What a reader should find.
fn meant(graph: &Graph) -> Seen {
    let name = |i: usize| graph.nodes[i].name.clone();
    let mut edges: Vec<_> = graph
        .edges
        .iter()
        .map(|e| (name(e.from), name(e.to), e.label.clone()))
        .collect();
    edges.sort();
    Seen {
        states: graph
            .nodes
            .iter()
            .map(|node| (node.name.clone(), node.inside.is_some()))
            .collect(),
        edges,
    }
}

fn fixed_cases() -> [(&'static str, Graph); 6] {
    [
        ("tick_tock", tick_tock()),
        ("line_follower", line_follower()),
        ("search", search()),
        ("full", full()),
        ("ring", ring()),
        ("loops", loops()),
    ]
}

#[test]
fn fixed_machines_are_read_as_they_are() {
    for (name, graph) in fixed_cases() {
        for options in [UNICODE, ASCII, ONE_ROW] {
            let text = draw(&graph, &options).text();
            assert_eq!(trace(&text), Ok(meant(&graph)), "{name}\n{text}");
        }
    }
}

/// A drawing with one glyph changed says something else, or nothing.
#[test]
fn the_tracer_notices_each_wrong_glyph() {
    for (name, graph) in fixed_cases() {
        for options in [UNICODE, ASCII] {
            let text = draw(&graph, &options).text();
            for (at, glyph) in text
                .char_indices()
                .filter(|(_, c)| !matches!(c, ' ' | '\n'))
            {
                for other in wrong(glyph) {
                    let mut changed = text.clone();
                    changed.replace_range(at..at + glyph.len_utf8(), &other.to_string());
                    assert_ne!(
                        trace(&changed),
                        Ok(meant(&graph)),
                        "{name}: {other:?} for {glyph:?} goes unnoticed in\n{changed}"
                    );
                }
            }
        }
    }
}

/// What to put in a glyph's place: a blank, and what of its own sort means something else.
fn wrong(glyph: char) -> Vec<char> {
    let sorts = ["─│┼┌┐└┘", "►◄", "▲▼", "▷◁", "△▽", "-|+.'", "<>", "^v"];
    let sort = sorts
        .iter()
        .find(|sort| sort.contains(glyph))
        .copied()
        .unwrap_or("");
    std::iter::once(' ')
        .chain(sort.chars().filter(|c| *c != glyph))
        .collect()
}

/// A graph of up to `most` states, the last of them perhaps `*`, with up to four times as many edges of all kinds.
fn any_graph(most: usize) -> impl Strategy<Value = Graph> {
    (2..=most, any::<bool>()).prop_flat_map(|(count, wildcard)| {
        let nodes =
            prop::collection::vec((any_name(), prop::option::weighted(0.2, any_name())), count);
        let edge = (0..count, 0..count, any_label(), 0..4usize);
        (nodes, prop::collection::vec(edge, 0..=4 * count))
            .prop_map(move |(nodes, edges)| built(nodes, edges, wildcard))
    })
}

fn built(
    nodes: Vec<(String, Option<String>)>,
    edges: Vec<(usize, usize, String, usize)>,
    wildcard: bool,
) -> Graph {
    let last = nodes.len() - 1;
    let is_any = |i: usize| wildcard && i == last;
    let node = |(i, (name, inside))| match is_any(i) {
        true => Node {
            name: "*".to_owned(),
            kind: NodeKind::Any,
            inside: None,
        },
        false => Node {
            name: format!("{name}{i}"),
            kind: NodeKind::State,
            inside,
        },
    };
    let edge = |(id, (from, to, label, kind)): (usize, (usize, usize, String, usize))| {
        let kind = [
            EdgeKind::On,
            EdgeKind::Eps,
            EdgeKind::Ontime,
            EdgeKind::Exit,
        ][kind];
        let kind = if is_any(from) {
            EdgeKind::Wildcard
        } else {
            kind
        };
        Edge {
            from,
            to,
            label,
            kind,
            id: id as u32,
        }
    };
    let edges = edges
        .into_iter()
        .enumerate()
        .map(edge)
        .filter(|edge| !is_any(edge.to));
    Graph {
        edges: edges.collect(),
        nodes: nodes.into_iter().enumerate().map(node).collect(),
    }
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
