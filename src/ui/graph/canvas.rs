//! Paints a layout into cells. Knows nothing of why things stand where they do.

use std::collections::BTreeMap;

use super::drawing::{Cell, Drawing, Means, Part};
use super::glyphs::Way;
use super::layout::{Block, Layout, Point, Rect, Route, Words};
use super::words;
use super::{EdgeKind, Glyphs, Graph};

pub fn paint(graph: &Graph, glyphs: Glyphs, layout: Layout) -> Drawing {
    let cells = vec![Cell::BLANK; usize::from(layout.width) * usize::from(layout.height)];
    let mut own: Vec<Option<&Block>> = vec![None; graph.nodes.len()];
    for block in layout.blocks.iter().rev() {
        own[block.node] = Some(block);
    }
    let drawing = Drawing {
        width: layout.width,
        height: layout.height,
        cells,
        clusters: BTreeMap::new(),
        boxes: own.iter().map(|block| block.map(|block| block.rect)).collect(),
        rooms: own.iter().map(|block| block.and_then(|block| block.inside)).collect(),
        shown: layout.shown,
        means: Means::Lines,
    };
    let mut canvas = Canvas { glyphs, drawing };
    for block in &layout.blocks {
        canvas.block(block);
    }
    for (edge, route) in layout.routes.iter().enumerate() {
        if let Some(route) = route {
            canvas.route(edge, graph.edges[edge].kind, route);
        }
    }
    canvas.drawing
}

struct Canvas {
    glyphs: Glyphs,
    drawing: Drawing,
}

impl Canvas {
    fn block(&mut self, block: &Block) {
        let node = block.node;
        let Rect { x, y, width, height } = block.rect;
        self.fill(block.rect, Part::Box(node));
        let (left, right) = self.glyphs.borders();
        for row in y..y.saturating_add(height) {
            self.set(Point { x, y: row }, left, Part::Box(node));
            self.set(Point { x: x.saturating_add(width - 1), y: row }, right, Part::Box(node));
        }
        if let Some(room) = block.inside {
            self.fill(room, Part::Inside(node));
        }
        if let Some(mark) = block.mark {
            self.set(mark, self.glyphs.nested(), Part::Mark(node));
        }
        self.write(&block.name, 0, Part::Name(node));
    }

    fn route(&mut self, edge: usize, kind: EdgeKind, route: &Route) {
        for ends in route.points.windows(2) {
            self.straight(edge, kind, ends[0], ends[1]);
        }
        for corner in route.points.windows(3) {
            let (before, after) = (way(corner[0], corner[1]), way(corner[1], corner[2]));
            self.set(corner[1], self.glyphs.corner(before, after), Part::Line(edge));
        }
        if let (Some(&tail), Some(&next)) = (route.points.first(), route.points.get(1)) {
            self.set(tail, self.glyphs.tail(kind, way(tail, next)), Part::Line(edge));
        }
        if let Some(&head) = route.points.last() {
            self.set(head, self.glyphs.head(kind, route.head), Part::Head(edge));
        }
        if let Some(label) = &route.label {
            let padding = if route.points.len() > 1 { self.glyphs.label_padding() } else { 0 };
            self.write(label, padding, Part::Label(edge));
        }
        if let Some(target) = &route.target {
            self.write(target, 0, Part::Target(edge));
        }
    }

    fn straight(&mut self, edge: usize, kind: EdgeKind, from: Point, to: Point) {
        let way = way(from, to);
        for y in from.y.min(to.y)..=from.y.max(to.y) {
            for x in from.x.min(to.x)..=from.x.max(to.x) {
                let at = Point { x, y };
                let (glyph, part) = match self.drawing.cell(x, y).part {
                    Part::Line(other) if other != edge => {
                        let (across, down) = if way.is_across() { (edge, other) } else { (other, edge) };
                        (self.glyphs.crossing(), Part::Crossing { across, down })
                    }
                    _ => (self.glyphs.line(kind, way), Part::Line(edge)),
                };
                self.set(at, glyph, part);
            }
        }
    }

    /// Writes a text with blanks of the same part on both sides of it.
    fn write(&mut self, words: &Words, padding: usize, part: Part) {
        let Point { x, y } = words.at;
        let padding = super::layout::cell(padding);
        let width = super::layout::cell(words::width(&words.text));
        self.fill(Rect { x: x.saturating_sub(padding), y, width: width.saturating_add(2 * padding), height: 1 }, part);
        let mut x = x;
        for (cluster, width) in words::clusters(&words.text) {
            let mut chars = cluster.chars();
            let (first, more) = (chars.next().unwrap_or(' '), chars.next().is_some());
            if let (Some(i), true) = (self.set(Point { x, y }, first, part), more) {
                self.drawing.clusters.insert(i, cluster.to_owned());
            }
            for _ in 1..width {
                x = x.saturating_add(1);
                self.set(Point { x, y }, '\0', part);
            }
            x = x.saturating_add(1);
        }
    }

    fn fill(&mut self, rect: Rect, part: Part) {
        for y in rect.y..rect.y.saturating_add(rect.height) {
            for x in rect.x..rect.x.saturating_add(rect.width) {
                self.set(Point { x, y }, ' ', part);
            }
        }
    }

    /// Sets a cell and says its index, if it is inside.
    fn set(&mut self, at: Point, glyph: char, part: Part) -> Option<usize> {
        let i = self.drawing.index(at.x, at.y)?;
        self.drawing.cells[i] = Cell { glyph, part };
        Some(i)
    }
}

/// The way from one point to another in the same row or column.
fn way(from: Point, to: Point) -> Way {
    match (from.x.cmp(&to.x), from.y.cmp(&to.y)) {
        (std::cmp::Ordering::Less, _) => Way::Right,
        (std::cmp::Ordering::Greater, _) => Way::Left,
        (_, std::cmp::Ordering::Greater) => Way::Up,
        _ => Way::Down,
    }
}
