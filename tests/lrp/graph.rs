//! The drawings of state machines: what they look like, and that a reader finds in them what was put in, nothing else.

mod machines;
mod random;

use std::path::PathBuf;

use lrp::ui::graph::{
    Drawing, Edge, EdgeKind, Form, Glyphs, Graph, Nested, NodeKind, Options, Part, Place, Point, Rows, dot, draw,
    mermaid,
};

use crate::tracer::{Seen, columns, trace};
use machines::{fixed_cases, full, graph, large_cases, line_follower, ring, search};

const UNICODE: Options = Options {
    form: Form::Boxes,
    glyphs: Glyphs::Unicode,
    max_width: None,
    max_height: None,
    place: Place::Left,
    rows: Rows::Two,
};
const ASCII: Options = Options { glyphs: Glyphs::Ascii, ..UNICODE };
const MIDDLE: Options = Options { place: Place::Middle, ..UNICODE };

const ONE_ROW: Options = Options { rows: Rows::One, ..UNICODE };
const TABLE: Options = Options { form: Form::Table, ..UNICODE };
const ASCII_TABLE: Options = Options { form: Form::Table, ..ASCII };
/// In columns beside each other, where the width has room for them.
const LOW_TABLE: Options = Options { max_height: Some(6), ..TABLE };
const ALL: [Options; 7] =
    [UNICODE, ASCII, ONE_ROW, TABLE, ASCII_TABLE, LOW_TABLE, Options { max_height: Some(6), ..ASCII_TABLE }];

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
        same_as_file(&format!("{name}_table"), &printed(&graph, 80, &LOW_TABLE).expect(name));
        same_as_file(&format!("{name}_table_ascii"), &printed(&graph, 44, &ASCII_TABLE).expect(name));
        let (part, options) = around(&graph, 1, &UNICODE);
        same_as_file(&format!("{name}_around"), &draw(&part, &options).text());
        same_as_file(
            &format!("{name}_around_ascii"),
            &draw(&part, &Options { glyphs: Glyphs::Ascii, ..options }).text(),
        );
    }
}

/// What is around a node, and how to draw that.
fn around(graph: &Graph, node: usize, options: &Options) -> (Graph, Options) {
    let (part, nodes) = graph.around(node);
    let center = nodes.iter().position(|&at| at == node).expect("it is in its own surroundings");
    (part, Options { form: Form::Around(center), ..*options })
}

/// What a reader should find around the node in the middle: its name first, the others sorted.
fn meant_around(graph: &Graph, node: usize) -> Seen {
    let any = |at: usize| graph.nodes[at].kind == NodeKind::Any;
    let concerns = |edge: &&Edge| edge.from == node || edge.to == node || any(edge.from);
    let edges: Vec<Edge> = graph.edges.iter().filter(concerns).cloned().collect();
    let all = meant(graph);
    let meant = meant(&Graph { nodes: graph.nodes.clone(), edges });
    let middle = &graph.nodes[node].name;
    let is_end = |name: &String| meant.edges.iter().any(|(from, to, _)| from == name || to == name);
    let mut states: Vec<_> = all.states.into_iter().filter(|(name, _)| name == middle || is_end(name)).collect();
    states.sort_by_key(|(name, nested)| (name != middle, name.clone(), *nested));
    Seen { states, edges: meant.edges }
}

/// A drawing too narrow for lines is a list, which has its states in their order.
fn read_around(text: &str, graph: &Graph, node: usize) -> Result<(), String> {
    let wanted = meant_around(graph, node);
    let mut seen = trace(text)?;
    seen.states.sort_by_key(|(name, nested)| (*name != graph.nodes[node].name, name.clone(), *nested));
    if seen == wanted { Ok(()) } else { Err(format!("{seen:?}\ninstead of {wanted:?}")) }
}

