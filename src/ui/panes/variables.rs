//! The variables in scope and what the robot tells, each value in its column.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use serde_json::Value;

use super::{Title, draw_nothing};
use crate::runtime::time::Time;
use crate::ui::app::{App, top_for};
use crate::ui::format;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::scope::{Row, Shares, Way};
use crate::ui::view::Variable;

/// What was sent longer ago than this is no longer being sent.
const SENT: Time = Time(1_000_000);
/// Columns of a number.
const VALUE: u16 = 9;

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let listing = app.values();
    if listing.rows.is_empty() {
        draw_nothing(app, area, buffer, "No variables, and nothing from a robot.");
    }
    let Shares { upper: (rows, height), lower: (carried, below) } = listing.shares(usize::from(area.height));
    let at = listing.position(app.selected_value());
    let top = app.values_top().min(rows);
    for (y, row) in (0..height as u16).zip(&listing.rows[top..rows]) {
        draw_row(app, row, Pen::new(buffer, area, y));
    }
    let first = rows + top_for(0, at.and_then(|at| at.checked_sub(rows)), carried, below);
    for (y, row) in (height as u16..area.height).zip(&listing.rows[first..]) {
        draw_row(app, row, Pen::new(buffer, area, y));
    }
    let hidden = rows.saturating_sub(top + height) + carried.saturating_sub(first - rows + below);
    let note = if hidden > 0 { format!("{hidden} more") } else { String::new() };
    match listing.scope_at(top) {
        Some(scope) => Title::new(format!("{}  {scope}", Pane::Variables.title()), note),
        None => Title::new(Pane::Variables.title(), note),
    }
}

fn draw_row(app: &App, row: &Row, mut pen: Pen) {
    let theme = app.theme();
    let names = (pen.room() * 2 / 5).clamp(8, 18);
    let selected = row.path().is_some() && row.path() == app.selected_value();
    pen.put(if selected { "▸" } else { " " }, theme.bold());
    match row {
        Row::Heading(scope) => {
            pen.put(scope, theme.dim());
        }
        Row::Variable { path, name } => {
            pen.put(" ", theme.normal()).column(name, names, theme.normal());
            if let Some(variable) = app.view().variables.get(path) {
                draw_variable(app, variable, &mut pen);
            }
        }
        Row::Field { name, value, at, .. } => {
            pen.put(" ", theme.normal()).column(name, names, theme.normal());
            draw_age(app, *at, &mut pen);
            draw_value(app, value, theme.normal(), &mut pen);
        }
        Row::Message { name, value, at, way, .. } => {
            let arrow = if *way == Way::Output { "→" } else { " " };
            pen.put(arrow, theme.dim()).put(name, theme.normal()).put("  ", theme.normal());
            draw_age(app, *at, &mut pen);
            match way {
                Way::Output if app.view().t.since(*at) > SENT => pen.put("–", theme.dim()),
                _ => pen.put(&format::message(value), theme.normal()),
            };
        }
    }
    if selected && app.focus() == Pane::Variables {
        pen.wash(theme.selected());
    }
}

fn draw_age(app: &App, at: Time, pen: &mut Pen) {
    let age = format::duration(app.view().t.since(at).ms());
    pen.put_right(" ", app.theme().dim()).right_column(&age, 8, app.theme().dim());
}

fn draw_variable(app: &App, variable: &Variable, pen: &mut Pen) {
    let theme = app.theme();
    let Some(value) = &variable.value else {
        pen.column_right("–", VALUE, theme.dim());
        return;
    };
    let fresh = variable.is_fresh(app.view().t);
    draw_value(app, value, if fresh { theme.fresh() } else { theme.normal() }, pen);
    let (aside, room) = (aside(variable), pen.room().saturating_sub(3));
    match aside {
        Aside::Was(previous) if room >= 5 => {
            pen.put("  was ", theme.dim()).put(&format::value(previous), theme.dim());
        }
        Aside::Moved if room >= 4 => {
            let history: Vec<f64> = variable.history.iter().copied().collect();
            pen.put("  ", theme.dim()).put(&format::sparkline(&history, room.min(16)), theme.dim());
        }
        _ => (),
    }
}

/// Numbers at the right of their column, everything else from its left and as far as there is room.
fn draw_value(app: &App, value: &Value, style: ratatui::style::Style, pen: &mut Pen) {
    let text = format::value(value);
    match value {
        Value::Number(_) | Value::Bool(_) | Value::Null => pen.column_right(&text, VALUE, style),
        _ if format::width(&text) <= VALUE => pen.column_right(&text, VALUE, style),
        _ => pen.put(" ", app.theme().normal()).put(&text, style),
    };
}

/// What stands beside a value.
enum Aside<'a> {
    Nothing,
    /// A person set it.
    Was(&'a Value),
    Moved,
}

/// How often it changed lately: what never does has no curve.
fn changes(variable: &Variable) -> usize {
    variable.history.iter().zip(variable.history.iter().skip(1)).filter(|(before, after)| before != after).count()
}

fn aside(variable: &Variable) -> Aside<'_> {
    let set_by_person = matches!(&*variable.by, "command" | "init");
    match &variable.previous {
        Some(previous) if set_by_person && variable.previous != variable.value => Aside::Was(previous),
        _ if changes(variable) > 1 => Aside::Moved,
        _ => Aside::Nothing,
    }
}
