//! The columns of a spine: how wide its boxes are and which lane each edge has, within a given width. Knows nothing of
//! what stands in the boxes' rows.

use super::lanes::{self, Track};
use super::stack::Stack;
use super::texts::{Limits, Texts};
use super::{Run, Side};

/// Columns between a label in a gap and the line next to it.
const CLEARANCE: usize = 2;
/// Columns of a box beside its text, half of them on either side.
pub const FRAME: usize = 4;

pub struct Columns {
    pub limits: Limits,
    /// Of each box, borders included.
    pub box_width: usize,
    pub left: Lanes,
    pub right: Lanes,
}

/// One side's lanes, as distances from the border of the boxes.
pub struct Lanes {
    edges: Vec<usize>,
    tracks: Vec<Track>,
    lanes: Vec<usize>,
    /// How far the side reaches.
    pub extent: usize,
}

impl Columns {
    /// With the longest texts that keep to `max`, or with the shortest if none do.
    pub fn fit(stack: &Stack, texts: &Texts, max: Option<usize>) -> Columns {
        let full = texts.full();
        let wide = Columns::new(stack, texts, full);
        let Some(max) = max.filter(|max| *max < wide.width()) else {
            return wide;
        };
        let fits = |limits| Columns::new(stack, texts, limits).width() <= max;
        let by_label = |label| Limits { label, ..full };
        let by_name = |name| Limits { name, label: 1 };
        let limits = match longest(full.label, |label| fits(by_label(label))) {
            Some(label) => by_label(label),
            None => by_name(longest(full.name, |name| fits(by_name(name))).unwrap_or(1)),
        };
        Columns::new(stack, texts, limits)
    }

    fn new(stack: &Stack, texts: &Texts, limits: Limits) -> Columns {
        let box_width = match stack.levels.len() {
            0 => 0,
            _ => FRAME + texts.widest(limits),
        };
        let lanes = |side| Lanes::new(stack, texts, limits, side, box_width);
        Columns { limits, box_width, left: lanes(Side::Left), right: lanes(Side::Right) }
    }

    pub fn width(&self) -> usize {
        self.left.extent + self.box_width + self.right.extent
    }

    pub fn on(&self, side: Side) -> &Lanes {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// The columns free for the label of an arrow in a gap: up to the first lane there, or the end of the drawing.
    pub fn room_in_gap(&self, side: Side, row: usize) -> usize {
        let lanes = self.on(side);
        let end = match lanes.first_in(row) {
            Some(lane) => lane.saturating_sub(1 + CLEARANCE),
            None => lanes.extent,
        };
        end + before_border(side, self.box_width)
    }

    /// The columns free for the label of an edge that leaves its box in `row`, with a piece of line on both sides.
    pub fn room_in_line(&self, side: Side, row: usize, padding: usize) -> usize {
        let lane = self.on(side).first_in(row).unwrap_or(0);
        lane.saturating_sub(3 + 2 * padding)
    }
}

impl Lanes {
    fn new(stack: &Stack, texts: &Texts, limits: Limits, side: Side, box_width: usize) -> Lanes {
        let mut reach = vec![0; stack.height];
        let (mut edges, mut tracks) = (Vec::new(), Vec::new());
        for (edge, run) in stack.runs.iter().enumerate() {
            let label = texts.label_width(edge, limits);
            match *run {
                Run::Gap { row, .. } if run.side() == Some(side) => {
                    reach[row] = reach_in_gap(label, before_border(side, box_width));
                }
                Run::Beside { from, to, .. } if run.side() == Some(side) => {
                    edges.push(edge);
                    tracks.push(Track::between(from, to));
                    reach[from] = reach_in_line(label, texts.glyphs.label_padding());
                    reach[to] = 2;
                }
                _ => {}
            }
        }
        let lanes = lanes::assign(&tracks, &reach);
        let text = reach.iter().max().map_or(0, |reach| reach.saturating_sub(CLEARANCE));
        let extent = lanes.iter().copied().max().unwrap_or(0).max(text);
        Lanes { edges, tracks, lanes, extent }
    }

    /// The lane of an edge that runs on this side.
    pub fn of(&self, edge: usize) -> Option<usize> {
        let found = self.edges.binary_search(&edge).ok();
        found.map(|i| self.lanes[i])
    }

    /// The lane nearest to the boxes that passes this row.
    fn first_in(&self, row: usize) -> Option<usize> {
        let all = self.tracks.iter().zip(&self.lanes);
        let passing = all.filter(|(track, _)| track.covers(row));
        passing.map(|(_, lane)| *lane).min()
    }
}

/// How far a label reaches that stands in its line, with the piece of line on both sides.
fn reach_in_line(label: usize, padding: usize) -> usize {
    match label {
        0 => 1,
        _ => 2 + label + 2 * padding,
    }
}

/// How far a label reaches that stands in a gap, with the clearance after it.
fn reach_in_gap(label: usize, before_border: usize) -> usize {
    match label {
        0 => 0,
        _ => (label + CLEARANCE).saturating_sub(before_border),
    }
}

/// The columns for a label between the arrow in a gap and the border of the boxes, border included.
fn before_border(side: Side, box_width: usize) -> usize {
    let beside_middle = match side {
        Side::Left => box_width / 2,
        Side::Right => box_width.saturating_sub(box_width / 2 + 1),
    };
    beside_middle.saturating_sub(2)
}

/// The longest length from 1 to `longest` whose drawing fits, if any does; a shorter one never fits worse.
fn longest(longest: usize, fits: impl Fn(usize) -> bool) -> Option<usize> {
    let (mut low, mut high) = (0, longest);
    while low < high {
        let middle = (low + high).div_ceil(2);
        if fits(middle) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    (low > 0).then_some(low)
}
