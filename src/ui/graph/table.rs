//! The states below each other, in one row each where their transitions fit beside them: for machines too long for lines.
//! Each transition is an arrow to the name of its target. Knows nothing of cells.

use super::glyphs::Way;
use super::layout::{Block, Layout, Point, Route, Words, cell, point, rect};
use super::texts::{Limits, Texts};
use super::{Graph, Options, Rows, words};

/// Columns of a box beside its text, half of them on either side.
const FRAME: usize = 4;
/// Columns of an arrow beside its texts: its beginning, one more of its line, the head and a blank.
const ARROW: usize = 4;
/// Columns between two arrows in a row.
const GAP: usize = 2;
/// Columns between two columns of boxes.
const GUTTER: usize = 3;

/// `None` if no texts keep to the width asked for that still tell what is whose.
pub fn layout(graph: &Graph, options: &Options) -> Option<Layout> {
    let table = |rows| {
        let texts = Texts::of(graph, &Options { rows, ..*options });
        Table { graph, options, texts, ways: ways(graph) }
    };
    // What is active inside gives way before anything is shortened.
    let (asked, narrow) = (table(options.rows), table(Rows::One));
    let whole = |table: &Table| table.within(table.texts.full());
    let shortened = || narrow.texts.full().longest(|limits| narrow.within(limits));
    whole(&asked).or_else(|| whole(&narrow)).or_else(shortened)
}

/// The edges out of each node.
fn ways(graph: &Graph) -> Vec<Vec<usize>> {
    let mut ways = vec![Vec::new(); graph.nodes.len()];
    for (i, edge) in graph.edges.iter().enumerate() {
        if edge.from.max(edge.to) < ways.len() {
            ways[edge.from].push(i);
        }
    }
    ways
}

struct Table<'a> {
    graph: &'a Graph,
    options: &'a Options,
    texts: Texts,
    ways: Vec<Vec<usize>>,
}

/// How many columns of boxes there are and how many arrows stand beside each other.
#[derive(Clone, Copy, Debug)]
struct Arrangement {
    columns: usize,
    across: usize,
}

/// How wide the widest texts are.
struct Sizes {
    /// In a box.
    text: usize,
    /// With its padding.
    label: usize,
    target: usize,
}

impl Sizes {
    fn arrow(&self) -> usize {
        ARROW + self.label + self.target
    }

    /// Of a column of boxes with its arrows.
    fn column(&self, across: usize) -> usize {
        let arrows = across * self.arrow() + across.saturating_sub(1) * GAP;
        FRAME + self.text + arrows
    }

    fn width(&self, Arrangement { columns, across }: Arrangement) -> usize {
        columns * self.column(across) + columns.saturating_sub(1) * GUTTER
    }
}

/// The rows of one box, and in which column of boxes it stands.
#[derive(Clone, Copy, Debug)]
struct Place {
    column: usize,
    top: usize,
    height: usize,
}

