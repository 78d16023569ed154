//! The selected machine as a drawing, with those that run beside it. What happens only recolours it: no glyph moves.

mod brush;
mod stage;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use self::brush::Brush;
use self::stage::Stage;
use super::{Target, Title, below_title, draw_nothing};
use crate::model::{MachineId, Program, StateId, TransitionId};
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::graph::Point;
use crate::ui::layout::Pane;
use crate::ui::panes::diagram::View;
use crate::ui::pen::Pen;

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let Some((program, machine)) = app.program().zip(app.machine()) else {
        draw_nothing(app, area, buffer, "Nothing to draw yet.");
        return Title::new(Pane::Graph.title(), "");
    };
    if program[machine].states.is_empty() {
        draw_nothing(app, area, buffer, "This machine has no states yet.");
    }
    let area = canvas(area);
    let stage = Stage::of(app, program, machine, area);
    for scene in &stage.scenes {
        Brush::new(app, program, scene).draw(buffer);
    }
    draw_tabs(app, program, machine, &stage, buffer);
    for (y, line) in (0..).zip(&stage.legend) {
        Pen::new(buffer, stage.legend_area, y).put(line, app.theme().dim());
    }
    let notes = [how(&stage), if app.follows() { "follow" } else { "" }];
    let notes = notes.into_iter().filter(|note| !note.is_empty()).map(|note| format!("{} {note}", glyphs::DOT));
    let note = notes.collect::<Vec<_>>().join(" ");
    let room = area.width.saturating_sub(4 + format::width(&note));
    Title::new(path_in(&app.breadcrumb(program, machine), room), note)
}

fn how(stage: &Stage) -> &'static str {
    match stage.scenes.first().map(|scene| scene.view) {
        Some(View::Table) => "table",
        Some(View::Around(_)) => "around",
        Some(View::Boxes) | None => "",
    }
}

fn draw_tabs(app: &App, program: &Program, machine: MachineId, stage: &Stage, buffer: &mut Buffer) {
    let theme = app.theme();
    for tab in &stage.tabs {
        let (name, active) = stage::said(app, program, tab.machine);
        let style = if tab.machine == machine { theme.bold() } else { theme.dim() };
        Pen::new(buffer, tab.area, 0).put(&name, style).put(&active, theme.active());
    }
}

/// The part of the pane below its title in which the drawing may stand.
fn canvas(area: Rect) -> Rect {
    Rect { x: area.x + 1.min(area.width), width: area.width.saturating_sub(2), ..area }
}

/// What stands where in the whole area of the pane, title included.
pub fn stage(app: &App, area: Rect) -> Option<Stage> {
    let (program, machine) = app.program().zip(app.machine())?;
    Some(Stage::of(app, program, machine, canvas(below_title(area))))
}

/// What of a program is drawn at a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// Its name among those that run beside each other; or the wildcard source, which stands for any state of it.
    Machine(MachineId),
    State(StateId),
    /// Its line, head or label. Where two lines cross, the one that goes across.
    Transition(TransitionId),
}

/// What is drawn at a cell of the screen, for the whole area of the pane, title included; none where nothing is.
pub fn at(app: &App, area: Rect, cell: Position) -> Option<Spot> {
    let (program, stage) = app.program().zip(stage(app, area))?;
    if let Some(tab) = stage.tabs.iter().find(|tab| tab.area.contains(cell)) {
        return Some(Spot::Machine(tab.machine));
    }
    let scene = stage.scenes.iter().find(|scene| scene.area.contains(cell))?;
    let (x, y) = (cell.x - scene.area.x, cell.y - scene.area.y);
    let at = Point { x: scene.corner.x.saturating_add(x), y: scene.corner.y.saturating_add(y) };
    scene.diagram.at(program, scene.machine, at)
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
