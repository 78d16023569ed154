//! Where each pane stands. Only the size of the screen, what a person asked to see and whether there is a world decide.

mod chosen;
mod place;
mod plan;

use ratatui::layout::{Position, Rect};

pub use chosen::{Chosen, Way};
pub use place::{Axis, Border, Divide};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pane {
    Machines,
    Graph,
    Variables,
    Log,
    World,
    Detail,
    Source,
    Bridge,
}

impl Pane {
    /// In the order that Tab goes through them.
    pub const ALL: [Pane; 8] = [
        Pane::Machines,
        Pane::Graph,
        Pane::World,
        Pane::Source,
        Pane::Bridge,
        Pane::Detail,
        Pane::Variables,
        Pane::Log,
    ];

    pub fn title(self) -> &'static str {
        match self {
            Pane::Machines => "machines",
            Pane::Graph => "graph",
            Pane::Variables => "variables",
            Pane::Log => "log",
            Pane::World => "world",
            Pane::Detail => "detail",
            Pane::Source => "source",
            Pane::Bridge => "robots",
        }
    }
}

/// What the largest place shows where there is only one for five.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    Graph,
    World,
    Detail,
    Source,
    Bridge,
}

impl Figure {
    pub fn pane(self) -> Pane {
        match self {
            Figure::Graph => Pane::Graph,
            Figure::World => Pane::World,
            Figure::Detail => Pane::Detail,
            Figure::Source => Pane::Source,
            Figure::Bridge => Pane::Bridge,
        }
    }

    pub fn of(pane: Pane) -> Option<Figure> {
        match pane {
            Pane::Graph => Some(Figure::Graph),
            Pane::World => Some(Figure::World),
            Pane::Detail => Some(Figure::Detail),
            Pane::Source => Some(Figure::Source),
            Pane::Bridge => Some(Figure::Bridge),
            Pane::Machines | Pane::Variables | Pane::Log => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    Shared,
    /// The focused pane has the whole body.
    Alone,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulated {
    Nothing,
    World,
}

/// What a person asked to see.
#[derive(Clone, Copy, Debug)]
pub struct Wish<'a> {
    pub focus: Pane,
    pub figure: Figure,
    pub extent: Extent,
    pub simulated: Simulated,
    /// Rows of the machines with nothing folded; 0 where there are none yet.
    pub tree: usize,
    pub chosen: &'a Chosen,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    pub status: Rect,
    pub footer: Rect,
    /// Each has its title in its first row.
    pub panes: Vec<(Pane, Rect)>,
    /// Between panes, the outermost first.
    pub borders: Vec<Border>,
}

/// The smallest screen that shows anything but a sentence.
pub const SMALLEST: (u16, u16) = (20, 5);

impl Layout {
    /// None where the screen is too small.
    pub fn new(area: Rect, wish: Wish) -> Option<Layout> {
        if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
            return None;
        }
        let status = Rect { height: 1, ..area };
        let footer = Rect { y: area.bottom() - 1, height: 1, ..area };
        let body = Rect { y: area.y + 1, height: area.height - 2, ..area };
        let mut layout = Layout { status, footer, panes: Vec::new(), borders: Vec::new() };
        match wish.extent {
            Extent::Alone => layout.panes.push((wish.focus, body)),
            Extent::Shared => layout.place(plan::plan(body.as_size(), wish), body, wish.chosen),
        }
        Some(layout)
    }

    pub fn area(&self, pane: Pane) -> Option<Rect> {
        self.panes.iter().find(|(other, _)| *other == pane).map(|&(_, area)| area)
    }

    pub fn pane_at(&self, at: Position) -> Option<(Pane, Rect)> {
        self.panes.iter().find(|(_, area)| area.contains(at)).copied()
    }

    /// The columns of one glyph between panes beside each other.
    pub fn rules(&self) -> impl Iterator<Item = Rect> + '_ {
        self.borders.iter().filter(|border| border.axis == Axis::Beside).map(|border| border.area)
    }

    /// The border that is taken hold of at a cell: a rule, or the title of what stands below.
    pub fn border_at(&self, at: Position) -> Option<&Border> {
        self.borders.iter().rev().find(|border| border.area.contains(at))
    }

    /// The innermost border that a pane touches or lies beside, and the way it goes for the pane to grow.
    pub fn border_of(&self, pane: Pane, axis: Axis) -> Option<(&Border, Way)> {
        let area = self.area(pane)?;
        let around = |border: &&Border| border.axis == axis && border.whole.intersection(area) == area;
        let border = self.borders.iter().rev().find(around)?;
        let before = match axis {
            Axis::Beside => area.x < border.area.x,
            Axis::Above => area.y < border.area.y,
        };
        Some((border, if before { Way::On } else { Way::Back }))
    }
}
