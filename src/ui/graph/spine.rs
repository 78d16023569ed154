//! The spine: all states in one column in source order. An edge between neighbours is an arrow in the gap between their
//! boxes; of the others, those that lead forward run on the right and those that lead back on the left. Each end has a
//! row of its box's border for itself. Knows nothing of cells.

use super::ends::{Ends, Flow};
use super::glyphs::Way;
use super::lanes::{self, Track};
use super::layout::{Block, Layout, Route, Words, cell, point, rect};
use super::words;
use super::{Glyphs, Graph, Options, Rows};

/// Rows between two boxes.
const GAP: usize = 1;
/// Columns between a label in a gap and the line next to it.
const CLEARANCE: usize = 2;
/// Columns of a box beside its text.
const FRAME: usize = 4;

pub fn layout(graph: &Graph, options: &Options) -> Layout {
    let spine = Spine::new(graph, options);
    let fitted = spine.fit(options.max_width.map(usize::from));
    spine.place(&fitted)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// How an edge runs. Rows are those of the drawing.
#[derive(Clone, Copy, Debug)]
enum Run {
    /// Down the gap in this row.
    Down(usize),
    /// Up the gap in this row.
    Up(usize),
    /// On a lane beside the boxes, between the rows of its ends.
    Beside { side: Side, from: usize, to: usize },
    /// Its ends are not in the graph.
    Nowhere,
}

/// The rows of everything; they don't depend on how long the labels may be.
struct Spine {
    glyphs: Glyphs,
    names: Vec<String>,
    labels: Vec<String>,
    marks: Vec<Option<usize>>,
    tops: Vec<usize>,
    heights: Vec<usize>,
    /// The row of each name, from the top of its box, and whether a row for the nested machine follows.
    name_rows: Vec<usize>,
    rows: Rows,
    runs: Vec<Run>,
    height: usize,
}

/// Upper bounds for the width of texts, in columns.
#[derive(Clone, Copy)]
struct Limits {
    name: usize,
    label: usize,
}

/// The columns of everything, for certain limits.
struct Columns {
    limits: Limits,
    /// Of a box, borders included.
    box_width: usize,
    left: Lanes,
    right: Lanes,
}

/// One side's lanes, as distances from the border of the boxes.
struct Lanes {
    edges: Vec<usize>,
    tracks: Vec<Track>,
    lanes: Vec<usize>,
    /// How far the side reaches.
    extent: usize,
}

impl Lanes {
    fn of(&self, edge: usize) -> Option<usize> {
        self.edges.binary_search(&edge).ok().map(|i| self.lanes[i])
    }

    /// The lane nearest to the boxes that passes this row.
    fn first_in(&self, row: usize) -> Option<usize> {
        let passing = self
            .tracks
            .iter()
            .zip(&self.lanes)
            .filter(|(track, _)| track.covers(row));
        passing.map(|(_, lane)| *lane).min()
    }
}

impl Columns {
    fn width(&self) -> usize {
        self.left.extent + self.box_width + self.right.extent
    }

    fn on(&self, side: Side) -> &Lanes {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }
}

impl Spine {
    fn new(graph: &Graph, options: &Options) -> Spine {
        let glyphs = options.glyphs;
        let ends = Ends::of(graph);
        let names: Vec<String> = graph
            .nodes
            .iter()
            .map(|node| words::clean(&node.name, glyphs))
            .collect();
        let marks = graph
            .nodes
            .iter()
            .map(|node| {
                node.inside
                    .as_deref()
                    .map(|name| words::width(&words::clean(name, glyphs)))
            })
            .collect::<Vec<_>>();
        let mut spine = Spine {
            glyphs,
            labels: graph
                .edges
                .iter()
                .map(|edge| words::clean(&edge.label, glyphs))
                .collect(),
            tops: Vec::new(),
            heights: Vec::new(),
            name_rows: Vec::new(),
            rows: options.rows,
            runs: Vec::new(),
            height: 0,
            names,
            marks,
        };
        for node in 0..graph.nodes.len() {
            let text = 1 + usize::from(spine.has_room_inside(node));
            let height = ends.left[node].len().max(ends.right[node].len()).max(text);
            spine
                .tops
                .push(spine.height + if node > 0 { GAP } else { 0 });
            spine.heights.push(height);
            spine.name_rows.push((height - text) / 2);
            spine.height = spine.tops[node] + height;
        }
        spine.runs = spine.runs(graph, &ends);
        spine
    }

    fn has_room_inside(&self, node: usize) -> bool {
        self.rows == Rows::Two && self.marks[node].is_some()
    }

    fn runs(&self, graph: &Graph, ends: &Ends) -> Vec<Run> {
        let mut runs = vec![Run::Nowhere; graph.edges.len()];
        for (node, &straight) in ends.straight.iter().enumerate() {
            let gap = self.tops[node] + self.heights[node];
            straight
                .down
                .into_iter()
                .for_each(|edge| runs[edge] = Run::Down(gap));
            straight
                .up
                .into_iter()
                .for_each(|edge| runs[edge] = Run::Up(gap));
        }
        for (side, ends) in [(Side::Left, &ends.left), (Side::Right, &ends.right)] {
            for (node, ends) in ends.iter().enumerate() {
                let first = self.tops[node] + (self.heights[node] - ends.len()) / 2;
                for (i, end) in ends.iter().enumerate() {
                    let row = first + i;
                    let run = &mut runs[end.edge];
                    let (mut from, mut to) = match *run {
                        Run::Beside { from, to, .. } => (from, to),
                        _ => (row, row),
                    };
                    match end.flow {
                        Flow::Out => from = row,
                        Flow::In => to = row,
                    }
                    *run = Run::Beside { side, from, to };
                }
            }
        }
        runs
    }

    /// The columns with the longest texts that keep to `max`, or with the shortest if none does.
    fn fit(&self, max: Option<usize>) -> Columns {
        let longest = |texts: &[String]| {
            texts
                .iter()
                .map(|text| words::width(text))
                .max()
                .unwrap_or(0)
                .max(1)
        };
        let full = Limits {
            name: longest(&self.names),
            label: longest(&self.labels),
        };
        let Some(max) = max else {
            return self.columns(full);
        };
        let fits = |limits: &Limits| self.columns(*limits).width() <= max;
        let shortest = Limits { label: 1, ..full };
        let limits = if fits(&shortest) {
            longest_that(full.label, |label| fits(&Limits { label, ..full }))
                .map_or(shortest, |label| Limits { label, ..full })
        } else {
            let name = longest_that(full.name, |name| fits(&Limits { name, ..shortest }));
            Limits {
                name: name.unwrap_or(1),
                ..shortest
            }
        };
        self.columns(limits)
    }

    fn columns(&self, limits: Limits) -> Columns {
        let text = (0..self.names.len())
            .map(|node| self.text_width(node, limits))
            .max()
            .unwrap_or(0);
        let box_width = if self.names.is_empty() {
            0
        } else {
            FRAME + text.max(1)
        };
        Columns {
            limits,
            box_width,
            left: self.lanes(Side::Left, limits, box_width),
            right: self.lanes(Side::Right, limits, box_width),
        }
    }

    /// What a box must have room for.
    fn text_width(&self, node: usize, limits: Limits) -> usize {
        let name = words::width(&self.names[node]).min(limits.name);
        match self.marks[node] {
            None => name,
            Some(inside) => (name + 2).max(if self.rows == Rows::Two {
                inside.min(limits.name)
            } else {
                0
            }),
        }
    }

    fn lanes(&self, side: Side, limits: Limits, box_width: usize) -> Lanes {
        let mut reach = vec![0; self.height];
        let (mut edges, mut tracks) = (Vec::new(), Vec::new());
        for (edge, run) in self.runs.iter().enumerate() {
            let label = words::width(&self.labels[edge]).min(limits.label);
            match *run {
                Run::Beside {
                    side: its,
                    from,
                    to,
                } if its == side => {
                    edges.push(edge);
                    tracks.push(Track::between(from, to));
                    reach[from] = self.reach_of_label(label);
                    reach[to] = 2;
                }
                Run::Down(row) if side == Side::Right => {
                    reach[row] = reach_in_gap(side, label, box_width)
                }
                Run::Up(row) if side == Side::Left => {
                    reach[row] = reach_in_gap(side, label, box_width)
                }
                _ => {}
            }
        }
        let lanes = lanes::assign(&tracks, &reach);
        let text = reach
            .iter()
            .map(|&reach| reach.saturating_sub(CLEARANCE))
            .max()
            .unwrap_or(0);
        let extent = lanes.iter().copied().max().unwrap_or(0).max(text);
        Lanes {
            edges,
            tracks,
            lanes,
            extent,
        }
    }

    /// The last column that a label in its line needs, with the piece of line on both sides.
    fn reach_of_label(&self, label: usize) -> usize {
        match label {
            0 => 1,
            _ => 2 + label + 2 * self.glyphs.label_padding(),
        }
    }

    fn place(&self, columns: &Columns) -> Layout {
        Layout {
            width: cell(columns.width()),
            height: cell(self.height),
            blocks: (0..self.names.len())
                .map(|node| self.block(node, columns))
                .collect(),
            routes: (0..self.runs.len())
                .map(|edge| self.route(edge, columns))
                .collect(),
        }
    }

    fn block(&self, node: usize, columns: &Columns) -> Block {
        let (x, y) = (columns.left.extent, self.tops[node]);
        let name = words::shorten(&self.names[node], columns.limits.name, self.glyphs);
        let marked = if self.marks[node].is_some() { 2 } else { 0 };
        let name_width = words::width(&name);
        let name_x = x + (columns.box_width - name_width - marked) / 2;
        let name_y = y + self.name_rows[node];
        Block {
            rect: rect(x, y, columns.box_width, self.heights[node]),
            name: Words {
                at: point(name_x, name_y),
                text: name,
            },
            mark: (marked > 0).then(|| point(name_x + name_width + 1, name_y)),
            inside: self
                .has_room_inside(node)
                .then(|| rect(x + FRAME / 2, name_y + 1, columns.box_width - FRAME, 1)),
        }
    }

    fn route(&self, edge: usize, columns: &Columns) -> Option<Route> {
        let middle = columns.left.extent + columns.box_width / 2;
        match self.runs[edge] {
            Run::Nowhere => None,
            Run::Down(row) => {
                let label = self.gap_label(edge, Side::Right, row, columns);
                let label = label.map(|text| Words {
                    at: point(middle + 3, row),
                    text,
                });
                Some(Route {
                    points: vec![point(middle + 1, row)],
                    label,
                    head: Way::Down,
                })
            }
            Run::Up(row) => {
                let label = self.gap_label(edge, Side::Left, row, columns);
                let label = label.map(|text| Words {
                    at: point(middle - 2 - words::width(&text), row),
                    text,
                });
                Some(Route {
                    points: vec![point(middle - 1, row)],
                    label,
                    head: Way::Up,
                })
            }
            Run::Beside { side, from, to } => {
                Some(self.route_beside(edge, side, from, to, columns))
            }
        }
    }

    fn route_beside(
        &self,
        edge: usize,
        side: Side,
        from: usize,
        to: usize,
        columns: &Columns,
    ) -> Route {
        let lanes = columns.on(side);
        let x = |distance: usize| match side {
            Side::Left => columns.left.extent - distance,
            Side::Right => columns.left.extent + columns.box_width - 1 + distance,
        };
        let lane = lanes.of(edge).unwrap_or(1);
        let padding = self.glyphs.label_padding();
        let room = lanes.first_in(from).unwrap_or(lane).saturating_sub(3 + 2 * padding);
        let text = words::shorten(&self.labels[edge], room, self.glyphs);
        let (near, far) = (2 + padding, 1 + padding + words::width(&text));
        let start = match side {
            Side::Left => x(far),
            Side::Right => x(near),
        };
        Route {
            points: vec![
                point(x(1), from),
                point(x(lane), from),
                point(x(lane), to),
                point(x(1), to),
            ],
            label: (!text.is_empty()).then(|| Words {
                at: point(start, from),
                text,
            }),
            head: match side {
                Side::Left => Way::Right,
                Side::Right => Way::Left,
            },
        }
    }

    /// A label beside an arrow in a gap, as long as the lanes beside it allow.
    fn gap_label(&self, edge: usize, side: Side, row: usize, columns: &Columns) -> Option<String> {
        let lanes = columns.on(side);
        let free = lanes.first_in(row).map_or(lanes.extent as isize, |lane| {
            lane as isize - 1 - CLEARANCE as isize
        });
        let room = free - overhang(side, 0, columns.box_width);
        let text = words::shorten(&self.labels[edge], room.max(0) as usize, self.glyphs);
        (!text.is_empty()).then_some(text)
    }
}

/// The last column that a label in a gap needs, with the clearance; 0 if it stays within the box's columns.
fn reach_in_gap(side: Side, label: usize, box_width: usize) -> usize {
    match label {
        0 => 0,
        _ => (overhang(side, label, box_width) + CLEARANCE as isize).max(0) as usize,
    }
}

/// How far a label in a gap ends beyond the border of the boxes; negative if it ends before it.
fn overhang(side: Side, label: usize, box_width: usize) -> isize {
    let beside_middle = match side {
        Side::Left => box_width / 2,
        Side::Right => box_width - box_width / 2 - 1,
    };
    label as isize + 2 - beside_middle as isize
}

/// The longest length up to `longest` for which a narrower drawing still fits, if any does.
fn longest_that(longest: usize, fits: impl Fn(usize) -> bool) -> Option<usize> {
    let (mut low, mut high) = (0, longest);
    while low < high {
        let middle = (low + high).div_ceil(2);
        if fits(middle) {
            low = middle
        } else {
            high = middle - 1
        }
    }
    (low > 0).then_some(low)
}
