//! The machines: every state in its place, the active ones marked, with the time in them and how often they were entered.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::breakpoints::mark;
use super::{Title, draw_nothing};
use crate::model::{MachineId, Program, StateId};
use crate::ui::action::Action;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::tree::{Element, Row};
use crate::ui::view::{Mode, Path, name};

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let rows = app.tree();
    let Some(program) = app.program().filter(|_| !rows.is_empty()) else {
        draw_nothing(app, area, buffer, &nothing(app));
        return Title::new(Pane::Machines.title(), "");
    };
    for (y, row) in (0..area.height).zip(rows.iter().skip(app.tree_top())) {
        draw_row(app, program, row, Pen::new(buffer, area, y));
    }
    Title::new(Pane::Machines.title(), note(app, &rows, usize::from(area.height)))
}

/// The machine or state in a row.
pub fn at(app: &App, row: usize) -> Option<Path> {
    app.tree().into_iter().nth(app.tree_top() + row).map(|row| row.path)
}

fn nothing(app: &App) -> String {
    match app.view().broken() {
        Some(first) if app.view().is_program(&first.file) && first.line > 0 => {
            format!("Nothing runs yet: line {}", app.view().headline(first))
        }
        Some(first) => format!("Nothing runs yet: {}", app.view().headline(first)),
        None if matches!(app.view().mode, Mode::Waiting { .. }) => {
            let key = app.keys().name(Action::Pause);
            format!("The program begins when its robots are there; {key} begins without.")
        }
        None => "No machine yet. Write one in your editor and save: it runs at once.".into(),
    }
}

/// What is out of sight: an active state above all.
fn note(app: &App, rows: &[Row], height: usize) -> String {
    let above = &rows[..app.tree_top().min(rows.len())];
    let below = rows.get(app.tree_top() + height..).unwrap_or(&[]);
    let active = |rows: &[Row]| {
        let innermost = rows.iter().filter(|row| app.view().is_active(&row.path)).max_by_key(|row| row.depth);
        innermost.map(|row| name(&row.path).to_owned())
    };
    match (active(below), active(above)) {
        (Some(name), _) => format!("{} {name} {}", glyphs::ACTIVE, glyphs::DOWN),
        (None, Some(name)) => format!("{} {name} {}", glyphs::ACTIVE, glyphs::UP),
        (None, None) if !below.is_empty() => format!("{} more", below.len()),
        (None, None) => String::new(),
    }
}

fn draw_row(app: &App, program: &Program, row: &Row, mut pen: Pen) {
    let theme = app.theme();
    let selected = app.selected() == Some(&row.path);
    pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
    pen.column("", row.depth / 2 * 2, theme.normal());
    match row.element {
        Element::Machine(machine) => draw_machine(app, program, machine, &mut pen),
        Element::State(state) => draw_state(app, program, state, &mut pen),
    }
    if selected && app.focus() == Pane::Machines {
        pen.wash(theme.selected());
    }
}

fn draw_machine(app: &App, program: &Program, machine: MachineId, pen: &mut Pen) {
    let (theme, view) = (app.theme(), app.view());
    let machine = &program[machine];
    let style = if view.is_running(&machine.path) { theme.bold() } else { theme.dim() };
    if app.is_folded(&machine.path) {
        let inside = view.active(&machine.path).map_or("", |path| name(path));
        pen.put_right(" ", style).put_right(inside, theme.active());
    }
    pen.put(&machine.name, style);
    draw_mark(app, &machine.path, pen);
}

fn draw_state(app: &App, program: &Program, id: StateId, pen: &mut Pen) {
    let (theme, view) = (app.theme(), app.view());
    let state = &program[id];
    let machine = &program[state.machine];
    let active = view.is_active(&state.path);
    let style = match active {
        true => theme.active(),
        false if view.is_running(&machine.path) => theme.normal(),
        false => theme.dim(),
    };
    draw_numbers(app, program, id, pen);
    pen.put(if active { glyphs::ACTIVE } else { " " }, theme.active()).put(" ", theme.active());
    pen.put(&state.name, style);
    if app.is_folded(&state.path) {
        pen.put(" ", theme.dim()).put(glyphs::ELLIPSIS, theme.dim());
    }
    draw_mark(app, &state.path, pen);
}

/// From the right: visits, the time in the state or until its timeout, and that as a bar; as far as the name leaves room.
fn draw_numbers(app: &App, program: &Program, id: StateId, pen: &mut Pen) {
    let (theme, view) = (app.theme(), app.view());
    let state = &program[id];
    let visits = view.states.get(&state.path).map_or(0, |state| state.visits);
    let visits = if visits == 0 { String::new() } else { format!("{}{}", glyphs::TIMES, count(visits)) };
    let time = time(app, program, id);
    let marked = if view.breaks_at_state(&state.path).is_some() { 2 } else { 0 };
    let spare = |pen: &Pen| pen.room().saturating_sub(format::width(&state.name) + 2 + marked);
    let times = if time.is_empty() { 0 } else { TIME };
    if spare(pen) >= times + VISITS {
        pen.right_column(&visits, VISITS, theme.dim());
    }
    if time.is_empty() || spare(pen) < 8 {
        return;
    }
    pen.right_column(&time, TIME, theme.normal());
    if let Some(timeout) = view.timeout(program, id, app.shown_at().t).filter(|_| spare(pen) >= BAR) {
        pen.right_column(&format::bar(timeout, BAR - 1), BAR, theme.active());
    }
}

/// Columns of a bar and what parts it from the name.
const BAR: u16 = 6;
const VISITS: u16 = 5;
/// Columns of a time.
const TIME: u16 = 10;

/// `in 120 ms` until a timeout, or else how long the state has been active.
fn time(app: &App, program: &Program, id: StateId) -> String {
    let (view, now) = (app.view(), app.shown_at().t);
    match view.timeout(program, id, now).map(|timeout| timeout.left()) {
        Some(left) if left < 0.5 => return "due".into(),
        Some(left) => return format!("in {}", format::duration(left)),
        None => (),
    }
    let state = &program[id];
    let active = view.is_active(&state.path);
    let elapsed = view.elapsed(&program[state.machine].path, now).filter(|_| active);
    elapsed.map_or(String::new(), |elapsed| format::duration(elapsed.ms()))
}

fn count(n: u64) -> String {
    match n {
        0..10_000 => n.to_string(),
        10_000..10_000_000 => format!("{}k", n / 1000),
        _ => format!("{}M", n / 1_000_000),
    }
}

fn draw_mark(app: &App, path: &str, pen: &mut Pen) {
    if let Some(by) = app.view().breaks_at_state(path) {
        pen.put(" ", app.theme().normal()).put(mark(by), app.theme().breakpoint());
    }
    if let Some(gravity) = app.view().gravity(path) {
        pen.put(" !", app.theme().gravity(gravity));
    }
}
