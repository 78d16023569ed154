//! The edit that waits: each of its changes with what it would do, and what was found in it.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::detail::{self, Tone};
use super::sheet;
use crate::runtime::record::{Change, Element, Op};
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::pen::Pen;
use crate::ui::view::{Origin, Outcome, Problem, describe};

/// For a screen of this many columns.
pub fn lines(app: &App, width: u16) -> Vec<(Tone, String)> {
    let Some(held) = &app.view().held else { return Vec::new() };
    let room = width.saturating_sub(4);
    let outcome = Outcome::of_held(held);
    let effects: Vec<_> = outcome.changes.iter().map(|change| (change, outcome.effect_of(change))).collect();
    let mut lines = Vec::new();
    for sentence in would(&outcome, effects.iter().any(|(_, effect)| effect.is_some())) {
        lines.extend(format::wrap(&sentence, room).into_iter().map(|line| (Tone::Heading, line)));
    }
    for (change, effect) in effects {
        let effect = effect.unwrap_or_else(|| undisturbed(change).into());
        lines.extend(format::wrap(&describe(change), room).into_iter().map(|line| (Tone::Text, line)));
        match lines.last_mut() {
            Some((_, last)) if format::width(last) + format::width(&effect) + 4 <= room => {
                *last += &format!("    {effect}");
            }
            _ => {
                let wrapped = format::wrap(&effect, room.saturating_sub(2));
                lines.extend(wrapped.into_iter().map(|line| (Tone::Aside, format!("  {line}"))));
            }
        }
    }
    for finding in &held.findings {
        let gravity = Problem::from_finding(finding, Origin::Check, app.view().t).gravity;
        let text = format!("{} {}", gravity.word(), app.view().headline(finding));
        lines.extend(format::wrap(&text, room).into_iter().map(|line| (Tone::Gravity(gravity), line)));
    }
    lines
}

/// What it would do to what runs, on the whole. Why, where that isn't told with one of the changes.
fn would(outcome: &Outcome, is_told: bool) -> Vec<String> {
    if !outcome.disturbs() {
        return vec!["nothing that runs is disturbed".into()];
    }
    let restarts = outcome.restarted.iter().map(|reason| match is_told {
        true => "the program begins again".to_string(),
        false => format!("the program begins again: {reason}"),
    });
    let again = outcome.again.iter().map(|machine| format!("starts again: {machine}"));
    let ends = outcome.discarded.iter().map(|machine| format!("ends: {machine}"));
    restarts.chain(again).chain(ends).collect()
}

fn undisturbed(change: &Change) -> &'static str {
    match (change.kind, change.op) {
        (Element::Variable, Op::Changed) => "takes its new value",
        _ => "nothing is disturbed",
    }
}

pub fn draw(app: &App, top: usize, area: Rect, buffer: &mut Buffer) {
    let lines = lines(app, area.width);
    let inside = sheet::title(app, "held edit", (top, lines.len()), area, buffer);
    for (y, (tone, line)) in (0..inside.height).zip(lines.iter().skip(top)) {
        let indent = if matches!(tone, Tone::Heading) { " " } else { "   " };
        Pen::new(buffer, inside, y).put(indent, Style::new()).put(line, detail::style(app, *tone));
    }
}
