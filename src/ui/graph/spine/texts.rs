//! What is to be written into a spine and how wide it is. Knows nothing of places.

use crate::ui::graph::{Glyphs, Graph, Node, Options, Rows, words};

/// What a box shows of a nested machine.
#[derive(Clone, Copy, Debug)]
enum Inside {
    No,
    Marked,
    /// Marked, with a row that has room for a name of so many columns.
    Room(usize),
}

/// Columns of the mark of a nested machine, with the blank before it.
const MARK: usize = 2;

pub struct Texts {
    pub glyphs: Glyphs,
    names: Vec<String>,
    labels: Vec<String>,
    insides: Vec<Inside>,
}

/// Upper bounds for the width of texts, in columns. That of names also holds for names inside.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    pub name: usize,
    pub label: usize,
}

impl Texts {
    pub fn of(graph: &Graph, options: &Options) -> Texts {
        let glyphs = options.glyphs;
        let clean = |text: &String| words::clean(text, glyphs);
        let inside = |node: &Node| match (&node.inside, options.rows) {
            (None, _) => Inside::No,
            (Some(_), Rows::One) => Inside::Marked,
            (Some(name), Rows::Two) => Inside::Room(words::width(&clean(name))),
        };
        Texts {
            glyphs,
            names: graph.nodes.iter().map(|node| clean(&node.name)).collect(),
            labels: graph.edges.iter().map(|edge| clean(&edge.label)).collect(),
            insides: graph.nodes.iter().map(inside).collect(),
        }
    }

    /// The limits that shorten nothing; each is at least 1.
    pub fn full(&self) -> Limits {
        let widths = |texts: &[String]| texts.iter().map(|text| words::width(text)).max();
        let room = self.insides.iter().map(|inside| match inside {
            Inside::Room(room) => *room,
            Inside::No | Inside::Marked => 0,
        });
        Limits {
            name: widths(&self.names).max(room.max()).unwrap_or(0).max(1),
            label: widths(&self.labels).unwrap_or(0).max(1),
        }
    }

    /// The width of the widest box's text, at least 1.
    pub fn widest(&self, limits: Limits) -> usize {
        let nodes = 0..self.names.len();
        let width = |node: usize| {
            let name = words::width(&self.names[node]).min(limits.name) + self.mark(node);
            match self.insides[node] {
                Inside::Room(room) => name.max(room.min(limits.name)),
                _ => name,
            }
        };
        nodes.map(width).max().unwrap_or(0).max(1)
    }

    pub fn label_width(&self, edge: usize, limits: Limits) -> usize {
        words::width(&self.labels[edge]).min(limits.label)
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// One for each edge.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// The columns that the mark of a nested machine takes beside the name.
    pub fn mark(&self, node: usize) -> usize {
        match self.insides[node] {
            Inside::No => 0,
            Inside::Marked | Inside::Room(_) => MARK,
        }
    }

    pub fn has_room(&self, node: usize) -> bool {
        matches!(self.insides[node], Inside::Room(_))
    }

    /// The rows of text in a box.
    pub fn rows(&self, node: usize) -> usize {
        if self.has_room(node) { 2 } else { 1 }
    }
}
