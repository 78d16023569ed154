//! All breakpoints over the whole screen, to clear them.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::sheet;
use crate::runtime::record::Setter;
use crate::ui::action::Action;
use crate::ui::app::{App, top_for};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::pen::Pen;

/// A breakpoint's mark, which tells who set it.
pub fn mark(by: Setter) -> &'static str {
    match by {
        Setter::Command => glyphs::BREAK,
        Setter::Source => glyphs::BREAK_IN_TEXT,
    }
}

fn top(at: usize, length: usize, area: Rect) -> usize {
    top_for(0, Some(at), length, usize::from(area.height.saturating_sub(1)))
}

/// The breakpoint at a cell, where number `at` of them is selected.
pub fn row_at(length: usize, at: usize, area: Rect, cell: Position) -> Option<usize> {
    let row = usize::from(cell.y.checked_sub(area.y + 1)?);
    Some(top(at, length, area) + row).filter(|&row| area.contains(cell) && row < length)
}

pub fn draw(app: &App, at: usize, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let all = &app.view().breakpoints;
    let top = top(at, all.len(), area);
    let inside = sheet::title(app, "breakpoints", (top, all.len()), area, buffer);
    if all.is_empty() {
        let lines = format::wrap(&none(app), inside.width.saturating_sub(2));
        for (y, line) in (0..inside.height).zip(lines) {
            Pen::new(buffer, inside, y).put(" ", theme.dim()).put(&line, theme.dim());
        }
    }
    for (y, (index, breakpoint)) in (0..inside.height).zip(all.iter().enumerate().skip(top)) {
        let mut pen = Pen::new(buffer, inside, y);
        pen.put(if index == at { glyphs::HERE } else { " " }, theme.bold());
        pen.put(mark(breakpoint.by), theme.breakpoint()).put(" ", theme.normal());
        if breakpoint.by == Setter::Source && pen.room() > 50 {
            pen.put_right(" ", theme.dim()).put_right("in the text", theme.dim()).put_right("  ", theme.dim());
        }
        pen.put(&breakpoint.at.to_string(), theme.normal());
        if index == at {
            pen.wash(theme.selected());
        }
    }
}

fn none(app: &App) -> String {
    let (set, ask) = (app.keys().name(Action::ToggleBreakpoint), app.keys().name(Action::BreakWhen));
    format!(
        "No breakpoints. {set} sets one at the selected state; {ask} asks for a condition. A transition: select it in \
         the log or in the detail of a state, then {set}. In the program's text: (break)."
    )
}
