//! What the last save did, over the log for a moment: only where there is more to say than the status line holds.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::ui::action::Action;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::pen::Pen;
use crate::ui::view::{Outcome, describe_shortly, name};

/// More changes than these are counted.
const TOLD: usize = 3;

/// `place`: the log, or what there is instead of it. The log says the same in short, so it is what may be covered.
pub fn draw(app: &App, place: Rect, buffer: &mut Buffer) {
    let Some(outcome) = app.news() else { return };
    let (theme, lines) = (app.theme(), lines(app, outcome, place.width.saturating_sub(2)));
    let height = (lines.len() as u16 + 1).min(place.bottom().saturating_sub(1));
    let y = place.y.min(place.bottom() - height);
    let area = Rect { y, height, ..place };
    move_junction(place, y, buffer);
    let mut title = Pen::new(buffer, area, 0);
    title
        .put(glyphs::RULE, theme.rule())
        .put(" ", theme.rule())
        .put("saved", theme.fresh())
        .put(" ", theme.rule())
        .fill(glyphs::RULE, theme.rule());
    for (y, (text, style)) in (1..height).zip(&lines) {
        Pen::new(buffer, area, y).put(" ", Style::reset()).put(text, *style).fill(" ", Style::reset());
    }
}

/// What becomes of an upright rule where a title no longer meets it from the right.
const GONE: [(&str, &str); 2] = [(glyphs::MEETS_RIGHT, glyphs::UPRIGHT), (glyphs::MEETS_ALL, glyphs::MEETS_LEFT)];
/// And where one does now.
const MET: [(&str, &str); 2] = [(glyphs::UPRIGHT, glyphs::MEETS_RIGHT), (glyphs::MEETS_LEFT, glyphs::MEETS_ALL)];

/// The rule at the left meets the title where that stands now.
fn move_junction(place: Rect, y: u16, buffer: &mut Buffer) {
    let Some(x) = place.x.checked_sub(1).filter(|_| y < place.y) else { return };
    for (y, changes) in [(place.y, GONE), (y, MET)] {
        let there = buffer.cell_mut((x, y)).into_iter();
        there.for_each(|cell| {
            if let Some((_, now)) = changes.into_iter().find(|(was, _)| cell.symbol() == *was) {
                cell.set_symbol(now);
            }
        });
    }
}

fn lines(app: &App, outcome: &Outcome, room: u16) -> Vec<(String, Style)> {
    let theme = app.theme();
    let mut lines = Vec::new();
    let mut add = |text: &str, style: Style| {
        lines.extend(format::wrap(text, room).into_iter().map(|line| (line, style)));
    };
    outcome.effects().iter().for_each(|effect| add(effect, theme.bold()));
    if !outcome.disturbs() {
        add("nothing that runs is disturbed", theme.dim());
    }
    for change in outcome.changes.iter().take(TOLD) {
        add(&format::fit(&describe_shortly(change), room), theme.normal());
    }
    if let Some(more @ 1..) = outcome.changes.len().checked_sub(TOLD) {
        add(&format!("and {more} more"), theme.dim());
    }
    let lost: Vec<String> = app.view().lost().map(|(var, value)| format!("{} {value}", name(var))).collect();
    let key = app.keys().name(Action::GiveBack);
    match lost.len() {
        0 => (),
        1 => add(&format!("tuned: {} - {key} gives it back", lost[0]), theme.fresh()),
        _ => add(&format!("tuned: {} - {key} gives them back", lost.join(", ")), theme.fresh()),
    }
    lines
}
