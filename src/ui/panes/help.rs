//! All keys over the whole screen: first those of the pane with the focus, then what works everywhere, then the others.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::sheet;
use crate::ui::action::{Entry, Group, Reach, TABLE};
use crate::ui::app::{App, Help};
use crate::ui::format;
use crate::ui::fuzzy;
use crate::ui::pen::Pen;

/// A line of the help.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    Empty,
    Title(String),
    Key {
        keys: String,
        help: String,
    },
    /// What the line before had no room for.
    More(String),
}

/// Columns from which on there are two columns of lines.
const WIDE: u16 = 120;
/// Columns from which on keys have a column for themselves.
const ROOMY: u16 = 50;

fn key_columns(width: u16) -> u16 {
    if width >= ROOMY { 16 } else { 9 }
}

/// For a screen of this many columns: the groups beside each other where they fit.
pub fn lines(app: &App, help: &Help, width: u16) -> Vec<Vec<Line>> {
    let columns = if width < WIDE { width } else { width / 2 };
    let sections = sections(app, help.search.value());
    let sections: Vec<Vec<Line>> =
        sections.into_iter().map(|(title, entries)| section(app, title, &entries, columns)).collect();
    if width < WIDE {
        return sections.concat().into_iter().map(|line| vec![line]).collect();
    }
    let whole: usize = sections.iter().map(Vec::len).sum();
    let mut before = 0;
    let half = sections.iter().take_while(|section| {
        before += section.len();
        before - section.len() < whole.div_ceil(2)
    });
    let (left, right) = sections.split_at(half.count());
    let (left, right) = (left.concat(), right.concat());
    let line = |lines: &[Line], i: usize| lines.get(i).cloned().unwrap_or(Line::Empty);
    (0..left.len().max(right.len())).map(|i| vec![line(&left, i), line(&right, i)]).collect()
}

/// What is found, in its order.
fn sections(app: &App, search: &str) -> Vec<(String, Vec<&'static Entry>)> {
    let focus = app.focus();
    let found: Vec<&'static Entry> = TABLE.iter().filter(|entry| is_found(app, entry, search)).collect();
    let of_pane = |entry: &Entry| matches!(entry.reach, Reach::Panes(panes) if panes.contains(&focus));
    let select = |wanted: &dyn Fn(&Entry) -> bool| found.iter().copied().filter(|entry| wanted(entry)).collect();
    let mut sections: Vec<(String, Vec<&'static Entry>)> =
        vec![(format!("In the {}, where you are", focus.title()), select(&of_pane))];
    for group in Group::ALL {
        let everywhere = |entry: &Entry| entry.group == group && !matches!(entry.reach, Reach::Panes(_));
        sections.push((group.title().into(), select(&everywhere)));
    }
    let mut places: Vec<String> = Vec::new();
    for entry in TABLE.iter().filter(|entry| matches!(entry.reach, Reach::Panes(_)) && !of_pane(entry)) {
        let place = entry.reach.place();
        if !places.contains(&place) {
            places.push(place);
        }
    }
    for place in places {
        let there = |entry: &Entry| entry.reach.place() == place && !of_pane(entry);
        sections.push((format!("In the {place}"), select(&there)));
    }
    sections.retain(|(_, entries)| !entries.is_empty());
    sections
}

fn is_found(app: &App, entry: &Entry, search: &str) -> bool {
    let search = search.trim();
    fuzzy::begins_words(search, entry.help)
        || fuzzy::begins_words(search, entry.id)
        || app.keys().keys(entry).iter().any(|key| key.to_string() == search)
}

fn section(app: &App, title: String, entries: &[&Entry], width: u16) -> Vec<Line> {
    let mut lines = vec![Line::Title(title)];
    for entry in entries {
        let keys = app.keys().names(entry);
        let keyed = key_columns(width).max(format::width(&keys) + 1);
        let (first, rest) = format::split(entry.help, width.saturating_sub(keyed + 3));
        lines.push(Line::Key { keys, help: first });
        let room = width.saturating_sub(key_columns(width) + 3);
        let rest = format::wrap(&rest, room).into_iter().filter(|line| !line.is_empty());
        lines.extend(rest.map(Line::More));
    }
    lines.push(Line::Empty);
    lines
}

pub fn draw(app: &App, help: &Help, area: Rect, buffer: &mut Buffer) {
    let rows = lines(app, help, area.width);
    let search = help.search.value().trim();
    let title = if search.is_empty() { "keys".into() } else { format!("keys  /{search}") };
    let inside = sheet::title(app, &title, (help.top, rows.len()), area, buffer);
    if rows.is_empty() {
        super::draw_nothing(app, inside, buffer, "No action has this in its name, its keys or what it does.");
    }
    for (y, row) in (0..inside.height).zip(rows.iter().skip(help.top)) {
        let columns = area.width / row.len().max(1) as u16;
        for (i, line) in row.iter().enumerate() {
            let part = Rect { x: area.x + columns * i as u16, width: columns, ..inside };
            draw_line(app, line, key_columns(columns), Pen::new(buffer, part, y));
        }
    }
}

fn draw_line(app: &App, line: &Line, columns: u16, mut pen: Pen) {
    let theme = app.theme();
    pen.put(" ", theme.normal());
    match line {
        Line::Empty => (),
        Line::Title(title) => _ = pen.put(title, theme.dim()),
        Line::Key { keys, help } => {
            let columns = columns.max(format::width(keys) + 1);
            pen.put(" ", theme.normal()).column(keys, columns, theme.key()).put(help, theme.normal());
        }
        Line::More(rest) => _ = pen.column("", columns + 1, theme.normal()).put(rest, theme.normal()),
    }
}
