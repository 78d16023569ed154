//! A finished drawing: cells that say what they show and what they belong to, so that a screen can colour them. Knows
//! nothing of how it was laid out.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use super::glyphs;
use super::layout::{Point, Rect, Shown};
use super::words;

/// What a cell belongs to. Numbers are indices into the nodes and edges of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Blank,
    /// The border of a node's box, and what of its inside is free.
    Box(usize),
    Name(usize),
    /// The mark of a nested machine.
    Mark(usize),
    /// Room for the name of the state that is active inside; blank in the drawing itself.
    Inside(usize),
    Line(usize),
    /// Two edges, both straight on.
    Crossing {
        across: usize,
        down: usize,
    },
    Label(usize),
    Head(usize),
    /// The name of the node that an edge leads to, where it ends without reaching its box.
    Target(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// `'\0'` where the wide character to the left continues. Combining characters are left out: [`Drawing::symbol`] has them.
    pub glyph: char,
    pub part: Part,
}

impl Cell {
    pub(super) const BLANK: Cell = Cell { glyph: ' ', part: Part::Blank };
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawing {
    /// In columns.
    pub width: u16,
    /// In rows.
    pub height: u16,
    pub(super) cells: Vec<Cell>,
    /// Clusters of more than one character, by the index of their cell.
    pub(super) clusters: BTreeMap<usize, String>,
    /// One for each node of the graph; `None` for what isn't shown.
    pub(super) boxes: Vec<Option<Rect>>,
    pub(super) rooms: Vec<Option<Rect>>,
    pub(super) shown: Shown,
    pub(super) means: Means,
}

/// What transitions are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Means {
    Lines,
    /// There was no room for lines: each has a row of text, as many as it needs.
    Words,
}

impl Drawing {
    pub fn means(&self) -> Means {
        self.means
    }

    /// Whether all texts are whole.
    pub fn is_whole(&self) -> bool {
        let Shown { names, labels } = &self.shown;
        names.iter().chain(labels).all(|text| differing(text).is_none())
    }

    /// All cells, row after row.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// A cell of the drawing; blank outside of it.
    pub fn cell(&self, x: u16, y: u16) -> Cell {
        self.index(x, y).map_or(Cell::BLANK, |i| self.cells[i])
    }

