//! The menu of what is selected, over the panes.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::ui::app::App;
use crate::ui::glyphs;
use crate::ui::menu::{KEY, Menu};
use crate::ui::pen::Pen;

/// `body`: what it may cover.
pub fn draw(app: &App, menu: &Menu, body: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let area = menu.area(body);
    for y in 0..area.height {
        for x in area.x..area.right() {
            buffer[(x, area.y + y)].reset();
        }
        let mut pen = Pen::new(buffer, area, y);
        if y == 0 {
            pen.put(glyphs::TOP_LEFT, theme.rule())
                .put(glyphs::RULE, theme.rule())
                .put(" ", theme.rule())
                .put_right(glyphs::TOP_RIGHT, theme.rule())
                .put(&menu.title, theme.bold());
            pen.put(" ", theme.rule()).fill(glyphs::RULE, theme.rule());
        } else if y + 1 == area.height {
            pen.put(glyphs::BOTTOM_LEFT, theme.rule())
                .put_right(glyphs::BOTTOM_RIGHT, theme.rule())
                .fill(glyphs::RULE, theme.rule());
        } else if let Some(entry) = menu.rows.get(usize::from(y) - 1) {
            let key = app.keys().keys(entry).first().map_or_else(String::new, ToString::to_string);
            pen.put(glyphs::UPRIGHT, theme.rule()).put_right(glyphs::UPRIGHT, theme.rule());
            let selected = usize::from(y) - 1 == menu.row;
            pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
            pen.put_right(" ", theme.normal()).right_column(&key, KEY, theme.key());
            pen.put(entry.help, theme.normal());
            if selected {
                let row = Rect { x: area.x + 1, y: area.y + y, width: area.width.saturating_sub(2), height: 1 };
                buffer.set_style(row, theme.selected());
            }
        }
    }
}
