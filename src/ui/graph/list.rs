//! The states from top to bottom, each with its edges below it as lines of text: for widths in which no lines can be drawn
//! right. All texts are whole; a row too long for the width goes on below, further in. Knows nothing of other views.

use std::collections::BTreeMap;

use super::drawing::{Cell, Drawing, Means, Part};
use super::glyphs::Way;
use super::layout::{Rect, Shown, cell, rect};
use super::{Edge, Glyphs, Graph, NodeKind, words};

/// Columns before an edge, and before what goes on below.
const EDGE: usize = 2;
const MORE: usize = 4;

/// Within `width` columns from eight on.
pub fn draw(graph: &Graph, glyphs: Glyphs, width: usize) -> Drawing {
    let mut list = List { glyphs, width, rows: Vec::new(), boxes: Vec::new() };
    for (index, node) in graph.nodes.iter().enumerate() {
        list.state(index, &words::clean(&node.name, glyphs), node.inside.is_some() && node.kind == NodeKind::State);
        for (id, edge) in graph.edges.iter().enumerate().filter(|(_, edge)| edge.from == index) {
            if let Some(target) = graph.nodes.get(edge.to) {
                list.edge(id, edge, &words::clean(&target.name, glyphs));
            }
        }
    }
    list.drawing()
}

struct List {
    glyphs: Glyphs,
    width: usize,
    rows: Vec<Vec<(String, Part)>>,
    boxes: Vec<Rect>,
}

impl List {
    fn state(&mut self, node: usize, name: &str, is_nested: bool) {
        let (left, right) = self.glyphs.borders();
        let mark = if is_nested { format!(" {}", self.glyphs.nested()) } else { String::new() };
        let frame = Part::Box(node);
        let top = self.rows.len();
        let pieces = [
            (format!("{left} "), frame),
            (name.to_owned(), Part::Name(node)),
            (mark, Part::Mark(node)),
            (format!(" {right}"), frame),
        ];
        self.row(0, &pieces);
        let width = self.rows[top..].iter().map(Vec::len).max().unwrap_or(0);
        self.boxes.push(rect(0, top, width, self.rows.len() - top));
    }

    fn edge(&mut self, id: usize, edge: &Edge, target: &str) {
        let padding = " ".repeat(self.glyphs.label_padding());
        let label = match words::clean(&edge.label, self.glyphs) {
            label if label.is_empty() => label,
            label => format!("{padding}{label}{padding}"),
        };
        let line = Part::Line(id);
        let pieces = [
            (self.glyphs.tail(edge.kind, Way::Right).to_string(), line),
            (label, Part::Label(id)),
            (self.glyphs.line(edge.kind, Way::Right).to_string(), line),
            (self.glyphs.head(edge.kind, Way::Right).to_string(), Part::Head(id)),
            (" ".to_owned(), Part::Blank),
            (target.to_owned(), Part::Target(id)),
        ];
        self.row(EDGE, &pieces);
    }

    /// Appends the pieces as one row, or as many as they need.
    fn row(&mut self, indent: usize, pieces: &[(String, Part)]) {
        let clusters: Vec<(&str, usize, Part)> = pieces
            .iter()
            .flat_map(|(text, part)| words::clusters(text).map(|(cluster, width)| (cluster, width, *part)))
            .collect();
        let widths: Vec<(&str, usize)> = clusters.iter().map(|(cluster, width, _)| (*cluster, *width)).collect();
        let rooms = [indent, MORE].map(|indent| self.width.saturating_sub(indent));
        for (i, range) in words::broken(&widths, rooms).into_iter().enumerate() {
            let indent = if i == 0 { indent } else { MORE };
            let mut row = vec![(" ".to_owned(), Part::Blank); indent];
            for &(cluster, width, part) in &clusters[range] {
                row.push((cluster.to_owned(), part));
                row.extend((1..width).map(|_| ("\0".to_owned(), part)));
            }
            self.rows.push(row);
        }
    }

    fn drawing(self) -> Drawing {
        let width = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut cells = vec![Cell::BLANK; width * self.rows.len()];
        let mut clusters = BTreeMap::new();
        for (y, row) in self.rows.into_iter().enumerate() {
            for (x, (cluster, part)) in row.into_iter().enumerate() {
                let i = y * width + x;
                cells[i] = Cell { glyph: cluster.chars().next().unwrap_or(' '), part };
                if cluster.chars().nth(1).is_some() {
                    clusters.insert(i, cluster);
                }
            }
        }
        Drawing {
            width: cell(width),
            height: cell(cells.len() / width.max(1)),
            cells,
            clusters,
            rooms: vec![None; self.boxes.len()],
            boxes: self.boxes.into_iter().map(Some).collect(),
            shown: Shown::default(),
            means: Means::Words,
        }
    }
}
