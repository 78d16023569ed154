//! Places panes: a plan says what is divided in which proportion, a person may have moved its borders or hidden panes.

use ratatui::layout::{Position, Rect};

use super::{Chosen, Layout, Pane};

/// What two areas a border divides: the same name in every layout where it stands, so that it stays where a person moved it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Divide {
    /// The overview at the left and all else.
    Overview,
    Machines,
    Variables,
    /// The middle and the column at the right, where there are three.
    Right,
    /// The drawing and what stands beside it.
    Figures,
    /// The figures and what is below them.
    Below,
    Log,
    /// The program's text and what is below it.
    Source,
    /// Where there is room for little.
    MachinesBeside,
    VariablesBeside,
    MachinesAbove,
    VariablesAbove,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    Beside,
    Above,
}

/// How long one side is, as long as nobody moved the border: a part of the whole, within limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Length {
    pub side: Side,
    pub part: (u16, u16),
    pub least: u16,
    pub most: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    First,
    Second,
}

impl Length {
    pub const fn first(part: u16, of: u16) -> Length {
        Length { side: Side::First, part: (part, of), least: 0, most: u16::MAX }
    }

    pub const fn second(part: u16, of: u16) -> Length {
        Length { side: Side::Second, ..Length::first(part, of) }
    }

    pub const fn within(self, least: u16, most: u16) -> Length {
        Length { least, most, ..self }
    }

    /// The first side's, of `whole` cells for both; `extent`: with what is between them.
    fn first_of(self, extent: u16, whole: u16) -> u16 {
        let (part, of) = self.part;
        let length = (u32::from(extent) * u32::from(part) / u32::from(of)) as u16;
        let length = length.clamp(self.least.min(self.most), self.most).min(whole);
        if self.side == Side::First { length } else { whole - length }
    }
}

/// What stands where.
#[derive(Clone, Debug)]
pub enum Node {
    Pane(Pane),
    Split(Box<Split>),
}

#[derive(Clone, Debug)]
pub struct Split {
    pub divide: Divide,
    pub axis: Axis,
    pub length: Length,
    pub first: Node,
    pub second: Node,
}

impl From<Pane> for Node {
    fn from(pane: Pane) -> Node {
        Node::Pane(pane)
    }
}

pub fn beside(divide: Divide, length: Length, first: impl Into<Node>, second: impl Into<Node>) -> Node {
    let (first, second) = (first.into(), second.into());
    Node::Split(Box::new(Split { divide, axis: Axis::Beside, length, first, second }))
}

pub fn above(divide: Divide, length: Length, first: impl Into<Node>, second: impl Into<Node>) -> Node {
    let (first, second) = (first.into(), second.into());
    Node::Split(Box::new(Split { divide, axis: Axis::Above, length, first, second }))
}

/// A person takes hold of it to move it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Border {
    pub divide: Divide,
    pub axis: Axis,
    /// A column between panes, or the titles of those below.
    pub area: Rect,
    /// What it divides.
    pub whole: Rect,
}

impl Border {
    /// The cells the first side has.
    pub fn first(&self) -> u16 {
        match self.axis {
            Axis::Beside => self.area.x - self.whole.x,
            Axis::Above => self.area.y - self.whole.y,
        }
    }

    /// The cells that both sides share.
    pub fn length(&self) -> u16 {
        length(self.axis, self.whole)
    }

    /// The cells the first side would have if the border went to this cell.
    pub fn first_at(&self, at: Position) -> i32 {
        match self.axis {
            Axis::Beside => i32::from(at.x) - i32::from(self.whole.x),
            Axis::Above => i32::from(at.y) - i32::from(self.whole.y),
        }
    }
}

/// The least a person can leave of a side.
fn least(axis: Axis) -> u16 {
    match axis {
        Axis::Beside => 8,
        Axis::Above => 2,
    }
}

fn extent(axis: Axis, area: Rect) -> u16 {
    match axis {
        Axis::Beside => area.width,
        Axis::Above => area.height,
    }
}

/// A column between the sides belongs to neither.
fn length(axis: Axis, whole: Rect) -> u16 {
    match axis {
        Axis::Beside => whole.width.saturating_sub(1),
        Axis::Above => whole.height,
    }
}

/// As near to what was asked for as both sides allow.
pub fn allowed(axis: Axis, first: i32, whole: u16) -> u16 {
    let least = least(axis).min(whole / 2);
    first.clamp(i32::from(least), i32::from(whole - least)) as u16
}

impl Layout {
    pub(super) fn place(&mut self, node: Node, area: Rect, chosen: &Chosen) {
        if let Some(node) = without_hidden(node, chosen) {
            self.place_seen(&node, area, chosen);
        }
    }

    fn place_seen(&mut self, node: &Node, area: Rect, chosen: &Chosen) {
        let split = match node {
            Node::Pane(pane) => return self.panes.push((*pane, area)),
            Node::Split(split) => split,
        };
        let (extent, whole) = (extent(split.axis, area), length(split.axis, area));
        let share = chosen.share(split.divide).map(|share| (share * f64::from(whole)).round() as i32);
        let first =
            share.map_or_else(|| split.length.first_of(extent, whole), |first| allowed(split.axis, first, whole));
        let (before, border, after) = cut(area, split.axis, first);
        self.borders.push(Border { divide: split.divide, axis: split.axis, area: border, whole: area });
        self.place_seen(&split.first, before, chosen);
        self.place_seen(&split.second, after, chosen);
    }
}

/// What is hidden leaves its room to what stood beside it.
fn without_hidden(node: Node, chosen: &Chosen) -> Option<Node> {
    match node {
        Node::Pane(pane) => (!chosen.hides(pane)).then_some(node),
        Node::Split(split) => {
            let Split { divide, axis, length, first, second } = *split;
            match (without_hidden(first, chosen), without_hidden(second, chosen)) {
                (Some(first), Some(second)) => {
                    Some(Node::Split(Box::new(Split { divide, axis, length, first, second })))
                }
                (one, other) => one.or(other),
            }
        }
    }
}

/// The first side, the border, the second side.
fn cut(area: Rect, axis: Axis, first: u16) -> (Rect, Rect, Rect) {
    match axis {
        Axis::Beside => {
            let x = area.x + first;
            let right = Rect { x: x + 1, width: area.width.saturating_sub(first + 1), ..area };
            (Rect { width: first, ..area }, Rect { x, width: 1, ..area }, right)
        }
        Axis::Above => {
            let below = Rect { y: area.y + first, height: area.height - first, ..area };
            (Rect { height: first, ..area }, Rect { height: 1.min(below.height), ..below }, below)
        }
    }
}
