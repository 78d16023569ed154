//! What is to be written into a drawing and how wide it is. Knows nothing of places.

use super::layout::Shown;
use super::{Glyphs, Graph, Node, Options, Rows, words};

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

/// All texts are shortened to this before any becomes shorter still.
const COMFORTABLE: usize = 8;
/// By less nobody knows a text again.
const LEAST: usize = 4;

impl Limits {
    /// What fits with the longest texts below these: labels become shorter before names do.
    pub fn longest<T>(mut self, fitted: impl Fn(Limits) -> Option<T>) -> Option<T> {
        [COMFORTABLE, LEAST].into_iter().find_map(|least| {
            let found = longest(least, self.label, |label| fitted(Limits { label, ..self }));
            self.label = self.label.min(least);
            let found = found.or_else(|| longest(least, self.name, |name| fitted(Limits { name, ..self })));
            self.name = self.name.min(least);
            found
        })
    }
}

/// What fits with the longest texts of `least` to `most` columns; with shorter ones nothing fits worse.
fn longest<T>(least: usize, most: usize, fitted: impl Fn(usize) -> Option<T>) -> Option<T> {
    let mut best = fitted(least.min(most))?;
    let (mut low, mut high) = (least.min(most), most);
    while low < high {
        let middle = (low + high).div_ceil(2);
        match fitted(middle) {
            Some(better) => (best, low) = (better, middle),
            None => high = middle - 1,
        }
    }
    Some(best)
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

    /// The width of a box's text, at least 1.
    pub fn width(&self, node: usize, limits: Limits) -> usize {
        self.name_width(node, limits).max(self.room(node, limits)).max(1)
    }

    /// The width of a name with its mark.
    pub fn name_width(&self, node: usize, limits: Limits) -> usize {
        self.bare_width(node, limits) + self.mark(node)
    }

    /// The width of a name.
    pub fn bare_width(&self, node: usize, limits: Limits) -> usize {
        words::width(&self.names[node]).min(limits.name)
    }

    /// The width of what may be active inside.
    pub fn room(&self, node: usize, limits: Limits) -> usize {
        match self.insides[node] {
            Inside::Room(room) => room.min(limits.name),
            Inside::No | Inside::Marked => 0,
        }
    }

    pub fn label_width(&self, edge: usize, limits: Limits) -> usize {
        words::width(&self.labels[edge]).min(limits.label)
    }

    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// What is shown of the names, each in its limit; `None` if that doesn't tell which is which.
    pub fn names_within(&self, limits: Limits) -> Option<Vec<String>> {
        let rooms: Vec<_> = self.names.iter().map(|name| (name.as_str(), limits.name)).collect();
        words::distinct(&rooms, self.glyphs)
    }

    /// What is shown of the labels, each in its limit.
    pub fn labels_within(&self, limits: Limits) -> Option<Vec<String>> {
        let rooms: Vec<_> = self.labels.iter().map(|label| (label.as_str(), limits.label)).collect();
        words::distinct(&rooms, self.glyphs)
    }

    /// The texts shown beside what they are in full.
    pub fn shown(&self, names: Vec<String>, labels: Vec<String>) -> Shown {
        let beside = |shown: Vec<String>, whole: &[String]| shown.into_iter().zip(whole.iter().cloned()).collect();
        Shown { names: beside(names, &self.names), labels: beside(labels, &self.labels) }
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
