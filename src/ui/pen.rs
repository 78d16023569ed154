//! Writes one row of a pane from both its ends, so that words keep left and numbers keep right and never meet.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::format::{fit, width};

pub struct Pen<'a> {
    buffer: &'a mut Buffer,
    row: Rect,
    left: u16,
    right: u16,
}

impl<'a> Pen<'a> {
    /// For the row `y` below the top of `area`; writes nothing where the area has no such row.
    pub fn new(buffer: &'a mut Buffer, area: Rect, y: u16) -> Pen<'a> {
        let area = area.intersection(buffer.area);
        let height = u16::from(y < area.height);
        let row = Rect { y: area.y.saturating_add(y), height, ..area };
        Pen { buffer, row, left: 0, right: area.width }
    }

    /// Columns still free.
    pub fn room(&self) -> u16 {
        if self.row.height == 0 { 0 } else { self.right - self.left }
    }

    /// The column of the screen that is written next from the left.
    pub fn at(&self) -> u16 {
        self.row.x + self.left
    }

    /// The column of the screen before which is written next from the right.
    pub fn end(&self) -> u16 {
        self.row.x + self.right
    }

    pub fn put(&mut self, text: &str, style: Style) -> &mut Self {
        let text = fit(text, self.room());
        self.write(self.left, &text, style);
        self.left += width(&text);
        self
    }

    /// In exactly `columns`, as far as there is room.
    pub fn column(&mut self, text: &str, columns: u16, style: Style) -> &mut Self {
        let columns = columns.min(self.room());
        let text = fit(text, columns);
        self.write(self.left, &text, style);
        self.left += columns;
        self
    }

    /// In exactly `columns`, at the right of them.
    pub fn column_right(&mut self, text: &str, columns: u16, style: Style) -> &mut Self {
        let columns = columns.min(self.room());
        let text = fit(text, columns);
        self.write(self.left + columns - width(&text), &text, style);
        self.left += columns;
        self
    }

    /// At the right end of what is free.
    pub fn put_right(&mut self, text: &str, style: Style) -> &mut Self {
        let text = fit(text, self.room());
        self.right -= width(&text);
        self.write(self.right, &text, style);
        self
    }

    /// At the right end, in exactly `columns`.
    pub fn right_column(&mut self, text: &str, columns: u16, style: Style) -> &mut Self {
        let columns = columns.min(self.room());
        let text = fit(text, columns);
        self.write(self.right - width(&text), &text, style);
        self.right -= columns;
        self
    }

    /// The rest in one glyph.
    pub fn fill(&mut self, glyph: &str, style: Style) -> &mut Self {
        let text = glyph.repeat(self.room() as usize);
        self.put(&text, style)
    }

    /// Lays a style over the whole row.
    pub fn wash(&mut self, style: Style) -> &mut Self {
        self.buffer.set_style(self.row, style);
        self
    }

    fn write(&mut self, at: u16, text: &str, style: Style) {
        if self.row.height > 0 && !text.is_empty() {
            let (x, y) = (self.row.x + at, self.row.y);
            self.buffer.set_stringn(x, y, text, (self.row.width - at) as usize, style);
        }
    }
}
