//! Where in its pane each machine is drawn: one alone, or those that run beside each other side by side where there is room,
//! else one of them with the others as tabs. Draws nothing.

use std::rc::Rc;

use ratatui::layout::Rect;

use crate::model::{MachineId, Program, StateId};
use crate::ui::app::{App, Nearness};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::graph::Point;
use crate::ui::machine_graph;
use crate::ui::panes::diagram::{Diagram, View};
use crate::ui::view::name;

/// What is on the pane below its title.
pub struct Stage {
    /// The selected machine is the first.
    pub scenes: Vec<Scene>,
    /// Names of machines, each where it stands.
    pub tabs: Vec<Tab>,
    /// What shortened texts are in full, at the bottom.
    pub legend: Vec<String>,
    pub legend_area: Rect,
}

/// A machine's drawing, and which part of it is seen.
pub struct Scene {
    pub machine: MachineId,
    pub view: View,
    pub area: Rect,
    pub diagram: Rc<Diagram>,
    /// The cell of the drawing in the upper left corner of the area.
    pub corner: Point,
}

pub struct Tab {
    pub machine: MachineId,
    pub area: Rect,
}

/// Columns between machines that stand side by side.
const GAP: u16 = 2;
/// Columns between tabs.
const BETWEEN: u16 = 3;
/// Rows that a table must save, and that boxes must leave, before one takes the place of the other.
const SPARE: u16 = 2;

impl Stage {
    pub fn of(app: &App, program: &Program, machine: MachineId, area: Rect) -> Stage {
        let beside = machine_graph::beside(program, machine);
        if let Some(stage) = Stage::side_by_side(app, program, machine, &beside, area) {
            return stage;
        }
        let tabs = if beside.len() > 1 { tabs(program, &beside, area) } else { Vec::new() };
        let rows = u16::from(!tabs.is_empty());
        Stage { tabs, ..Stage::alone(app, program, machine, lower(area, rows)) }
    }

    fn alone(app: &App, program: &Program, machine: MachineId, area: Rect) -> Stage {
        let view = view(app, program, machine, area);
        let diagram = app.diagram(program, machine, view, area.as_size());
        let node = in_sight(app, program, machine).and_then(|state| diagram.node_of(state));
        let all = format::wrap(&diagram.legend(node).join(&format!(" {} ", glyphs::DOT)), area.width);
        let free = area.height.saturating_sub(diagram.drawing.height);
        let legend: Vec<String> = all.into_iter().take(free.max(area.height / 3).into()).collect();
        let rows = legend.len() as u16;
        let legend_area = lower(area, area.height - rows);
        let area = Rect { height: area.height - rows, ..area };
        let corner = app.corner(&diagram, node, area.as_size());
        Stage { scenes: vec![Scene { machine, view, area, diagram, corner }], tabs: Vec::new(), legend, legend_area }
    }

    /// Only where each is whole, with lines.
    fn side_by_side(
        app: &App,
        program: &Program,
        machine: MachineId,
        beside: &[MachineId],
        area: Rect,
    ) -> Option<Stage> {
        let count = u16::try_from(beside.len()).ok().filter(|count| *count > 1)?;
        if !matches!(app.nearness(), Nearness::Fitting | Nearness::Boxes) || area.height < 2 {
            return None;
        }
        let width = (area.width + GAP).checked_div(count)?.checked_sub(GAP).filter(|width| *width > 0)?;
        let mut stage = Stage { scenes: Vec::new(), tabs: Vec::new(), legend: Vec::new(), legend_area: Rect::ZERO };
        for (i, &other) in (0..).zip(beside) {
            let place = Rect { x: area.x + i * (width + GAP), width, ..area };
            let (heading, area) = (Rect { height: 1, ..place }, lower(place, 1));
            let diagram = app.diagram(program, other, View::Boxes, area.as_size());
            let drawing = &diagram.drawing;
            let fits = drawing.height <= area.height && drawing.width <= area.width;
            if !fits || !drawing.is_whole() {
                return None;
            }
            stage.tabs.push(Tab { machine: other, area: heading });
            let scene = Scene { machine: other, view: View::Boxes, area, diagram, corner: Point { x: 0, y: 0 } };
            let at = if other == machine { 0 } else { stage.scenes.len() };
            stage.scenes.insert(at, scene);
        }
        Some(stage)
    }
}

/// The state that is to be seen: the selected one, else the active one.
pub fn in_sight(app: &App, program: &Program, machine: MachineId) -> Option<StateId> {
    let own = |state: &StateId| program[*state].machine == machine;
    let selected = app.selected().and_then(|path| program.state(path)).filter(own);
    selected.or_else(|| app.view().active(&program[machine].path).and_then(|path| program.state(path)))
}

fn view(app: &App, program: &Program, machine: MachineId, area: Rect) -> View {
    match app.nearness() {
        Nearness::Boxes => View::Boxes,
        Nearness::Table => View::Table,
        Nearness::Around => {
            let state = in_sight(app, program, machine).or_else(|| program[machine].states.first().copied());
            state.map_or(View::Boxes, View::Around)
        }
        Nearness::Fitting => fitting(app, program, machine, area),
    }
}

/// Boxes where they fit; else a table if that helps. What is there stays where both would do.
fn fitting(app: &App, program: &Program, machine: MachineId, area: Rect) -> View {
    let was_table = app.was_table(&program[machine].path);
    let diagram = |view| app.diagram(program, machine, view, area.as_size());
    let drawn = diagram(View::Boxes);
    let (width, boxes) = (drawn.drawing.width, drawn.drawing.height);
    if width > area.width {
        return View::Table;
    }
    if boxes.saturating_add(if was_table { SPARE } else { 0 }) <= area.height {
        return View::Boxes;
    }
    let table = diagram(View::Table).drawing.height;
    let saves = table.saturating_add(if was_table { 0 } else { SPARE }) < boxes;
    let helps = table <= area.height || boxes > area.height.saturating_mul(2) || table < boxes / 4 * 3;
    if saves && (helps || was_table) { View::Table } else { View::Boxes }
}

/// All in one row: none where there is no room for that and a drawing.
fn tabs(program: &Program, beside: &[MachineId], area: Rect) -> Vec<Tab> {
    if area.height < 4 {
        return Vec::new();
    }
    let mut x = area.x;
    let mut tabs = Vec::new();
    for &machine in beside {
        let wanted = format::width(&heading(program, machine));
        let width = wanted.min(area.right().saturating_sub(x));
        tabs.push(Tab { machine, area: Rect { x, y: area.y, width, height: 1 } });
        x = x.saturating_add(wanted + BETWEEN).min(area.right());
    }
    tabs
}

/// `keeper: night`, with room for the longest name, so that tabs stay where they are.
fn heading(program: &Program, machine: MachineId) -> String {
    let names = program[machine].states.iter().map(|&state| &*program[state].name);
    let longest = names.max_by_key(|name| format::width(name)).unwrap_or("");
    format!("{}: {longest}", program[machine].name)
}

/// What a tab says: a machine and the state it is in.
pub fn said(app: &App, program: &Program, machine: MachineId) -> (String, String) {
    let active = app.view().active(&program[machine].path).map_or("", |path| name(path));
    (format!("{}: ", program[machine].name), active.to_owned())
}

/// What is left of an area below so many rows.
fn lower(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}
