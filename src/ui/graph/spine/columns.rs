//! The columns of a spine: how wide its boxes are and which lane each edge has, for texts of given widths. Knows nothing
//! of what stands in the boxes' rows.

use super::lanes::{self, Track};
use super::stack::Stack;
use super::{Run, Side};
use crate::ui::graph::texts::{Limits, Texts};

/// Columns between a label in a gap and the line next to it.
const CLEARANCE: usize = 2;
/// Columns of a box beside its text, half of them on either side.
pub const FRAME: usize = 4;

/// Widths go in steps of this where there is room, so that most edits leave the boxes where they are.
const STEP: usize = 4;

/// How wide the boxes and what is left of them are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Boxes in the middle of so many columns, and room beside them for what an edit may add.
    Roomy(usize),
    /// Boxes in the middle of so many columns.
    Middle(usize),
    Stepped,
    Tight,
}

impl Spacing {
    /// The width of boxes whose text takes so many columns. In the middle there is room for names to come.
    fn box_width(self, text: usize) -> usize {
        let width = FRAME + text;
        match self {
            Spacing::Roomy(_) | Spacing::Middle(_) => width.next_multiple_of(2 * STEP).max(4 * STEP),
            Spacing::Stepped => width.next_multiple_of(STEP),
            Spacing::Tight => width,
        }
    }

    /// The columns left of the boxes, where the lines there take `extent`.
    fn before(self, box_width: usize, extent: usize) -> usize {
        match self {
            Spacing::Roomy(width) | Spacing::Middle(width) => {
                extent.next_multiple_of(STEP).max(width.saturating_sub(box_width) / 2)
            }
            Spacing::Stepped => extent.next_multiple_of(STEP),
            Spacing::Tight => extent,
        }
    }

    /// Lanes beside the boxes that are left to lines that come at a box or between neighbours.
    fn spared_lanes(self) -> usize {
        usize::from(self.is_roomy())
    }

    fn is_roomy(self) -> bool {
        matches!(self, Spacing::Roomy(_))
    }

    /// How far from the boxes lines pass a label that reaches so far, so that it may become a little longer.
    fn beside_label(self, reach: usize) -> usize {
        match self {
            Spacing::Roomy(_) => reach.next_multiple_of(STEP),
            Spacing::Middle(_) | Spacing::Stepped | Spacing::Tight => reach,
        }
    }
}

pub struct Columns {
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
    pub fn new(stack: &Stack, texts: &Texts, limits: Limits, spacing: Spacing) -> Columns {
        let box_width = match stack.levels.len() {
            0 => 0,
            nodes => spacing.box_width((0..nodes).map(|node| texts.width(node, limits)).max().unwrap_or(1)),
        };
        let lanes = |side| Lanes::new(stack, texts, limits, side, box_width, spacing);
        let (mut left, right) = (lanes(Side::Left), lanes(Side::Right));
        left.extent = spacing.before(box_width, left.extent);
        Columns { box_width, left, right }
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

    /// The columns free for the label of an edge.
    pub fn room(&self, run: Run, texts: &Texts) -> usize {
        match run {
            Run::Gap { side, row } => self.room_in_gap(side, row),
            Run::Beside { side, from, .. } => self.room_in_line(side, from, texts.glyphs.label_padding()),
            Run::Nowhere => usize::MAX,
        }
    }

    /// In a gap: up to the first lane there, or the end of the drawing.
    fn room_in_gap(&self, side: Side, row: usize) -> usize {
        let lanes = self.on(side);
        let end = match lanes.first_in(row) {
            Some(lane) => lane.saturating_sub(1 + CLEARANCE),
            None => lanes.extent,
        };
        end + before_border(side, self.box_width)
    }

    /// Beside a box where the edge leaves it in `row`, with a piece of line on both sides.
    fn room_in_line(&self, side: Side, row: usize, padding: usize) -> usize {
        let lane = self.on(side).first_in(row).unwrap_or(0);
        lane.saturating_sub(3 + 2 * padding)
    }
}

impl Lanes {
    fn new(stack: &Stack, texts: &Texts, limits: Limits, side: Side, box_width: usize, spacing: Spacing) -> Lanes {
        let mut reach = vec![0; stack.height];
        let (mut edges, mut tracks, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        let end = |row| (row, stack.box_at(row));
        for (edge, run) in stack.runs.iter().enumerate() {
            let label = texts.label_width(edge, limits);
            match *run {
                Run::Gap { row, .. } if run.side() == Some(side) => {
                    reach[row] = reach_in_gap(label, before_border(side, box_width));
                    // When a state comes between the two, the arrow becomes a line: its lane is kept for it.
                    if spacing.is_roomy() {
                        kept.push(Track::between(end(row - 1), end(row + 1)).sparing(spacing.spared_lanes()));
                    }
                }
                Run::Beside { from, to, .. } if run.side() == Some(side) => {
                    edges.push(edge);
                    let track = Track::between(end(from), end(to));
                    tracks.push(if track.is_long() { track.sparing(spacing.spared_lanes()) } else { track });
                    reach[from] = spacing.beside_label(reach_in_line(label, texts.glyphs.label_padding()));
                    reach[to] = 2;
                }
                _ => {}
            }
        }
        let mut lanes = lanes::assign(&[&tracks[..], &kept].concat(), &reach);
        let text = reach.iter().max().map_or(0, |reach| reach.saturating_sub(CLEARANCE));
        let extent = lanes.iter().copied().max().unwrap_or(0).max(text);
        lanes.truncate(tracks.len());
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
