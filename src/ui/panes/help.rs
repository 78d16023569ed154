//! All keys by what they are for, over the whole screen.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::sheet;
use crate::ui::action::Group;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::keymap::Keymap;
use crate::ui::pen::Pen;

/// A line of the help.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    Empty,
    Title(&'static str),
    Key { keys: String, help: &'static str },
}

/// For a screen of this many columns: the groups beside each other where they fit.
pub fn lines(keys: &Keymap, width: u16) -> Vec<Vec<Line>> {
    let groups: Vec<Vec<Line>> = Group::ALL.into_iter().map(|group| of_group(keys, group)).collect();
    if width < 120 {
        return groups.concat().into_iter().map(|line| vec![line]).collect();
    }
    let (left, right) = groups.split_at(5);
    let (left, right) = (left.concat(), right.concat());
    let line = |lines: &[Line], i: usize| lines.get(i).cloned().unwrap_or(Line::Empty);
    (0..left.len().max(right.len())).map(|i| vec![line(&left, i), line(&right, i)]).collect()
}

fn of_group(keys: &Keymap, group: Group) -> Vec<Line> {
    let keys = group.entries().map(|entry| Line::Key { keys: keys.names(entry), help: entry.help });
    [Line::Title(group.title())].into_iter().chain(keys).chain([Line::Empty]).collect()
}

pub fn draw(app: &App, top: usize, area: Rect, buffer: &mut Buffer) {
    let rows = lines(app.keys(), area.width);
    let inside = sheet::title(app, "keys", (top, rows.len()), area, buffer);
    for (y, row) in (0..inside.height).zip(rows.iter().skip(top)) {
        let columns = area.width / row.len().max(1) as u16;
        for (i, line) in row.iter().enumerate() {
            let part = Rect { x: area.x + columns * i as u16, width: columns, ..inside };
            draw_line(app, line, Pen::new(buffer, part, y));
        }
    }
}

fn draw_line(app: &App, line: &Line, mut pen: Pen) {
    let theme = app.theme();
    pen.put(" ", theme.normal());
    match line {
        Line::Empty => (),
        Line::Title(title) => {
            pen.put(title, theme.dim());
        }
        Line::Key { keys, help } => {
            let columns = if pen.room() >= 50 { 16 } else { format::width(keys).max(8) + 1 };
            pen.put(" ", theme.normal()).column(keys, columns, theme.key()).put(help, theme.normal());
        }
    }
}
