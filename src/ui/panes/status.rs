//! The first line: may the robot move, how fast, since when, is it there, and what became of the last save.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::runtime::command::{OnEdit, OnError, Saves};
use crate::runtime::record::Health;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::pen::Pen;
use crate::ui::view::{Choices, Edit, Mode, is_own_doing, name};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Room {
    /// For what matters.
    Scarce,
    /// For words.
    Usual,
    /// For what could be done without.
    Ample,
}

impl Room {
    fn of(columns: u16) -> Room {
        match columns {
            0..60 => Room::Scarce,
            60..100 => Room::Usual,
            _ => Room::Ample,
        }
    }
}

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let mut pen = Pen::new(buffer, area, 0);
    let room = Room::of(area.width);
    if room == Room::Scarce {
        draw_error_count(app, &mut pen);
    }
    pen.put(" ", theme.normal());
    if room == Room::Ample || (room == Room::Usual && !has_message(app) && !has_choices(app)) {
        pen.put(&format::fit(format::file_name(&app.options().file), 24), theme.bold()).put("  ", theme.normal());
    }
    let (badge, mode) = badge(app);
    pen.put(&format!(" {badge} "), theme.mode(mode));
    pen.column("", 7 - format::width(badge).min(6), theme.normal());
    if room > Room::Scarce || !paused_for_a_reason(mode) {
        draw_pace(app, mode, room, &mut pen);
    }
    draw_choices(app, room, &mut pen);
    if room > Room::Scarce {
        draw_errors(app, &mut pen);
    }
    if let Mode::Waiting { robot, why } = mode {
        pen.put(&format!("for {robot}, {why}"), theme.normal());
        return;
    }
    draw_bridges(app, room, &mut pen);
    if let Mode::Paused { reason } = mode
        && paused_for_a_reason(mode)
    {
        let style = theme.mode(mode).remove_modifier(ratatui::style::Modifier::REVERSED);
        let words = reason_in(reason, pen.room().saturating_sub(1));
        pen.put(&words, style).put("  ", theme.normal());
    }
    draw_unwritten(app, room, &mut pen);
    draw_edit(app, &mut pen);
}

fn paused_for_a_reason(mode: &Mode) -> bool {
    matches!(mode, Mode::Paused { reason } if !is_own_doing(reason))
}

/// With names instead of paths where there is little room, and then without saying that it is a breakpoint.
fn reason_in(reason: &str, room: u16) -> String {
    if format::width(reason) <= room {
        return reason.into();
    }
    let words: Vec<&str> = reason.split(' ').map(name).collect();
    let short = words.join(" ");
    let rest = reason.strip_prefix("breakpoint: ").unwrap_or(&short);
    let fitting = [&*short, rest].into_iter().find(|text| format::width(text) <= room);
    fitting.unwrap_or_else(|| short.strip_prefix("breakpoint: ").unwrap_or(&short)).into()
}

/// Whether anything is to be said of how edits and errors are met.
fn has_choices(app: &App) -> bool {
    app.view().choices != Choices::default() || app.view().held.is_some()
}

/// What isn't as it is by default, and the edit that waits; their first letters where there is no room for words.
fn draw_choices(app: &App, room: Room, pen: &mut Pen) {
    let (theme, view) = (app.theme(), app.view());
    let words = |ample: &'static str, usual, scarce| match room {
        Room::Ample => ample,
        Room::Usual => usual,
        Room::Scarce => scarce,
    };
    let mut told = Vec::new();
    if view.choices.on_edit == OnEdit::Keep {
        told.push((words("edits keep", "keep", "keep"), theme.bold()));
    }
    match (&view.held, view.choices.saves) {
        (Some(_), _) => told.push((words("1 edit held", "1 edit held", "1 held"), theme.held())),
        (None, Saves::Hold) => told.push((words("saves held", "hold", "hold"), theme.held())),
        (None, Saves::Apply) => (),
    }
    if view.choices.on_error == OnError::Pause {
        told.push((words("errors pause", "on-error", "err"), theme.bold()));
    }
    let needed = told.iter().map(|(word, _)| format::width(word) + 1).sum::<u16>().saturating_sub(1);
    let fits = needed <= pen.room();
    for (word, style) in &told {
        let word = if fits { word } else { &word[..1] };
        pen.put(word, *style).put(if room > Room::Scarce { "  " } else { " " }, theme.normal());
    }
}

/// How fast it steps, for how long; nothing where there is nothing that could step.
fn draw_pace(app: &App, mode: &Mode, room: Room, pen: &mut Pen) {
    let (theme, view) = (app.theme(), app.view());
    if view.broken().is_some() || matches!(mode, Mode::Waiting { .. }) {
        return;
    }
    let clock = format::clock(app.shown_at().t);
    let stands = room < Room::Ample && *mode != Mode::Running;
    let pace = if stands { format!("step {}", app.shown_at().step) } else { rate(app) };
    let column = if room > Room::Scarce { 9 } else { 7 };
    pen.column(&pace, format::width(&pace).max(column) + 2, theme.normal());
    pen.column(&clock, format::width(&clock).max(6) + 2, theme.normal());
    if room == Room::Ample {
        pen.column(&format!("step {}", app.shown_at().step), 14, theme.dim());
    }
}