    /// What to print at a cell: nothing where a wide character continues.
    pub fn symbol(&self, x: u16, y: u16) -> Cow<'_, str> {
        match self.index(x, y) {
            None => Cow::Borrowed(" "),
            Some(i) => self.symbol_at(i),
        }
    }

    /// The box of a node, borders included; `None` if it isn't shown.
    pub fn node_rect(&self, node: usize) -> Option<Rect> {
        self.boxes.get(node).copied().flatten()
    }

    /// Where to write the name of the state that is active inside a node.
    pub fn inside_rect(&self, node: usize) -> Option<Rect> {
        self.rooms.get(node).copied().flatten()
    }

    /// The cell left of a node's name inside its box: free for a mark.
    pub fn beside_name(&self, node: usize) -> Option<Point> {
        let at = self.first(Part::Name(node))?;
        let (frame, inside) = (self.node_rect(node)?.x, self.cell(at.x.checked_sub(1)?, at.y).part);
        Some(Point { x: at.x - u16::from(at.x > frame + 1 && inside == Part::Box(node)), ..at })
    }

    /// The cell right of a node's name and its mark inside its box: free for a mark of another kind.
    pub fn after_name(&self, node: usize) -> Option<Point> {
        let name = self.first(Part::Name(node))?;
        let is_text = |x: &u16| matches!(self.cell(*x, name.y).part, Part::Name(n) | Part::Mark(n) if n == node);
        let last = (name.x..self.width).take_while(|x| is_text(x) || is_text(&(x + 1))).last()?;
        (self.cell(last + 1, name.y).part == Part::Box(node)).then_some(Point { x: last + 1, ..name })
    }

    /// The cell left of an edge's label where that is blank or its own line, else the label's first: for a mark.
    pub fn beside_label(&self, edge: usize) -> Option<Point> {
        let at = self.first(Part::Label(edge))?;
        let left = at.x.checked_sub(1).map(|x| Point { x, ..at });
        let free = left.filter(|left| matches!(self.cell(left.x, left.y).part, Part::Blank | Part::Line(_)));
        Some(free.unwrap_or(at))
    }

    fn first(&self, part: Part) -> Option<Point> {
        let at = self.cells.iter().position(|cell| cell.part == part)?;
        let width = usize::from(self.width).max(1);
        Some(super::layout::point(at % width, at / width))
    }

    /// All cells that show an edge: line, crossings, label, head and target, in reading order.
    pub fn edge_cells(&self, edge: usize) -> impl Iterator<Item = Point> + '_ {
        let width = usize::from(self.width).max(1);
        let cells = self.cells.iter().enumerate().filter(move |(_, cell)| match cell.part {
            Part::Line(e) | Part::Label(e) | Part::Head(e) | Part::Target(e) => e == edge,
            Part::Crossing { across, down } => across == edge || down == edge,
            _ => false,
        });
        cells.map(move |(i, _)| super::layout::point(i % width, i / width))
    }

    /// The line of an edge in heavy glyphs: where, and what to print there. Where there is no heavy glyph, as in ASCII,
    /// it is the one of the drawing.
    pub fn heavy_line(&self, edge: usize) -> impl Iterator<Item = (Point, char)> + '_ {
        self.edge_cells(edge).filter_map(move |at| {
            let Cell { glyph, part } = self.cell(at.x, at.y);
            match part {
                Part::Line(_) => Some((at, glyphs::heavy(glyph))),
                Part::Crossing { across, .. } if across == edge => Some((at, glyphs::heavy_across(glyph))),
                Part::Crossing { .. } => Some((at, glyphs::heavy_down(glyph))),
                _ => None,
            }
        })
    }

    /// The drawing as lines of text without trailing blanks, each ended by a line feed.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for row in 0..usize::from(self.height) {
            let start = row * usize::from(self.width);
            for i in start..start + usize::from(self.width) {
                out.push_str(&self.symbol_at(i));
            }
            out.truncate(out.trim_end_matches(' ').len());
            out.push('\n');
        }
        out
    }

    /// What the shortened names and labels are in full, as lines of text of at most `width` columns where that can be;
    /// nothing where all are whole. A line too long goes on below, further in.
    pub fn legend(&self, width: u16) -> String {
        let mut out = String::new();
        for (title, texts) in [("states", &self.shown.names), ("labels", &self.shown.labels)] {
            let texts = shortened(texts);
            if !texts.is_empty() {
                out.push_str(title);
                out.push('\n');
            }
            texts.iter().for_each(|(shown, whole)| out.push_str(&entry(shown, whole, width.into())));
        }
        out
    }

    /// What is shown of a node's name and what it is in full, where that differs.
    pub fn shortened_name(&self, node: usize) -> Option<(&str, &str)> {
        differing(self.shown.names.get(node)?)
    }

    /// What is shown of an edge's label and what it is in full, where that differs.
    pub fn shortened_label(&self, edge: usize) -> Option<(&str, &str)> {
        differing(self.shown.labels.get(edge)?)
    }

    pub(super) fn index(&self, x: u16, y: u16) -> Option<usize> {
        (x < self.width && y < self.height).then(|| usize::from(y) * usize::from(self.width) + usize::from(x))
    }

    fn symbol_at(&self, i: usize) -> Cow<'_, str> {
        match (self.clusters.get(&i), self.cells[i].glyph) {
            (Some(cluster), _) => Cow::Borrowed(cluster),
            (None, '\0') => Cow::Borrowed(""),
            (None, glyph) => Cow::Owned(glyph.to_string()),
        }
    }
}

fn differing((shown, whole): &(String, String)) -> Option<(&str, &str)> {
    (shown != whole).then_some((shown, whole))
}

/// Each text that isn't whole once.
fn shortened(texts: &[(String, String)]) -> Vec<(&str, &str)> {
    let mut known = BTreeSet::new();
    texts.iter().filter_map(differing).filter(|(shown, _)| known.insert(*shown)).collect()
}

/// `shown  whole`, broken where it is too long.
fn entry(shown: &str, whole: &str, width: usize) -> String {
    let text = format!("{shown}  {whole}");
    let clusters: Vec<(&str, usize)> = words::clusters(&text).collect();
    let rows = words::broken(&clusters, [2, 4].map(|indent| width.saturating_sub(indent)));
    let indents = std::iter::once("  ").chain(std::iter::repeat("    "));
    let line = |(row, indent): (std::ops::Range<usize>, &str)| {
        clusters[row].iter().fold(indent.to_owned(), |line, (cluster, _)| line + cluster) + "\n"
    };
    rows.into_iter().zip(indents).map(line).collect()
}
