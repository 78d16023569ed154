//! Paints one drawing as it stands in the pane: what is active, selected, wrong or a breakpoint, and the transitions taken
//! last, which fade. Everything shows without colours too.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Position;
use ratatui::style::{Modifier, Style};

use super::stage::Scene;
use crate::model::{Program, StateId};
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::graph::{Part, Point};
use crate::ui::machine_graph;
use crate::ui::panes::breakpoints::mark;
use crate::ui::panes::diagram::Diagram;
use crate::ui::view::{Trace, Which, name};

pub struct Brush<'a> {
    app: &'a App,
    program: &'a Program,
    scene: &'a Scene,
    diagram: &'a Diagram,
    active: Option<StateId>,
    selected: Option<StateId>,
    /// Of each edge how recently it was taken: 0 for the last transition.
    ages: Vec<Option<usize>>,
}

impl<'a> Brush<'a> {
    pub fn new(app: &'a App, program: &'a Program, scene: &'a Scene) -> Brush<'a> {
        let path = &program[scene.machine].path;
        let view = app.view();
        let running = view.machines.get(path).filter(|machine| machine.running);
        let trail = running.map_or(&[][..], |machine| &machine.trail);
        let age = |edge| trail.iter().position(|trace| is_of(program, &scene.diagram, edge, trace));
        Brush {
            app,
            program,
            scene,
            diagram: &scene.diagram,
            active: view.active(path).and_then(|state| program.state(state)),
            selected: app.selected().and_then(|path| program.state(path)),
            ages: (0..scene.diagram.edges.len()).map(age).collect(),
        }
    }

    pub fn draw(&self, buffer: &mut Buffer) {
        let drawing = &self.diagram.drawing;
        let (area, corner) = (self.scene.area, self.scene.corner);
        for y in 0..area.height.min(drawing.height.saturating_sub(corner.y)) {
            for x in 0..area.width.min(drawing.width.saturating_sub(corner.x)) {
                let at = Point { x: corner.x + x, y: corner.y + y };
                let symbol = drawing.symbol(at.x, at.y);
                if let Some(cell) = self.cell(at, buffer).filter(|_| !symbol.is_empty()) {
                    cell.set_symbol(&symbol).set_style(self.style(drawing.cell(at.x, at.y).part));
                }
            }
        }
        self.draw_heavy(buffer);
        for node in 0..self.diagram.nodes.len() {
            self.draw_inside(node, buffer);
        }
        self.draw_selected(buffer);
        self.draw_problems(buffer);
        self.draw_breakpoints(buffer);
    }

    /// The cell of the screen that shows a cell of the drawing.
    fn cell<'b>(&self, at: Point, buffer: &'b mut Buffer) -> Option<&'b mut Cell> {
        let (area, corner) = (self.scene.area, self.scene.corner);
        let (x, y) = (at.x.checked_sub(corner.x)?, at.y.checked_sub(corner.y)?);
        let is_seen = x < area.width && y < area.height;
        buffer.cell_mut(Position::new(area.x + x, area.y + y)).filter(|_| is_seen)
    }

    fn style(&self, part: Part) -> Style {
        let theme = self.app.theme();
        match part {
            Part::Blank => theme.normal(),
            Part::Box(node) | Part::Mark(node) | Part::Inside(node) => self.node_style(node),
            Part::Name(node) => {
                let style = self.node_style(node);
                if self.is_selected(node) { style.add_modifier(Modifier::UNDERLINED | Modifier::BOLD) } else { style }
            }
            Part::Line(edge) | Part::Label(edge) | Part::Head(edge) => self.edge_style(edge),
            Part::Target(edge) => self.target_style(edge),
            Part::Crossing { across, down } => {
                let age = |edge: usize| self.ages[edge].unwrap_or(usize::MAX);
                self.edge_style(if age(down) < age(across) { down } else { across })
            }
        }
    }

    fn is_selected(&self, node: usize) -> bool {
        self.selected.is_some() && self.diagram.nodes[node] == self.selected
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

    /// The last transition and the two before it are bold.
    fn edge_style(&self, edge: usize) -> Style {
        let style = self.app.theme().transition(self.diagram.edges[edge].kind);
        if self.ages[edge].is_some() { style.add_modifier(Modifier::BOLD) } else { style }
    }

    fn target_style(&self, edge: usize) -> Style {
        let target = self.diagram.edges[edge].to;
        let theme = self.app.theme();
        if target.is_some() && target == self.active { theme.active() } else { theme.normal() }
    }

    /// What was taken last is heavy.
    fn draw_heavy(&self, buffer: &mut Buffer) {
        for edge in (0..self.ages.len()).filter(|&edge| self.ages[edge] == Some(0)) {
            for (at, glyph) in self.diagram.drawing.heavy_line(edge) {
                if let Some(cell) = self.cell(at, buffer) {
                    cell.set_char(glyph).set_style(self.edge_style(edge));
                }
            }
        }
    }

    /// The names of the states that are active inside.
    fn draw_inside(&self, node: usize, buffer: &mut Buffer) {
        let (view, drawing) = (self.app.view(), &self.diagram.drawing);
        let Some((state, room)) = self.diagram.nodes[node].zip(drawing.inside_rect(node)) else { return };
        let spawned = machine_graph::spawned(self.program, state).into_iter();
        let active = spawned.filter_map(|inner| view.active(&self.program[inner].path)).map(|path| name(path));
        let active = active.collect::<Vec<_>>().join(machine_graph::BESIDE);
        let (area, corner) = (self.scene.area, self.scene.corner);
        if let (Some(x), Some(y)) = (room.x.checked_sub(corner.x), room.y.checked_sub(corner.y))
            && x < area.width
            && y < area.height
        {
            let width = room.width.min(area.width - x);
            let text = format::fit(&active, width);
            buffer.set_stringn(area.x + x, area.y + y, text, usize::from(width), self.node_style(node));
        }
    }

    /// The borders of the selected state are as thick as they can be.
    fn draw_selected(&self, buffer: &mut Buffer) {
        let node = self.selected.and_then(|state| self.diagram.node_of(state));
        let Some(rect) = node.and_then(|node| self.diagram.drawing.node_rect(node)) else { return };
        for y in rect.y..rect.y + rect.height {
            for x in [rect.x, rect.x + rect.width - 1] {
                if let Some(cell) = self.cell(Point { x, y }, buffer) {
                    cell.set_symbol(glyphs::BAR_8);
                    cell.modifier.remove(Modifier::REVERSED);
                }
            }
        }
    }

    /// A mark in a free cell beside the name of a state with which something is wrong.
    fn draw_problems(&self, buffer: &mut Buffer) {
        if self.app.view().problems.is_empty() {
            return;
        }
        for (node, state) in self.diagram.nodes.iter().enumerate() {
            let gravity = state.and_then(|state| self.app.view().gravity(&self.program[state].path));
            if let Some((gravity, at)) = gravity.zip(self.diagram.drawing.after_name(node))
                && let Some(cell) = self.cell(at, buffer)
            {
                let active = *state == self.active;
                let style = if active { self.node_style(node) } else { self.app.theme().gravity(gravity) };
                cell.set_symbol("!").set_style(style);
            }
        }
    }

    /// In free cells beside the names of states and the labels of transitions.
    fn draw_breakpoints(&self, buffer: &mut Buffer) {
        let view = self.app.view();
        if view.breakpoints.is_empty() {
            return;
        }
        let colour = self.app.theme().breakpoint();
        for (node, state) in self.diagram.nodes.iter().enumerate() {
            let by = state.and_then(|state| view.breaks_at_state(&self.program[state].path));
            if let Some((by, at)) = by.zip(self.diagram.drawing.beside_name(node))
                && let Some(cell) = self.cell(at, buffer)
            {
                let active = *state == self.active;
                cell.set_symbol(mark(by)).set_style(if active { self.node_style(node) } else { colour });
            }
        }
        for edge in 0..self.diagram.edges.len() {
            let mut transitions = self.diagram.transitions(self.program, self.scene.machine, edge);
            let by = transitions.find_map(|id| view.breaks_at_transition(id));
            if let Some((by, at)) = by.zip(self.diagram.drawing.beside_label(edge))
                && let Some(cell) = self.cell(at, buffer)
            {
                cell.set_symbol(mark(by)).set_style(colour);
            }
        }
    }
}

/// Whether it was an edge that was taken; of a transition with several sources only the line out of the state that was left.
fn is_of(program: &Program, diagram: &Diagram, edge: usize, trace: &Trace) -> bool {
    let edge = diagram.edges[edge];
    let index = match trace.which {
        Which::Own(index) => index,
        Which::Exit => machine_graph::EXIT,
    };
    index == edge.index && edge.from.is_none_or(|state| program[state].name == trace.from)
}