#[test]
fn surroundings_are_read_as_they_are() {
    for (name, graph) in fixed_cases().into_iter().chain(large_cases()) {
        for (node, options) in (0..graph.nodes.len()).flat_map(|node| [(node, UNICODE), (node, ASCII)]) {
            let (part, options) = around(&graph, node, &options);
            let text = draw(&part, &options).text();
            assert_eq!(read_around(&text, &graph, node), Ok(()), "{name}\n{text}");
            let first = trace(&text).map(|seen| seen.states[0].0.clone());
            assert_eq!(first.as_ref(), Ok(&graph.nodes[node].name), "{name}\n{text}");
        }
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
    for (name, graph) in fixed_cases().into_iter().chain(large_cases()) {
        for options in ALL {
            let text = draw(&graph, &options).text();
            assert_eq!(trace(&text), Ok(meant(&graph)), "{name}\n{text}");
        }
    }
}

/// A drawing with one glyph changed says something else, or nothing.
#[test]
fn the_tracer_notices_each_wrong_glyph() {
    for (name, graph) in fixed_cases() {
        let widths = [NARROWEST, 20, 24, 44, 80, u16::MAX];
        for (options, width) in ALL.into_iter().flat_map(|options| widths.map(|width| (options, width))) {
            let text = printed(&graph, width, &options).expect(name);
            for changed in changes(&text) {
                assert_ne!(trace(&changed), Ok(meant(&graph)), "{name}: unnoticed in\n{changed}");
            }
        }
        for node in 0..graph.nodes.len() {
            for (options, width) in
                [UNICODE, ASCII].into_iter().flat_map(|options| widths.map(|width| (options, width)))
            {
                let (part, options) = around(&graph, node, &options);
                let text = printed(&part, width, &options).expect(name);
                for changed in changes(&text) {
                    assert!(read_around(&changed, &graph, node).is_err(), "{name}: unnoticed in\n{changed}");
                }
            }
        }
    }
}

/// The text with each glyph replaced in turn.
fn changes(text: &str) -> impl Iterator<Item = String> {
    let glyphs = text.char_indices().filter(|(_, c)| !matches!(c, ' ' | '\n'));
    glyphs.flat_map(move |(at, glyph)| {
        wrong(glyph).into_iter().map(move |other| {
            let mut changed = text.to_owned();
            changed.replace_range(at..at + glyph.len_utf8(), &other.to_string());
            changed
        })
    })
}

/// What to put in a glyph's place: a blank, and what of its own sort means something else.
fn wrong(glyph: char) -> Vec<char> {
    let sorts = ["─│┼┌┐└┘", "►◄", "▲▼", "▷◁", "△▽", "⇡⇣", "-|+.'", "<>", "^v"];
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

/// What a drawing within `width` columns prints, with its legend; an error if it is wider.
fn printed(graph: &Graph, width: u16, options: &Options) -> Result<String, String> {
    let drawing = draw(graph, &Options { max_width: Some(width), ..*options });
    let text = drawing.text() + &drawing.legend(width);
    match text.lines().find(|line| columns(line) > usize::from(width)) {
        Some(line) => Err(format!("{line:?} is wider than {width} in\n{text}")),
        None => Ok(text),
    }
}

/// No machine of these tests has a letter for which there is less room.
const NARROWEST: u16 = 8;

#[test]
fn a_narrow_drawing_tells_everything() {
    for (name, graph) in fixed_cases() {
        for options in ALL.into_iter().chain([MIDDLE]) {
            for width in NARROWEST..draw(&graph, &options).width.min(100) + 8 {
                let text = printed(&graph, width, &options).expect(name);
                assert_eq!(trace(&text), Ok(meant(&graph)), "{name} in {width} columns\n{text}");
            }
        }
        for node in 0..graph.nodes.len() {
            for width in NARROWEST..80 {
                let (part, options) = around(&graph, node, &UNICODE);
                let text = printed(&part, width, &options).expect(name);
                assert_eq!(read_around(&text, &graph, node), Ok(()), "{name} in {width} columns\n{text}");
            }
        }
    }
}

#[test]
fn narrow_drawings_look_like_their_files() {
    for (name, width) in [("line_follower", 24), ("line_follower", 20), ("search", 8)] {
        let (_, graph) = fixed_cases().into_iter().find(|(known, _)| *known == name).expect(name);
        same_as_file(&format!("{name}_{width}"), &printed(&graph, width, &UNICODE).expect(name));
        same_as_file(&format!("{name}_{width}_ascii"), &printed(&graph, width, &ASCII).expect(name));
    }
}

/// On a screen a new line moves no box to another column, and none above it at all.
#[test]
fn a_new_line_leaves_the_boxes_where_they_are() {
    let screen = Options { max_width: Some(80), ..MIDDLE };
    for (name, before) in fixed_cases() {
        let (old, last) = (draw(&before, &screen), before.nodes.len() - 1);
        for (from, to) in [(last, 0), (0, last), (last, last), (last, last - 1)] {
            let mut after = before.clone();
            after.edges.push(Edge { from, to, label: "new".to_owned(), kind: EdgeKind::On, id: 99 });
            let new = draw(&after, &screen);
            let columns = |drawing: &Drawing, node| drawing.node_rect(node).map(|rect| (rect.x, rect.width));
            for node in 0..=last {
                assert_eq!(columns(&new, node), columns(&old, node), "{name} {from}->{to}\n{}", new.text());
            }
            for node in 0..from.min(to) {
                assert_eq!(new.node_rect(node), old.node_rect(node), "{name} {from}->{to}\n{}", new.text());
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

/// Without colours too: wildcards by their source, the others by what their lines are made of.
#[test]
fn the_kinds_of_edges_are_told_apart() {
    for (name, graph) in fixed_cases().into_iter().chain(large_cases()) {
        for form in [Form::Boxes, Form::Table] {
            let drawing = draw(&graph, &Options { form, ..UNICODE });
            for (i, edge) in graph.edges.iter().enumerate() {
                let is_own = |at: &Point| matches!(drawing.cell(at.x, at.y).part, Part::Line(_) | Part::Head(_));
                let glyphs = drawing.edge_cells(i).filter(is_own).map(|at| drawing.cell(at.x, at.y).glyph);
                let glyphs: String = glyphs.collect();
                let has = |any: &str| glyphs.contains(|c| any.contains(c));
                let told = [(EdgeKind::Eps, has("◁▷△▽")), (EdgeKind::Ontime, has("╌╎⇡⇣")), (EdgeKind::Exit, has("○"))];
                for (kind, told) in told {
                    assert_eq!(edge.kind == kind, told, "{name}: {kind:?} in {glyphs:?}");
                }
            }
        }
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
    assert_eq!(text(graph("a", &[])), "▌  a   ▐\n");
    assert_eq!(text(graph("a", &["a->a x"])), "▌  a   ▐─x─┐\n▌      ▐◄──┘\n");
    let edge = |from, to| Edge { from, to, label: "nowhere".to_owned(), kind: EdgeKind::On, id: 0 };
    assert_eq!(text(Graph { edges: vec![edge(0, 1), edge(7, 0)], ..graph("a", &[]) }), "▌  a   ▐\n");
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