fn draw_errors(app: &App, pen: &mut Pen) {
    match app.view().errors() {
        0 => (),
        1 => _ = pen.put("1 error  ", app.theme().stop()),
        n => _ = pen.put(&format!("{n} errors  "), app.theme().stop()),
    }
}

/// `!2` at the right end, so that it is seen however short the line is.
fn draw_error_count(app: &App, pen: &mut Pen) {
    let (errors, style) = (app.view().errors(), app.theme().stop());
    if errors > 0 {
        pen.put_right(" ", style).put_right(&format!("!{errors}"), style).put_right(" ", style);
    }
}

/// Whether there is more to say than the program's name.
fn has_message(app: &App) -> bool {
    let view = app.view();
    let rejected = matches!(view.edit, Some(Edit::Rejected { .. }));
    rejected || paused_for_a_reason(&view.mode)
}

fn badge(app: &App) -> (&'static str, &Mode) {
    let view = app.view();
    if view.broken().is_some() {
        return ("BROKEN", &Mode::Stopped);
    }
    match &view.mode {
        _ if app.halted() => ("STOPPED", &Mode::Stopped),
        mode @ Mode::Waiting { .. } => ("WAITS", mode),
        mode @ Mode::Running => ("RUN", mode),
        mode @ Mode::Paused { .. } => ("PAUSED", mode),
        mode @ Mode::Stopped => ("STOPPED", mode),
    }
}

/// `10 Hz`, and where it isn't kept `7.3/10 Hz`.
fn rate(app: &App) -> String {
    let view = app.view();
    let wanted = format::rate(view.rate);
    let actual = view.actual.filter(|_| view.mode == Mode::Running);
    match actual {
        Some(actual) if view.rate == 0.0 => format!("max {}", format::rate(actual.round().max(1.0))),
        Some(actual) if (actual - view.rate).abs() > view.rate * 0.1 => format!("{}/{wanted}", steps(actual)),
        _ => wanted,
    }
}

/// `9.3`, `315`
fn steps(rate: f64) -> String {
    if rate < 9.95 { format!("{rate:.1}") } else { format::rate(rate.round()).replace(" Hz", "") }
}

/// That one is up goes without saying where there is little room.
fn draw_bridges(app: &App, room: Room, pen: &mut Pen) {
    let theme = app.theme();
    let told = |health: Option<Health>| health.is_some_and(|health| room == Room::Ample || health != Health::Up);
    for (name, bridge) in app.view().bridges.iter().filter(|(_, bridge)| told(bridge.health)) {
        let health = match bridge.health {
            Some(Health::Up) => "up",
            Some(Health::Connecting) => "connecting",
            Some(Health::Lost) => "LOST",
            None => "",
        };
        let style = theme.health(bridge.health);
        let words = format!("{name} {health}");
        if pen.room() > format::width(&words) {
            pen.put(&words, style).put("  ", theme.normal());
        }
    }
}

/// How many values were set by hand that no file has, where nothing more important needs the room.
fn draw_unwritten(app: &App, room: Room, pen: &mut Pen) {
    let n = app.unwritten().count();
    let words = [format!("{n} set by hand, not written"), format!("{n} unwritten"), format!("*{n}")];
    let words = match room {
        Room::Ample => &words[..],
        Room::Usual => &words[1..],
        Room::Scarce => &words[2..],
    };
    let edit = app.view().edit.as_ref().map_or(0, |edit| format::width(&edit_words(app, edit).0) + 4);
    let fitting = words.iter().find(|words| pen.room() >= format::width(words) + edit);
    if let Some(words) = fitting.filter(|_| n > 0) {
        pen.put(words, app.theme().dim()).put("  ", Style::new());
    }
}

/// In fewer columns a message says nothing.
const SENTENCE: u16 = 16;

fn draw_edit(app: &App, pen: &mut Pen) {
    let Some(edit) = &app.view().edit else { return };
    let (mut text, style) = edit_words(app, edit);
    if let Edit::Rejected { first, .. } = edit
        && pen.room() < SENTENCE
        && first.line > 0
    {
        text = format!("line {}", first.line);
    }
    if pen.room() < SENTENCE && format::width(&text) + 3 > pen.room() {
        text.truncate(text.find(':').unwrap_or(0));
    }
    pen.put_right(" ", style).put_right(&text, style).put_right("  ", Style::new());
}

fn edit_words(app: &App, edit: &Edit) -> (String, Style) {
    let theme = app.theme();
    match edit {
        Edit::Loaded => (String::new(), theme.dim()),
        Edit::Taken(outcome) if outcome.restarted.is_some() => {
            (format!("restarted: {}", outcome.summary()), theme.bold())
        }
        Edit::Taken(outcome) if outcome.disturbs() => (format!("again: {}", outcome.summary()), theme.bold()),
        Edit::Taken(outcome) => (format!("saved: {}", outcome.summary()), theme.normal()),
        // That it is held is told beside it.
        Edit::Held { changes } => (changes.clone(), theme.dim()),
        Edit::Dropped => ("edit dropped".into(), theme.normal()),
        Edit::Restarted => ("restarted".into(), theme.normal()),
        Edit::Mended => ("mended".into(), theme.normal()),
        Edit::Rejected { first, .. } => (app.view().headline(first), theme.stop()),
    }
}
