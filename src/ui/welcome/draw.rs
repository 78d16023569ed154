//! The welcome's frame: who this is, the behaviours, what else there is, the keys.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{Row, Welcome};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::pen::Pen;

/// Rows that are no behaviours: the heading, the two titles, the tour, a new one, the keys, and what is between them.
const AROUND: u16 = 8;

impl Welcome {
    /// Rows for behaviours.
    pub(super) fn page(&self) -> usize {
        usize::from(self.options.size.height.saturating_sub(AROUND)).max(1)
    }

    /// Where the cursor stands, when something is typed.
    pub fn paint(&self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = &self.options.settings.theme;
        Pen::new(buffer, area, 0)
            .put(" ", theme.normal())
            .put("lrp", theme.bold())
            .put("   Live Robot Programming: state machines that change while they run", theme.normal());
        let below =
            self.paint_behaviours(Rect { y: area.y + 2, height: area.height.saturating_sub(2), ..area }, buffer);
        self.paint_others(Rect { y: below, height: area.bottom().saturating_sub(below), ..area }, buffer);
        let cursor = self.paint_footer(area, buffer);
        self.options.settings.charset.lay_over(buffer);
        cursor
    }

    /// The row after them.
    fn paint_behaviours(&self, area: Rect, buffer: &mut Buffer) -> u16 {
        let theme = &self.options.settings.theme;
        let title = format!("behaviours in {} and below", format::fit(&self.options.folder, area.width / 2));
        self.paint_title(&title, &self.count(), Pen::new(buffer, area, 0));
        let all = self.behaviours();
        let page = self.page();
        if all.is_empty() {
            Pen::new(buffer, area, 1).put("  ", theme.normal()).put(&self.emptiness(), theme.dim());
            return area.y + 3;
        }
        let shown = all.iter().enumerate().skip(self.top).take(page);
        let names: Vec<(usize, String)> =
            shown.map(|(at, behaviour)| (at, plain(&behaviour.file.to_string_lossy()))).collect();
        let widest = names.iter().map(|(_, name)| format::width(name)).max().unwrap_or(0);
        let column = widest.min(area.width / 2) + 2;
        let mut y = 1;
        for (at, name) in &names {
            let pen = Pen::new(buffer, area, y);
            self.paint_row(Row::Behaviour(*at), name, column, &all[*at].about, pen);
            y += 1;
        }
        area.y + y + 1
    }

    fn paint_others(&self, area: Rect, buffer: &mut Buffer) {
        let tour = match &self.options.tour {
            Some(progress) => format!("go on where you were: {progress} done"),
            None => "ten minutes in the simulator, each thing done once".to_string(),
        };
        self.paint_title("or", "", Pen::new(buffer, area, 0));
        self.paint_row(Row::Tour, "take the tour", 19, &tour, Pen::new(buffer, area, 1));
        let new = "a first program to edit, in this folder";
        self.paint_row(Row::New, "a new behaviour", 19, new, Pen::new(buffer, area, 2));
    }

    fn paint_title(&self, title: &str, note: &str, mut pen: Pen) {
        let theme = &self.options.settings.theme;
        pen.put(glyphs::RULE, theme.rule()).put(" ", theme.rule()).put_right(glyphs::RULE, theme.rule());
        if !note.is_empty() && pen.room() > 24 {
            pen.put_right(" ", theme.title()).put_right(note, theme.title()).put_right(" ", theme.title());
        }
        pen.put(title, theme.bold()).put(" ", theme.rule()).fill(glyphs::RULE, theme.rule());
    }

    fn paint_row(&self, row: Row, name: &str, column: u16, about: &str, mut pen: Pen) {
        let theme = &self.options.settings.theme;
        let is_selected = self.selected == row;
        pen.put(if is_selected { glyphs::HERE } else { " " }, theme.normal()).put(" ", theme.normal());
        pen.column(name, column, theme.bold()).put(about, theme.normal());
        if is_selected {
            pen.wash(theme.selected());
        }
    }

    fn paint_footer(&self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = &self.options.settings.theme;
        let mut pen = Pen::new(buffer, area, area.height.saturating_sub(1));
        pen.fill(" ", theme.normal());
        if let (Some(message), Some(_)) = (&self.message, &self.naming) {
            let lines = format::wrap(message, area.width.saturating_sub(2));
            for (up, line) in (1..area.height).zip(lines.iter().rev()) {
                let mut pen = Pen::new(buffer, area, area.height - 1 - up);
                pen.put(" ", theme.stop()).put(line, theme.stop()).fill(" ", theme.normal());
            }
        }
        let mut pen = Pen::new(buffer, area, area.height.saturating_sub(1));
        pen.put(" ", theme.normal());
        match (&self.naming, &self.message) {
            (Some(input), _) => {
                pen.put_right("Enter makes it  Esc leaves ", theme.dim());
                pen.put("name: ", theme.bold());
                let (start, room) = (pen.at(), pen.room().saturating_sub(5));
                let scroll = input.visual_scroll(usize::from(room));
                let typed: String = input.value().chars().skip(scroll).collect();
                pen.put(&format::fit(&plain(&typed), room), theme.normal()).put(".lrp", theme.dim());
                let cursor = input.visual_cursor().saturating_sub(scroll) as u16;
                let y = area.bottom().saturating_sub(1);
                return Some(Position::new(start.saturating_add(cursor).min(area.right().saturating_sub(1)), y));
            }
            (None, Some(message)) => _ = pen.put(message, theme.bold()),
            (None, None) => {
                let keys = [
                    ("Enter", "open"),
                    (&format!("{} {}", glyphs::UP, glyphs::DOWN), "choose"),
                    ("t", "tour"),
                    ("n", "new behaviour"),
                    ("q", "quit"),
                ];
                for (key, label) in keys {
                    if pen.room() >= format::width(key) + 1 + format::width(label) {
                        pen.put(key, theme.key()).put(" ", theme.dim()).put(label, theme.dim()).put("  ", theme.dim());
                    }
                }
            }
        }
        None
    }

    fn count(&self) -> String {
        let Some(found) = &self.found else { return String::new() };
        let more = found.all.len().saturating_sub(self.page());
        match (found.all.len(), found.cut, more) {
            (0, _, _) => String::new(),
            (n, true, _) => format!("the first {n}"),
            (n, false, 1..) => format!("{n}: PgDn"),
            (n, false, 0) => n.to_string(),
        }
    }

    fn emptiness(&self) -> String {
        match &self.found {
            None => "looking ...".into(),
            Some(found) => match &found.trouble {
                Some(why) => format!("this folder {why}"),
                None => "none yet: take the tour, or make one".into(),
            },
        }
    }
}

/// Names may hold anything.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}
