//! All keys by what they are for, over the whole screen.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::ui::action::Group;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::pen::Pen;

/// A line of the help.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    Empty,
    Title(&'static str),
    Key { keys: String, help: &'static str },
}

/// For a screen of this many columns: the groups beside each other where they fit.
pub fn lines(width: u16) -> Vec<Vec<Line>> {
    let groups: Vec<Vec<Line>> = Group::ALL.into_iter().map(group).collect();
    if width < 120 {
        return groups.concat().into_iter().map(|line| vec![line]).collect();
    }
    let (left, right) = groups.split_at(3);
    let (left, right) = (left.concat(), right.concat());
    let line = |lines: &[Line], i: usize| lines.get(i).cloned().unwrap_or(Line::Empty);
    (0..left.len().max(right.len())).map(|i| vec![line(&left, i), line(&right, i)]).collect()
}

fn group(group: Group) -> Vec<Line> {
    let keys = group.entries().map(|entry| Line::Key { keys: entry.keys_as_text(), help: entry.help });
    [Line::Title(group.title())].into_iter().chain(keys).chain([Line::Empty]).collect()
}

pub fn draw(app: &App, top: usize, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let rows = lines(area.width);
    let below = rows.len().saturating_sub(top + usize::from(area.height.saturating_sub(1)));
    let mut title = Pen::new(buffer, area, 0);
    let more = if below > 0 { format!(" {below} more: PgDn ") } else { String::new() };
    title.put("─ ", theme.rule()).put("keys", theme.focused_title()).put(" ", theme.rule());
    title.put_right("─", theme.rule()).put_right(&more, theme.dim()).fill("─", theme.rule());
    for (y, row) in (1..area.height).zip(rows.iter().skip(top)) {
        let columns = area.width / row.len().max(1) as u16;
        for (i, line) in row.iter().enumerate() {
            let part = Rect { x: area.x + columns * i as u16, width: columns, ..area };
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
