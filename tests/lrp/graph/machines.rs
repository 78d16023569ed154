//! The machines that drawings are tried on.

use lrp::ui::graph::{Edge, EdgeKind, Graph, Node, NodeKind};

/// A graph in a line of words: nodes `a b(room) *`, edges `a->b label`; a label's first character may tell the kind.
pub fn graph(nodes: &str, edges: &[&str]) -> Graph {
    let nodes: Vec<Node> = nodes.split_whitespace().map(node).collect();
    let index =
        |name: &str| nodes.iter().position(|node| node.name == name).unwrap_or_else(|| panic!("no node {name}"));
    let edges = edges.iter().enumerate().map(|(id, text)| {
        let (ends, label) = text.split_once(' ').unwrap_or((text, ""));
        let (from, to) = ends.split_once("->").expect("an arrow");
        Edge { from: index(from), to: index(to), label: label.to_owned(), kind: kind(from, label), id: id as u32 }
    });
    let edges = edges.collect();
    Graph { nodes, edges }
}

fn node(word: &str) -> Node {
    let (name, inside) = match word.split_once('(') {
        Some((name, room)) => (name, Some(room.trim_end_matches(')').to_owned())),
        None => (word, None),
    };
    let kind = if name == "*" { NodeKind::Any } else { NodeKind::State };
    Node { name: name.to_owned(), kind, inside }
}

fn kind(from: &str, label: &str) -> EdgeKind {
    match label {
        _ if from == "*" => EdgeKind::Wildcard,
        "eps" => EdgeKind::Eps,
        _ if label.starts_with("exit") => EdgeKind::Exit,
        _ if label.ends_with("ms") && label.starts_with(|c: char| c.is_ascii_digit()) => EdgeKind::Ontime,
        _ => EdgeKind::On,
    }
}

pub fn tick_tock() -> Graph {
    graph("tick tock", &["tick->tock 500ms", "tock->tick 500ms"])
}

pub fn line_follower() -> Graph {
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

pub fn search() -> Graph {
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
pub fn full() -> Graph {
    let names = ["alpha", "beta", "gamma", "delta", "omega"];
    let mut edges = Vec::new();
    for from in names {
        for to in names.iter().filter(|to| **to != from) {
            edges.push(format!("{from}->{to} {}2{}", &from[..1], &to[..1]));
        }
    }
    graph(&names.join(" "), &edges.iter().map(String::as_str).collect::<Vec<_>>())
}

/// A ring of twelve with six chords.
pub fn ring() -> Graph {
    let ring = (0..12).map(|i| format!("s{i}->s{} next{i}", (i + 1) % 12));
    let chords = (0..6).map(|i| format!("s{i}->s{} chord{i}", i + 6));
    let edges: Vec<String> = ring.chain(chords).collect();
    let names: Vec<String> = (0..12).map(|i| format!("s{i}")).collect();
    graph(&names.join(" "), &edges.iter().map(String::as_str).collect::<Vec<_>>())
}

pub fn loops() -> Graph {
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

pub fn fixed_cases() -> [(&'static str, Graph); 6] {
    [
        ("tick_tock", tick_tock()),
        ("line_follower", line_follower()),
        ("search", search()),
        ("full", full()),
        ("ring", ring()),
        ("loops", loops()),
    ]
}

/// Machines as large programs have them: one edge to the next state, of the others most to one nearby and some far. The
/// last is as dense as none should be.
pub fn large_cases() -> [(&'static str, Graph); 5] {
    [
        ("20 states", large(20, 2)),
        ("30 states", large(30, 2)),
        ("50 states", large(50, 2)),
        ("100 states", large(100, 2)),
        ("100 states, dense", large(100, 4)),
    ]
}

fn large(states: usize, edges_each: usize) -> Graph {
    let mut seed = states as u64;
    let mut any = |below: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % below
    };
    let mut edges = Vec::new();
    for from in 0..states {
        for nth in 0..edges_each {
            let to = match (nth, any(4)) {
                (0, _) => from + 1,
                (_, 0) => any(states),
                _ => from + any(9) + states - 4,
            };
            let label = ["start", "outofline", "500ms", "eps", "bumping"][any(5)];
            edges.push(format!("state{from}->state{} {label}", to % states));
        }
    }
    let names: Vec<String> = (0..states).map(|i| format!("state{i}")).collect();
    graph(&names.join(" "), &edges.iter().map(String::as_str).collect::<Vec<_>>())
}
