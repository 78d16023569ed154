//! The variables in scope and what the robot tells, each value in its column.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use serde_json::Value;

use super::{Title, draw_nothing};
use crate::runtime::time::Time;
use crate::ui::action::Action;
use crate::ui::app::{App, top_for};
use crate::ui::curve;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::scope::{Listing, Row, Shares, Way};
use crate::ui::view::{Path, Variable};

/// What was sent longer ago than this is no longer being sent.
const SENT: Time = Time(1_000_000);
/// Columns of a number.
const VALUE: u16 = 9;
/// Columns of a curve: half a second each.
const CURVE: u16 = 16;

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let listing = app.values();
    if listing.rows.is_empty() {
        let nothing = match app.arrangement().filter.is_empty() {
            true => "No variables, and nothing from a robot.".into(),
            false => format!("Nothing is called so ({}: all).", app.keys().name(Action::Back)),
        };
        draw_nothing(app, area, buffer, &nothing);
    }
    let seen = Seen::of(app, &listing, area);
    for &(y, index) in &seen.rows {
        let style = if index < listing.pinned { app.theme().bold() } else { app.theme().normal() };
        draw_row(app, &listing.rows[index], style, Pen::new(buffer, area, y));
    }
    let Seen { fixed, top, hidden, .. } = seen;
    let note = if hidden > 0 { format!("{hidden} more") } else { String::new() };
    let filter = &app.arrangement().filter;
    let filter = if filter.is_empty() { String::new() } else { format!("/{filter}  ") };
    let scope = listing.scope_at(if fixed > 0 { 0 } else { top }).map_or("", |scope| scope);
    Title::new(format!("{}  {filter}{scope}", Pane::Variables.title()).trim_end(), note)
}

/// The variable, or part of one, in a row.
pub fn at(app: &App, area: Rect, row: usize) -> Option<Path> {
    let listing = app.values();
    let seen = Seen::of(app, &listing, area);
    let &(_, index) = seen.rows.iter().find(|&&(y, _)| usize::from(y) == row)?;
    listing.rows[index].path().cloned()
}

/// Which rows of the listing are seen.
struct Seen {
    /// Rows at the top that don't scroll.
    fixed: usize,
    /// The first row of those that do.
    top: usize,
    /// The rows of the pane with those of the listing.
    rows: Vec<(u16, usize)>,
    /// How many more there are below.
    hidden: usize,
}

impl Seen {
    fn of(app: &App, listing: &Listing, area: Rect) -> Seen {
        let Shares { fixed, upper: (upper, height), lower: (lower, below) } = listing.shares(usize::from(area.height));
        let at = listing.position(app.selected_value());
        let top = upper.start + app.values_top().min(upper.len());
        let first = lower.start + top_for(0, at.and_then(|at| at.checked_sub(lower.start)), lower.len(), below);
        let parts = [(0, 0..fixed), (fixed, top..upper.end.min(top + height)), (fixed + height, first..lower.end)];
        let rows = parts.into_iter().flat_map(|(y, rows)| (y as u16..area.height).zip(rows)).collect();
        let hidden = upper.end.saturating_sub(top + height) + lower.end.saturating_sub(first + below);
        Seen { fixed, top, rows, hidden }
    }
}

/// `style`: of its name.
fn draw_row(app: &App, row: &Row, style: Style, mut pen: Pen) {
    let theme = app.theme();
    let names = (pen.room() * 2 / 5).clamp(8, 18);
    let selected = row.path().is_some() && row.path() == app.selected_value();
    pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
    match row {
        Row::Heading(scope) => {
            pen.put(scope, theme.dim());
        }
        Row::Variable { path, name } => {
            match app.unwritten_value(path) {
                Some(_) => _ = pen.put("*", theme.unwritten()),
                None => draw_fold(app, row, &mut pen),
            }
            pen.column(name, names, style);
            if let Some(variable) = app.view().variables.get(path) {
                draw_variable(app, path, variable, &mut pen);
            }
        }
        Row::Item { name, value, depth, .. } => {
            pen.column("", 2 * depth, theme.normal());
            draw_fold(app, row, &mut pen);
            pen.column(name, names.saturating_sub(2 * depth), style);
            draw_value(app, value, theme.normal(), &mut pen);
        }
        Row::Field { name, value, at, .. } => {
            draw_fold(app, row, &mut pen);
            pen.column(name, names, style);
            draw_age(app, *at, &mut pen);
            draw_value(app, value, theme.normal(), &mut pen);
        }
        Row::Message { name, value, at, way, .. } => {
            match way {
                Way::Output => _ = pen.put(glyphs::RIGHT, theme.dim()),
                Way::Input => draw_fold(app, row, &mut pen),
            }
            pen.put(name, style).put("  ", theme.normal());
            draw_age(app, *at, &mut pen);
            match way {
                Way::Output if app.shown_at().t.since(*at) > SENT => pen.put(glyphs::DASH, theme.dim()),
                _ => pen.put(&format::message(value), theme.normal()),
            };
        }
    }
    if selected && app.focus() == Pane::Variables {
        pen.wash(theme.selected());
    }
}

/// Whether there is more inside, where keys open it, and whether that is seen.
fn draw_fold(app: &App, row: &Row, pen: &mut Pen) {
    let open = row.path().is_some_and(|path| app.arrangement().open.contains(path));
    let mark = match row.inside(app.view()) {
        Some(_) if open => "-",
        Some(_) if app.focus() == Pane::Variables => "+",
        _ => " ",
    };
    pen.put(mark, app.theme().dim());
}

fn draw_age(app: &App, at: Time, pen: &mut Pen) {
    let age = format::duration(app.shown_at().t.since(at).ms());
    pen.put_right(" ", app.theme().dim()).right_column(&age, 8, app.theme().dim());
}

fn draw_variable(app: &App, path: &Path, variable: &Variable, pen: &mut Pen) {
    let theme = app.theme();
    match &variable.value {
        Some(value) => {
            let fresh = variable.is_fresh(app.shown_at().t);
            draw_value(app, value, if fresh { theme.fresh() } else { theme.normal() }, pen);
        }
        None => _ = pen.column_right(glyphs::DASH, VALUE, theme.dim()),
    }
    let room = pen.room().saturating_sub(3);
    let curve = variable.history.sampled(app.shown_at().t, usize::from(room.min(CURVE)));
    if room < 4 {
        return;
    }
    match aside(variable, app.unwritten_value(path)) {
        Aside::Set(value) => pen.put("  set ", theme.dim()).put(&format::value(value), theme.dim()),
        Aside::Was(previous) if room >= 5 => pen.put("  was ", theme.dim()).put(&format::value(previous), theme.dim()),
        _ if variable.value.is_some() && curve::moves(&curve) => {
            pen.put("  ", theme.dim()).put(&curve::sparkline(&curve), theme.dim())
        }
        _ => pen,
    };
}

/// Numbers at the right of their column, everything else from its left and as far as there is room.
fn draw_value(app: &App, value: &Value, style: Style, pen: &mut Pen) {
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
    /// A person set it, and its initialiser has taken that back since.
    Set(&'a Value),
    /// A person set it just now.
    Was(&'a Value),
}

fn aside<'a>(variable: &'a Variable, unwritten: Option<&'a Value>) -> Aside<'a> {
    let set_by_person = matches!(&*variable.by, "command" | "init");
    match (unwritten, &variable.previous) {
        (Some(value), _) if variable.value.as_ref() != Some(value) => Aside::Set(value),
        (_, Some(previous)) if set_by_person && variable.previous != variable.value => Aside::Was(previous),
        _ => Aside::Nothing,
    }
}
