//! The drawings of state machines: what they look like, and that a reader finds in them what was put in, nothing else.

mod machines;
mod random;

use std::cmp::Reverse;
use std::path::PathBuf;

use lrp::ui::graph::{Edge, EdgeKind, Glyphs, Graph, Nested, Options, Part, Rows, dot, draw, mermaid};

use crate::tracer::{Seen, trace};
use machines::{fixed_cases, full, graph, line_follower, ring, search};

const UNICODE: Options = Options { glyphs: Glyphs::Unicode, max_width: None, rows: Rows::Two };
const ASCII: Options = Options { glyphs: Glyphs::Ascii, max_width: None, rows: Rows::Two };

const ONE_ROW: Options = Options { rows: Rows::One, ..UNICODE };

/// Compares a drawing with its file; `UPDATE=1` writes the file instead.
fn same_as_file(name: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/graph").join(format!("{name}.txt"));
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, text).expect("the file can be written");
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(text == expected, "{} differs; UPDATE=1 rewrites it. Now it is\n{text}", path.display());
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
    let mut edges: Vec<_> = graph.edges.iter().map(|e| (name(e.from), name(e.to), e.label.clone())).collect();
    edges.sort();
    Seen { states: graph.nodes.iter().map(|node| (node.name.clone(), node.inside.is_some())).collect(), edges }
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
            for (at, glyph) in text.char_indices().filter(|(_, c)| !matches!(c, ' ' | '\n')) {
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
    let sort = sorts.iter().find(|sort| sort.contains(glyph)).copied().unwrap_or("");
    std::iter::once(' ').chain(sort.chars().filter(|c| *c != glyph)).collect()
}

#[test]
fn drawings_stay_within_the_sizes_to_beat() {
    let fits = |graph: &Graph, width: u16, height: u16| {
        let drawing = draw(graph, &UNICODE);
        let size = (drawing.width, drawing.height);
        assert!(size.0 <= width && size.1 <= height, "{size:?} is not within {width}x{height}");
    };
    fits(&line_follower(), 34, 23);
    fits(&full(), 80, 24);
    fits(&ring(), 80, 24);
}

/// What is read from a drawing within `width` columns, if that leaves all names whole. Its labels may be shortened.
fn narrowed(graph: &Graph, width: u16, options: &Options) -> Option<Result<Seen, String>> {
    let drawing = draw(graph, &Options { max_width: Some(width), ..*options });
    let text = drawing.text();
    let whole = graph.nodes.iter().all(|node| text.contains(&format!(" {} ", node.name)));
    (whole && drawing.width <= width).then(|| trace(&text).map_err(|error| format!("{error}\n{text}")))
}

/// Whether `seen` has the edges of `meant`, some with the first part of their label and an ellipsis.
fn shortens(seen: &Seen, meant: &Seen) -> bool {
    let part = |label: &str| label.strip_suffix(['…', '~']).map(str::to_owned);
    let fits = |label: &str, full: &str| {
        let shortened = |part: String| part.len() < full.len() && full.starts_with(&part);
        label == full || part(label).is_some_and(shortened)
    };
    // Whole labels are found first, then the longest, so that none takes what only another fits.
    let (whole, mut edges): (Vec<_>, Vec<_>) = seen.edges.iter().partition(|edge| meant.edges.contains(edge));
    edges.sort_by_key(|(_, _, label)| Reverse(label.len()));
    let mut left = meant.edges.clone();
    let mut takes = |(from, to, label): &(String, String, String)| {
        let exact = left.iter().position(|edge| edge == &(from.clone(), to.clone(), label.clone()));
        let same = |(f, t, full): &(String, String, String)| f == from && t == to && fits(label, full);
        let found = exact.or_else(|| left.iter().position(same));
        found.map(|i| left.swap_remove(i)).is_some()
    };
    seen.states == meant.states
        && seen.edges.len() == meant.edges.len()
        && whole.into_iter().chain(edges).all(&mut takes)
}

#[test]
fn a_narrow_drawing_shortens_labels_and_keeps_every_edge() {
    for (name, graph) in fixed_cases() {
        for options in [UNICODE, ASCII] {
            let full = draw(&graph, &options).width;
            let narrower: Vec<Seen> = (0..full)
                .rev()
                .map_while(|width| narrowed(&graph, width, &options))
                .map(|seen| seen.expect(name))
                .collect();
            assert!(!narrower.is_empty(), "{name} can't be narrowed");
            for seen in narrower {
                assert!(shortens(&seen, &meant(&graph)), "{name} became {seen:#?}");
            }
        }
    }
}

/// The cells say what they belong to, so that a screen can colour them.
#[test]
fn cells_know_their_part() {
    for (name, graph) in fixed_cases() {
        let drawing = draw(&graph, &UNICODE);
        let with = |part: Part| {
            drawing.cells().iter().filter(|cell| cell.part == part).map(|cell| cell.glyph).collect::<String>()
        };
        for (i, node) in graph.nodes.iter().enumerate() {
            assert_eq!(with(Part::Name(i)), node.name, "{name}");
            let rect = drawing.node_rect(i).expect("a box");
            assert_eq!(drawing.cell(rect.x, rect.y).part, Part::Box(i), "{name}");
            assert_eq!(drawing.cell(rect.x + rect.width - 1, rect.y + rect.height - 1).part, Part::Box(i), "{name}");
            let room = node.inside.as_ref().map(|inside| inside.len() as u16);
            assert!(drawing.inside_rect(i).map(|room| room.width) >= room, "{name}: no room inside {}", node.name);
        }
        for (i, edge) in graph.edges.iter().enumerate() {
            assert_eq!(with(Part::Label(i)), edge.label, "{name}");
            assert_eq!(with(Part::Head(i)).chars().count(), 1, "{name}");
        }
        assert_eq!(with(Part::Blank).trim(), "", "{name}");
    }
}

#[test]
fn a_taken_edge_stands_out_in_heavy_lines_without_moving() {
    let graph = line_follower();
    let drawing = draw(&graph, &UNICODE);
    let bumping = 4;
    let heavy: String = drawing.heavy_line(bumping).map(|(_, glyph)| glyph).collect();
    let light: String = drawing
        .edge_cells(bumping)
        .filter(|at| matches!(drawing.cell(at.x, at.y).part, Part::Line(_) | Part::Crossing { .. }))
        .map(|at| drawing.cell(at.x, at.y).glyph)
        .collect();
    assert_eq!(light, "┌┼───────│││││└──");
    assert_eq!(heavy, "┏┿━━━━━━━┃┃┃┃┃┗━━");
}

#[test]
fn small_drawings() {
    let text = |graph: Graph| draw(&graph, &UNICODE).text();
    assert_eq!(text(Graph::default()), "");
    assert_eq!(text(graph("a", &[])), "▌ a ▐\n");
    assert_eq!(text(graph("a", &["a->a x"])), "▌ a ▐─x─┐\n▌   ▐◄──┘\n");
    let edge = |from, to| Edge { from, to, label: "nowhere".to_owned(), kind: EdgeKind::On, id: 0 };
    assert_eq!(text(Graph { edges: vec![edge(0, 1), edge(7, 0)], ..graph("a", &[]) }), "▌ a ▐\n");
}

fn nested() -> Nested {
    Nested {
        name: "follower".to_owned(),
        graph: line_follower(),
        children: vec![(1, Nested { name: "look \"around\"".to_owned(), graph: search(), children: Vec::new() })],
    }
}

#[test]
fn exports_look_like_their_files() {
    same_as_file("line_follower.dot", &dot(&nested()));
    same_as_file("line_follower.mermaid", &mermaid(&nested()));
}
