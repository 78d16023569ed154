//! The first line: may the robot move, how fast, since when, is it there, and what became of the last save.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::runtime::record::Health;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::pen::Pen;
use crate::ui::view::{Edit, Mode, is_own_doing};

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let (theme, view) = (app.theme(), app.view());
    let mut pen = Pen::new(buffer, area, 0);
    let wide = area.width >= 60;
    pen.put(" ", theme.normal());
    if wide {
        pen.put(format::file_name(&app.options().file), theme.bold()).put("  ", theme.normal());
    }
    let mode = if app.halted() { &Mode::Stopped } else { &view.mode };
    let badge = badge(mode);
    pen.put(&format!(" {badge} "), theme.mode(mode));
    pen.column("", 9 - format::width(badge).min(8), theme.normal());
    let clock = format::clock(view.t);
    let narrow = area.width < 100;
    let pace = if narrow && *mode != Mode::Running { format!("step {}", view.step) } else { rate(app) };
    pen.column(&pace, if wide { 11 } else { 9 }, theme.normal());
    pen.column(&clock, format::width(&clock).max(6) + 2, theme.normal());
    if !narrow {
        pen.column(&format!("step {}", view.step), 14, theme.dim());
    }
    draw_bridges(app, &mut pen);
    draw_edit(app, &mut pen);
    if let Mode::Paused { reason } = mode
        && pen.room() > 12
        && !is_own_doing(reason)
    {
        pen.put(reason, theme.mode(mode).remove_modifier(ratatui::style::Modifier::REVERSED));
    }
}

fn badge(mode: &Mode) -> &'static str {
    match mode {
        Mode::Running => "RUN",
        Mode::Paused { .. } => "PAUSED",
        Mode::Stopped => "STOPPED",
    }
}

/// `10 Hz`, and where it isn't kept `7.3/10 Hz`.
fn rate(app: &App) -> String {
    let view = app.view();
    let wanted = format::rate(view.rate);
    let actual = view.actual.filter(|_| view.mode == Mode::Running);
    match actual {
        Some(actual) if view.rate == 0.0 => format!("max {}", format::rate(actual.round().max(1.0))),
        Some(actual) if (actual - view.rate).abs() > view.rate * 0.1 => format!("{actual:.1}/{wanted}"),
        _ => wanted,
    }
}

fn draw_bridges(app: &App, pen: &mut Pen) {
    let theme = app.theme();
    for (name, bridge) in app.view().bridges.iter().filter(|(_, bridge)| bridge.health.is_some()) {
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

fn draw_edit(app: &App, pen: &mut Pen) {
    let Some(edit) = &app.view().edit else { return };
    let (text, style) = edit_words(app, edit);
    pen.put_right(" ", style).put_right(&text, style).put_right("  ", Style::new());
}

fn edit_words(app: &App, edit: &Edit) -> (String, Style) {
    let theme = app.theme();
    match edit {
        Edit::Loaded => (String::new(), theme.dim()),
        Edit::Taken { changes, restarted: None } => (format!("saved: {changes}"), theme.normal()),
        Edit::Taken { changes, restarted: Some(_) } => (format!("restarted: {changes}"), theme.bold()),
        Edit::Mended => ("mended".into(), theme.normal()),
        Edit::Rejected { first, .. } if first.line == 0 => (first.message.clone(), theme.stop()),
        Edit::Rejected { first, others } => {
            let more = if *others > 0 { format!(" (+{others})") } else { String::new() };
            (format!("line {}: {}{more}", first.line, first.message), theme.stop())
        }
    }
}
