//! The frame: status, panes, the rules between them, footer, and the help over all when asked for.

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{App, Overlay};
use crate::ui::action::Action;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::{Layout, Pane};
use crate::ui::panes::{self, breakpoints, footer, held, help, menu, news, palette, status, strip};
use crate::ui::pen::Pen;

impl App {
    pub fn draw(&self, frame: &mut Frame) {
        let area = frame.area();
        if let Some(cursor) = self.paint(area, frame.buffer_mut()) {
            frame.set_cursor_position(cursor);
        }
    }

    /// Where the cursor stands, when something is typed.
    pub fn paint(&self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let cursor = self.paint_whole(area, buffer);
        self.options.settings.charset.lay_over(buffer);
        cursor
    }

    fn paint_whole(&self, whole: Rect, buffer: &mut Buffer) -> Option<Position> {
        let (above, area) = strip::divide(self, whole);
        if let Some(tour) = self.tour() {
            strip::draw(self, tour, (above, whole), buffer);
        }
        let Some(layout) = self.layout(area) else {
            self.paint_too_small(area, buffer);
            return None;
        };
        status::draw(self, layout.status, buffer);
        let body = Rect { y: area.y + 1, height: area.height - 2, ..area };
        match &self.overlay {
            Overlay::Help(help) => help::draw(self, help, body, buffer),
            Overlay::Held { top } => held::draw(self, *top, body, buffer),
            Overlay::Breakpoints { at } => breakpoints::draw(self, *at, body, buffer),
            Overlay::Menu(menu) => {
                self.paint_panes(&layout, buffer);
                menu::draw(self, menu, body, buffer);
            }
            Overlay::Palette(palette) => {
                self.paint_panes(&layout, buffer);
                palette::draw(self, palette, body, buffer);
            }
            Overlay::Nothing | Overlay::Typing(_) => {
                self.paint_panes(&layout, buffer);
                news::draw(self, layout.area(Pane::Log).unwrap_or(body), buffer);
            }
        }
        footer::draw(self, layout.footer, buffer).cursor
    }

    fn paint_panes(&self, layout: &Layout, buffer: &mut Buffer) {
        for &(pane, area) in &layout.panes {
            panes::draw(self, pane, area, buffer);
        }
        for rule in layout.rules() {
            for y in rule.top()..rule.bottom() {
                buffer.set_string(rule.x, y, junction(layout, rule.x, y), self.theme().rule());
            }
            // Where it ends at a title.
            if let Some(cell) = buffer.cell_mut((rule.x, rule.bottom())).filter(|cell| cell.symbol() == glyphs::RULE) {
                cell.set_symbol(glyphs::MEETS_ABOVE);
            }
        }
    }

    fn paint_too_small(&self, area: Rect, buffer: &mut Buffer) {
        let stop = self.keys().name(Action::Runstop);
        let lines = format::wrap(&format!("lrp needs 20x5; {stop} stops the robot"), area.width);
        for (y, line) in (0..area.height).zip(lines) {
            Pen::new(buffer, area, y).put(&line, self.theme().normal());
        }
    }
}

/// A rule's glyph where titles meet it from the left, the right or both.
fn junction(layout: &Layout, x: u16, y: u16) -> &'static str {
    let mut titles = layout.panes.iter().map(|(_, area)| area).filter(|area| area.y == y && area.height > 0);
    let left = titles.clone().any(|area| area.right() == x);
    let right = titles.any(|area| area.x == x + 1);
    let top = layout.panes.iter().all(|(_, area)| area.y >= y);
    match (left, right) {
        (true, true) if top => glyphs::MEETS_BELOW,
        (true, true) => glyphs::MEETS_ALL,
        (true, false) => glyphs::MEETS_LEFT,
        (false, true) => glyphs::MEETS_RIGHT,
        (false, false) => glyphs::UPRIGHT,
    }
}
