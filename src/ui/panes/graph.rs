//! The selected machine as a drawing. What happens only recolours it: no glyph moves.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::breakpoints::mark;
use super::diagram::Diagram;
use super::{Target, Title, below_title, draw_nothing};
use crate::model::{MachineId, Program, StateId, TransitionId};
use crate::runtime::record::Setter;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::graph::{Part, Point};
use crate::ui::layout::Pane;
use crate::ui::machine_graph;
use crate::ui::view::{Which, name};

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let Some((program, machine)) = app.program().zip(app.machine()) else {
        draw_nothing(app, area, buffer, "Nothing to draw yet.");
        return Title::new(Pane::Graph.title(), "");
    };
    if program[machine].states.is_empty() {
        draw_nothing(app, area, buffer, "This machine has no states yet.");
    }
    let area = canvas(area);
    let diagram = app.diagram(program, machine, area);
    let brush = Brush::new(app, program, machine, &diagram);
    brush.draw(area, buffer);
    let note = if app.follows() { format!("{} follow", glyphs::DOT) } else { String::new() };
    let room = area.width.saturating_sub(4 + format::width(&note));
    Title::new(path_in(&program[machine].path, room), note)
}

/// The part of the pane below its title in which the drawing may stand.
fn canvas(area: Rect) -> Rect {
    Rect { x: area.x + 1.min(area.width), width: area.width.saturating_sub(2), ..area }
}

/// What of a program is drawn at a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// The wildcard source, which stands for any state of it.
    Machine(MachineId),
    State(StateId),
    /// Its line, head or label. Where two lines cross, the one that goes across.
    Transition(TransitionId),
}

/// What is drawn at a cell of the screen, for the whole area of the pane, title included; none where nothing is.
pub fn at(app: &App, area: Rect, cell: Position) -> Option<Spot> {
    let (program, machine) = app.program().zip(app.machine())?;
    let area = canvas(below_title(area));
    if !area.contains(cell) {
        return None;
    }
    let diagram = app.diagram(program, machine, area);
    let (left, top) = Brush::new(app, program, machine, &diagram).origin(area);
    let (x, y) = (cell.x - area.x, cell.y - area.y);
    diagram.at(program, machine, Point { x: left.saturating_add(x), y: top.saturating_add(y) })
}

/// What a person takes hold of there.
pub fn target(app: &App, area: Rect, cell: Position) -> Option<Target> {
    let program = app.program()?;
    Some(match at(app, area, cell)? {
        Spot::Machine(machine) => Target::Element(program[machine].path.clone()),
        Spot::State(state) => Target::Element(program[state].path.clone()),
        Spot::Transition(id) => Target::Transition(id),
    })
}

/// `follower / looking / lookalgo`, closer where there is little room, and then only its end.
fn path_in(path: &str, room: u16) -> String {
    let spaced = path.replace('/', " / ");
    if format::width(&spaced) <= room {
        return spaced;
    }
    let mut rest = path;
    while let Some((_, inner)) = rest.split_once('/').filter(|_| format::width(rest) + 2 > room) {
        rest = inner;
    }
    if rest == path { path.into() } else { format!("{}/{rest}", glyphs::ELLIPSIS) }
}

struct Brush<'a> {
    app: &'a App,
    program: &'a Program,
    machine: MachineId,
    diagram: &'a Diagram,
    active: Option<StateId>,
    selected: Option<StateId>,
    /// The transition taken last, and the name of the state it led out of.
    last: Option<(u32, &'a str)>,
}