impl Table<'_> {
    /// With texts within these limits: the arrangement with the fewest columns and arrows in a row that fits the height
    /// asked for, else the lowest.
    fn within(&self, limits: Limits) -> Option<Layout> {
        let sizes = self.sizes(limits);
        let lowest = self.options.max_height.map_or(0, usize::from);
        let placed = self.arrangements(&sizes).map(|arrangement| (arrangement, self.placed(arrangement)));
        let (arrangement, places) = placed.min_by_key(|(_, places)| height(places).max(lowest))?;
        let names = self.texts.names_within(limits)?;
        let labels = self.texts.labels_within(limits)?;
        let nodes = 0..places.len();
        let x = |node: usize| places[node].column * (sizes.column(arrangement.across) + GUTTER);
        let mut routes: Vec<Option<Route>> = self.graph.edges.iter().map(|_| None).collect();
        for (node, ways) in self.ways.iter().enumerate() {
            for (i, &edge) in ways.iter().enumerate() {
                let (down, right) = (i / arrangement.across, i % arrangement.across);
                let x = x(node) + FRAME + sizes.text + right * (sizes.arrow() + GAP);
                let target = &names[self.graph.edges[edge].to];
                routes[edge] = Some(self.route(point(x, places[node].top + down), &sizes, &labels[edge], target));
            }
        }
        Some(Layout {
            width: cell(if places.is_empty() { 0 } else { sizes.width(arrangement) }),
            height: cell(height(&places)),
            blocks: nodes.map(|node| self.block(node, x(node), places[node], &sizes, &names[node])).collect(),
            routes,
            shown: self.texts.shown(names, labels),
        })
    }

    fn sizes(&self, limits: Limits) -> Sizes {
        let nodes = || 0..self.ways.len();
        let label = |edge| match self.texts.label_width(edge, limits) {
            0 => 0,
            width => width + 2 * self.texts.glyphs.label_padding(),
        };
        let target = |edge: usize| self.texts.bare_width(self.graph.edges[edge].to, limits);
        let edges = || self.ways.iter().flatten().copied();
        Sizes {
            text: nodes().map(|node| self.text_width(node, limits)).max().unwrap_or(0).max(1),
            label: edges().map(label).max().unwrap_or(0),
            target: edges().map(target).max().unwrap_or(0),
        }
    }

    /// A name, its mark and what is active inside stand in one row.
    fn text_width(&self, node: usize, limits: Limits) -> usize {
        let room = self.texts.room(node, limits);
        self.texts.name_width(node, limits) + if room > 0 { 1 + room } else { 0 }
    }

    /// Those that keep to the width. Several columns of boxes only serve a height.
    fn arrangements(&self, sizes: &Sizes) -> impl Iterator<Item = Arrangement> {
        let most = self.ways.iter().map(Vec::len).max().unwrap_or(0);
        let (columns, width) = match (self.options.max_width, self.options.max_height) {
            (Some(width), Some(_)) => (self.ways.len().max(1), usize::from(width)),
            (width, _) => (1, width.map_or(usize::MAX, usize::from)),
        };
        let across = move |columns| (most.min(1)..=most).map(move |across| Arrangement { columns, across });
        let keeps = move |arrangement: &Arrangement| sizes.width(*arrangement) <= width;
        (1..=columns)
            .map(move |columns| across(columns).take_while(keeps).collect())
            .take_while(|fit: &Vec<_>| !fit.is_empty())
            .flatten()
    }

    /// Boxes from top to bottom, then from left to right, as low as can be.
    fn placed(&self, Arrangement { columns, across }: Arrangement) -> Vec<Place> {
        let heights: Vec<usize> = self.ways.iter().map(|ways| ways.len().div_ceil(across.max(1)).max(1)).collect();
        let (mut low, mut high) = (heights.iter().max().copied().unwrap_or(0), heights.iter().sum());
        while low < high {
            let middle = (low + high) / 2;
            let used = stacked(&heights, middle).last().map_or(0, |place| place.column + 1);
            if used <= columns { high = middle } else { low = middle + 1 }
        }
        stacked(&heights, low)
    }

    fn block(&self, node: usize, x: usize, place: Place, sizes: &Sizes, name: &str) -> Block {
        let (after, mark) = (x + FRAME / 2 + words::width(name), self.texts.mark(node));
        let room = rect(after + mark + 1, place.top, (sizes.text + FRAME / 2 + x).saturating_sub(after + mark + 1), 1);
        Block {
            node,
            rect: rect(x, place.top, FRAME + sizes.text, place.height),
            name: Words { at: point(x + FRAME / 2, place.top), text: name.to_owned() },
            mark: (mark > 0).then(|| point(after + mark - 1, place.top)),
            inside: self.texts.has_room(node).then_some(room),
        }
    }

    /// From beside its box to as far as the longest label needs, so that all heads stand below each other.
    fn route(&self, at: Point, sizes: &Sizes, label: &str, target: &str) -> Route {
        let padding = cell(self.texts.glyphs.label_padding());
        let head = Point { x: at.x + cell(sizes.label) + 2, ..at };
        Route {
            points: vec![at, head],
            label: (!label.is_empty())
                .then(|| Words { at: Point { x: at.x + 1 + padding, ..at }, text: label.to_owned() }),
            target: Some(Words { at: Point { x: head.x + 2, ..at }, text: target.to_owned() }),
            head: Way::Right,
        }
    }
}

fn height(places: &[Place]) -> usize {
    places.iter().map(|place| place.top + place.height).max().unwrap_or(0)
}

/// Boxes of these heights below each other, in as many columns as they need to be no higher than `most` each.
fn stacked(heights: &[usize], most: usize) -> Vec<Place> {
    let (mut column, mut top) = (0, 0);
    let place = |&height: &usize| {
        if top > 0 && top + height > most {
            (column, top) = (column + 1, 0);
        }
        let place = Place { column, top, height };
        top += height;
        place
    };
    heights.iter().map(place).collect()
}
