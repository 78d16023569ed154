//! What is wrong, always in the first rows; below it what happened, newest first, unless a reader holds a place.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{Title, draw_nothing};
use crate::runtime::record::Level;
use crate::ui::app::{App, LogRow};
use crate::ui::format;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::view::{Entry, Gravity, Kind, Problem, name};

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let window = app.reading().window(app.view(), usize::from(area.height));
    if window.rows.is_empty() {
        draw_nothing(app, area, buffer, "Nothing happened yet.");
    }
    for (y, row) in (0..area.height).zip(&window.rows) {
        let mut pen = Pen::new(buffer, area, y);
        let held = app.reading().place.as_ref() == Some(row);
        pen.put(if held { "▸" } else { " " }, app.theme().bold());
        match row {
            LogRow::Problem(key) => {
                let problem = app.view().problems.iter().find(|problem| problem.key == *key);
                problem.into_iter().for_each(|problem| draw_problem(app, problem, &mut pen));
            }
            LogRow::Entry(number) => {
                app.view().journal.get(*number).into_iter().for_each(|entry| draw_entry(app, entry, &mut pen));
            }
        }
        if held && app.focus() == Pane::Log {
            pen.wash(app.theme().selected());
        }
    }
    Title::new(title(app), note(app))
}

fn draw_problem(app: &App, problem: &Problem, pen: &mut Pen) {
    let theme = app.theme();
    let time = if problem.count > 0 { format::clock(problem.last) } else { String::new() };
    draw_time(app, &time, pen);
    pen.right_column(&line(problem.key.line), 5, theme.dim());
    if problem.count > 1 {
        pen.put_right(&format!(" ×{}", problem.count), theme.normal());
    }
    pen.put(word(problem.gravity), theme.gravity(problem.gravity)).put("  ", theme.normal());
    if !problem.state.is_empty() {
        pen.put(name(&problem.state), theme.normal()).put(": ", theme.normal());
    }
    pen.put(&problem.message, theme.normal());
}

fn draw_entry(app: &App, entry: &Entry, pen: &mut Pen) {
    let theme = app.theme();
    draw_time(app, &format::clock(entry.t), pen);
    match entry.kind {
        Kind::Log(level) => draw_log(app, entry, level, pen),
        Kind::Change | Kind::Note => {
            pen.put(&entry.text, theme.normal());
        }
    }
}

fn draw_log(app: &App, entry: &Entry, level: Level, pen: &mut Pen) {
    let theme = app.theme();
    let at = entry.place.as_ref().map_or(String::new(), |(_, number)| line(*number));
    if !at.is_empty() {
        pen.right_column(&at, 5, theme.dim());
    }
    let (word, text) = match level {
        Level::Error => ("error", theme.normal()),
        Level::Warn => ("warn", theme.normal()),
        Level::Info => ("info", theme.normal()),
        Level::Debug => ("debug", theme.dim()),
    };
    pen.put(word, theme.level(level)).put("  ", theme.normal());
    if !entry.state.is_empty() {
        pen.put(name(&entry.state), text).put(": ", text);
    }
    pen.put(&entry.text, text);
}

/// Left out where the words need the room.
fn draw_time(app: &App, time: &str, pen: &mut Pen) {
    if pen.room() >= 30 {
        pen.column_right(time, 6, app.theme().dim()).put("  ", app.theme().dim());
    }
}

fn word(gravity: Gravity) -> &'static str {
    match gravity {
        Gravity::Error => "error",
        Gravity::Warning => "warn",
        Gravity::Hint => "hint",
    }
}

fn line(number: usize) -> String {
    if number > 0 { format!(":{number}") } else { String::new() }
}

fn title(app: &App) -> String {
    let count = |gravity| app.view().problems.iter().filter(|problem| problem.gravity == gravity).count();
    let mut title = String::from(Pane::Log.title());
    for (gravity, noun) in [(Gravity::Error, "error"), (Gravity::Warning, "warning")] {
        match count(gravity) {
            0 => (),
            1 => title += &format!("  1 {noun}"),
            n => title += &format!("  {n} {noun}s"),
        }
    }
    title
}

fn note(app: &App) -> String {
    let reading = app.reading();
    if reading.place.is_some() {
        let newer = app.view().journal.next().saturating_sub(reading.since);
        return if newer > 0 { format!("held, {newer} newer: Esc") } else { "held: Esc".into() };
    }
    reading.filter.label().into()
}