impl<'a> Brush<'a> {
    fn new(app: &'a App, program: &'a Program, machine: MachineId, diagram: &'a Diagram) -> Brush<'a> {
        let path = &program[machine].path;
        let view = app.view();
        let running = view.machines.get(path).filter(|machine| machine.running);
        let last = running.and_then(|machine| Some((machine.last_taken?, &*machine.last_from)));
        Brush {
            app,
            program,
            machine,
            diagram,
            active: view.active(path).and_then(|state| program.state(state)),
            selected: app.selected().and_then(|path| program.state(path)),
            last: last.map(|(which, from)| match which {
                Which::Own(index) => (index, from),
                Which::Exit => (machine_graph::EXIT, from),
            }),
        }
    }

    fn draw(&self, area: Rect, buffer: &mut Buffer) {
        let drawing = &self.diagram.drawing;
        let (left, top) = self.origin(area);
        for y in 0..area.height.min(drawing.height.saturating_sub(top)) {
            for x in 0..area.width.min(drawing.width.saturating_sub(left)) {
                let symbol = drawing.symbol(left + x, top + y);
                let cell = drawing.cell(left + x, top + y);
                if let Some(to) = buffer.cell_mut(Position::new(area.x + x, area.y + y))
                    && !symbol.is_empty()
                {
                    to.set_symbol(&symbol).set_style(self.style(cell.part));
                }
            }
        }
        self.draw_heavy((left, top), area, buffer);
        for node in 0..self.diagram.nodes.len() {
            self.draw_inside(node, (left, top), area, buffer);
        }
        self.draw_breakpoints((left, top), area, buffer);
    }

    /// In a free cell beside the names of states and the labels of transitions: no glyph moves.
    fn draw_breakpoints(&self, (left, top): (u16, u16), area: Rect, buffer: &mut Buffer) {
        if self.app.view().breakpoints.is_empty() {
            return;
        }
        let mut mark_at = |at: Point, by: Setter, style: Style| {
            if let (Some(x), Some(y)) = (at.x.checked_sub(left), at.y.checked_sub(top))
                && x < area.width
                && y < area.height
                && let Some(cell) = buffer.cell_mut(Position::new(area.x + x, area.y + y))
            {
                cell.set_symbol(mark(by)).set_style(style);
            }
        };
        let colour = self.app.theme().breakpoint();
        for (node, state) in self.diagram.nodes.iter().enumerate() {
            let Some((state, at)) = state.zip(self.diagram.drawing.beside_name(node)) else { continue };
            if let Some(by) = self.app.view().breaks_at_state(&self.program[state].path) {
                let active = Some(state) == self.active;
                mark_at(at, by, if active { self.node_style(node) } else { colour });
            }
        }
        for edge in 0..self.diagram.edges.len() {
            let by = self
                .diagram
                .transitions(self.program, self.machine, edge)
                .find_map(|id| self.app.view().breaks_at_transition(id));
            if let Some((by, at)) = by.zip(self.diagram.drawing.beside_label(edge)) {
                mark_at(at, by, colour);
            }
        }
    }

    /// The drawing's cell in the upper left corner: the selected state, else the active one, is in sight.
    fn origin(&self, area: Rect) -> (u16, u16) {
        let drawing = &self.diagram.drawing;
        let state = self.selected.and_then(|state| self.diagram.node_of(state));
        let node = state.or_else(|| self.active.and_then(|state| self.diagram.node_of(state)));
        let Some(rect) = node.and_then(|node| drawing.node_rect(node)) else { return (0, 0) };
        let along = |end: u16, room: u16, whole: u16| {
            (end.saturating_add(1)).saturating_sub(room).min(whole.saturating_sub(room))
        };
        (
            along(rect.x + rect.width, area.width, drawing.width),
            along(rect.y + rect.height, area.height, drawing.height),
        )
    }

    fn style(&self, part: Part) -> Style {
        let theme = self.app.theme();
        match part {
            Part::Blank => theme.normal(),
            Part::Box(node) | Part::Mark(node) | Part::Inside(node) => self.node_style(node),
            Part::Name(node) => {
                let selected = self.selected.is_some() && self.diagram.nodes[node] == self.selected;
                let style = self.node_style(node);
                if selected { style.add_modifier(Modifier::UNDERLINED | Modifier::BOLD) } else { style }
            }
            Part::Line(edge) | Part::Label(edge) | Part::Head(edge) => self.edge_style(edge),
            Part::Crossing { across, down } => {
                let down_only = self.was_taken(down) && !self.was_taken(across);
                self.edge_style(if down_only { down } else { across })
            }
        }
    }

    fn node_style(&self, node: usize) -> Style {
        let theme = self.app.theme();
        let Some(state) = self.diagram.nodes[node] else { return theme.dim() };
        if Some(state) == self.active {
            return theme.active().add_modifier(Modifier::REVERSED);
        }
        match self.app.view().gravity(&self.program[state].path) {
            Some(gravity) => theme.gravity(gravity),
            None => theme.normal(),
        }
    }

    fn edge_style(&self, edge: usize) -> Style {
        let style = self.app.theme().transition(self.diagram.edges[edge].kind);
        if self.was_taken(edge) { style.add_modifier(Modifier::BOLD) } else { style }
    }

    /// Of a transition with several sources only the line out of the state that was left.
    fn was_taken(&self, edge: usize) -> bool {
        let edge = self.diagram.edges[edge];
        self.last.is_some_and(|(index, from)| {
            index == edge.index && edge.from.is_none_or(|state| &*self.program[state].name == from)
        })
    }

    /// What was taken last is heavy, so that it shows without colours too.
    fn draw_heavy(&self, (left, top): (u16, u16), area: Rect, buffer: &mut Buffer) {
        for edge in (0..self.diagram.edges.len()).filter(|&edge| self.was_taken(edge)) {
            for (at, glyph) in self.diagram.drawing.heavy_line(edge) {
                let (Some(x), Some(y)) = (at.x.checked_sub(left), at.y.checked_sub(top)) else { continue };
                if x < area.width
                    && y < area.height
                    && let Some(cell) = buffer.cell_mut(Position::new(area.x + x, area.y + y))
                {
                    cell.set_char(glyph).set_style(self.edge_style(edge));
                }
            }
        }
    }

    /// The name of the state that is active inside.
    fn draw_inside(&self, node: usize, (left, top): (u16, u16), area: Rect, buffer: &mut Buffer) {
        let Some((state, room)) = self.diagram.nodes[node].zip(self.diagram.drawing.inside_rect(node)) else {
            return;
        };
        let view = self.app.view();
        let nested = self.program[state].machines.iter();
        let Some(active) = nested.filter_map(|&inner| view.active(&self.program[inner].path)).next() else { return };
        let at = (room.x.checked_sub(left), room.y.checked_sub(top));
        if let (Some(x), Some(y)) = at
            && x < area.width
            && y < area.height
        {
            let width = room.width.min(area.width - x);
            let text = format::fit(name(active), width);
            buffer.set_stringn(area.x + x, area.y + y, text, usize::from(width), self.node_style(node));
        }
    }
}
