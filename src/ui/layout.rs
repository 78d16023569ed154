//! Where each pane stands. Only the size of the screen, what a person asked to see and whether there is a world decide.

use ratatui::layout::Rect;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pane {
    Machines,
    Graph,
    Variables,
    Log,
    World,
    Detail,
}

impl Pane {
    pub fn title(self) -> &'static str {
        match self {
            Pane::Machines => "machines",
            Pane::Graph => "graph",
            Pane::Variables => "variables",
            Pane::Log => "log",
            Pane::World => "world",
            Pane::Detail => "detail",
        }
    }
}

/// What the largest place shows where there is only one for three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    Graph,
    World,
    Detail,
}

impl Figure {
    pub fn pane(self) -> Pane {
        match self {
            Figure::Graph => Pane::Graph,
            Figure::World => Pane::World,
            Figure::Detail => Pane::Detail,
        }
    }

    pub fn of(pane: Pane) -> Option<Figure> {
        match pane {
            Pane::Graph => Some(Figure::Graph),
            Pane::World => Some(Figure::World),
            Pane::Detail => Some(Figure::Detail),
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
pub struct Wish {
    pub focus: Pane,
    pub figure: Figure,
    pub extent: Extent,
    pub simulated: Simulated,
    /// Rows of the machines with nothing folded; 0 where there are none yet.
    pub tree: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    pub status: Rect,
    pub footer: Rect,
    /// In the order of the eye. Each has its title in its first row.
    pub panes: Vec<(Pane, Rect)>,
    /// One column each, between panes.
    pub rules: Vec<Rect>,
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
        let mut layout = Layout { status, footer, panes: Vec::new(), rules: Vec::new() };
        match wish.extent {
            Extent::Alone => layout.place(wish.focus, body),
            Extent::Shared => layout.share(body, wish),
        }
        Some(layout)
    }

    pub fn area(&self, pane: Pane) -> Option<Rect> {
        self.panes.iter().find(|(other, _)| *other == pane).map(|&(_, area)| area)
    }

    fn share(&mut self, body: Rect, wish: Wish) {
        match (body.width, body.height) {
            (180.., 46..) => self.everything(body, wish),
            (110.., 28..) => self.two_figures(body, wish),
            (64.., 16..) => self.one_figure(body, wish),
            (64.., 7..) => self.three_columns(body, wish),
            (_, 11..) => self.one_column(body, wish),
            _ => self.place(wish.focus, body),
        }
    }

    /// 200x60
    fn everything(&mut self, body: Rect, wish: Wish) {
        let (left, rest) = self.beside(body, 44);
        let (middle, right) = self.beside(rest, rest.width * 3 / 5);
        self.overview(left, wish);
        let (graph, log) = above(middle, middle.height * 2 / 3);
        let (world, detail) = above(right, right.height / 2);
        self.place(Pane::Graph, graph);
        self.place(Pane::World, world);
        self.place(Pane::Detail, detail);
        self.place(Pane::Log, log);
    }

    /// 120x40
    fn two_figures(&mut self, body: Rect, wish: Wish) {
        let (left, right) = self.beside(body, 38);
        self.overview(left, wish);
        let (figures, log) = above(right, right.height * 2 / 3);
        let second = match (wish.figure, wish.simulated) {
            (Figure::Detail, _) => Some(Pane::Detail),
            (Figure::World, _) | (_, Simulated::World) => Some(Pane::World),
            (Figure::Graph, Simulated::Nothing) => None,
        };
        match second {
            None => self.place(Pane::Graph, figures),
            Some(second) => {
                let (graph, beside) = self.beside(figures, figures.width * 5 / 9);
                self.place(Pane::Graph, graph);
                self.place(second, beside);
            }
        }
        self.place(Pane::Log, log);
    }

    /// 80x24
    fn one_figure(&mut self, body: Rect, wish: Wish) {
        let left = (body.width * 9 / 20).clamp(30, 38);
        let (left, right) = self.beside(body, left);
        self.overview(left, wish);
        let (figure, log) = above(right, right.height - (right.height / 3).clamp(5, 14));
        self.place(wish.figure.pane(), figure);
        self.place(Pane::Log, log);
    }

    /// 80x12
    fn three_columns(&mut self, body: Rect, wish: Wish) {
        let (machines, rest) = self.beside(body, body.width * 3 / 8);
        self.place(Pane::Machines, machines);
        if let Some(figure) = Figure::of(wish.focus) {
            return self.place(figure.pane(), rest);
        }
        let (variables, log) = self.beside(rest, rest.width / 2);
        self.place(Pane::Variables, variables);
        self.place(Pane::Log, log);
    }

    /// 40x24
    fn one_column(&mut self, body: Rect, wish: Wish) {
        let (machines, rest) = above(body, body.height * 9 / 20);
        self.place(Pane::Machines, machines);
        if let Some(figure) = Figure::of(wish.focus) {
            return self.place(figure.pane(), rest);
        }
        let (variables, log) = above(rest, rest.height * 3 / 5);
        self.place(Pane::Variables, variables);
        self.place(Pane::Log, log);
    }

    /// The variables have what the machines don't need.
    fn overview(&mut self, column: Rect, wish: Wish) {
        let needed = if wish.tree == 0 { usize::MAX } else { wish.tree + 2 };
        let share = usize::from(column.height * 6 / 11);
        let (machines, variables) = above(column, needed.min(share) as u16);
        self.place(Pane::Machines, machines);
        self.place(Pane::Variables, variables);
    }

    fn place(&mut self, pane: Pane, area: Rect) {
        self.panes.push((pane, area));
    }

    /// Two areas with a rule between them; the first is `width` columns wide.
    fn beside(&mut self, area: Rect, width: u16) -> (Rect, Rect) {
        let width = width.min(area.width.saturating_sub(1));
        self.rules.push(Rect { x: area.x + width, width: 1, ..area });
        let right = Rect { x: area.x + width + 1, width: area.width - width - 1, ..area };
        (Rect { width, ..area }, right)
    }
}

/// Two areas one above the other; the first is `height` rows high.
fn above(area: Rect, height: u16) -> (Rect, Rect) {
    let height = height.min(area.height);
    let below = Rect { y: area.y + height, height: area.height - height, ..area };
    (Rect { height, ..area }, below)
}
