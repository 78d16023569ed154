//! A list over all panes: its title, which says how much there is below, and room for its lines.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::ui::action::Action;
use crate::ui::app::App;
use crate::ui::glyphs;
use crate::ui::pen::Pen;

/// Writes the title; `length` lines are shown from `top` on. Where they go.
pub fn title(app: &App, text: &str, (top, length): (usize, usize), area: Rect, buffer: &mut Buffer) -> Rect {
    let theme = app.theme();
    let inside = Rect { y: area.y + 1.min(area.height), height: area.height.saturating_sub(1), ..area };
    let below = length.saturating_sub(top + usize::from(inside.height));
    let more = if below > 0 { format!(" {below} more: {} ", app.keys().name(Action::PageDown)) } else { String::new() };
    let mut pen = Pen::new(buffer, area, 0);
    pen.put(glyphs::RULE, theme.rule()).put(" ", theme.rule()).put_right(glyphs::RULE, theme.rule());
    pen.put_right(&more, theme.dim())
        .put(text, theme.focused_title())
        .put(" ", theme.rule())
        .fill(glyphs::RULE, theme.rule());
    inside
}
