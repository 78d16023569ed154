//! What can be done or gone to, over the lower panes: names, what they do or why they can't now, their keys.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::sheet;
use crate::ui::app::{App, Offer, Palette, top_for};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::pen::Pen;
use crate::ui::view::{name, owner};

/// Columns from which on each row has its sentence; otherwise that of the selected one stands below all.
const WIDE: u16 = 60;
const NAME: u16 = 20;
const KEYS: u16 = 10;
/// Rows of that sentence.
const FOOT: u16 = 2;

pub fn draw(app: &App, palette: &Palette, body: Rect, buffer: &mut Buffer) {
    let (area, list) = areas(body);
    for y in 0..area.height {
        Pen::new(buffer, area, y).fill(" ", Style::reset());
    }
    let top = top(palette, list);
    let inside = sheet::title(app, "do, or go to", (top, palette.offers.len()), list, buffer);
    meet_rules(app, list, buffer);
    for (y, (index, offer)) in (0..inside.height).zip(palette.offers.iter().enumerate().skip(top)) {
        let mut pen = Pen::new(buffer, inside, y);
        draw_offer(app, &Words::of(app, offer), index == palette.at, &mut pen);
    }
    if let Some(offer) = palette.offers.get(palette.at).filter(|_| list.height < area.height) {
        let words = Words::of(app, offer);
        let lines = format::wrap(&words.sentence, area.width.saturating_sub(2));
        for (y, line) in (list.height..area.height).zip(lines) {
            Pen::new(buffer, area, y).put(" ", Style::new()).put(&line, app.theme().dim());
        }
    }
}

/// What is covered, and the part of it that has the title and the list.
fn areas(body: Rect) -> (Rect, Rect) {
    let height = (body.height * 3 / 5).max(9).min(body.height);
    let foot = if body.width < WIDE && height > 4 { FOOT } else { 0 };
    let area = Rect { y: body.bottom() - height, height, ..body };
    (area, Rect { height: height - foot, ..area })
}

fn top(palette: &Palette, list: Rect) -> usize {
    top_for(0, Some(palette.at), palette.offers.len(), usize::from(list.height.saturating_sub(1)))
}

/// The offer at a cell.
pub fn row_at(palette: &Palette, body: Rect, at: Position) -> Option<usize> {
    let (_, list) = areas(body);
    let row = top(palette, list) + usize::from(at.y.checked_sub(list.y + 1)?);
    (list.contains(at) && row < palette.offers.len()).then_some(row)
}

/// Upright rules end at the title.
fn meet_rules(app: &App, area: Rect, buffer: &mut Buffer) {
    let Some(layout) = app.layout(buffer.area) else { return };
    for rule in layout.rules().filter(|rule| rule.top() < area.y && rule.bottom() >= area.y) {
        let title = buffer.cell_mut((rule.x, area.y)).filter(|cell| cell.symbol() == glyphs::RULE);
        title.into_iter().for_each(|cell| _ = cell.set_symbol(glyphs::MEETS_ABOVE));
    }
}

struct Words {
    name: String,
    /// What it does, where it is, or why it can't be done now.
    sentence: String,
    keys: String,
    is_hindered: bool,
}

impl Words {
    fn of(app: &App, offer: &Offer) -> Words {
        match offer {
            Offer::Action(entry) => {
                let hindrance = app.hindrance(entry.action);
                let is_hindered = hindrance.is_some();
                let sentence = hindrance.unwrap_or_else(|| entry.help.into());
                Words { name: entry.id.into(), sentence, keys: app.keys().names(entry), is_hindered }
            }
            Offer::Place(path) => {
                let kind = if app.program().is_some_and(|program| program.state(path).is_some()) {
                    "state"
                } else {
                    "machine"
                };
                Words::of_path(path, kind)
            }
            Offer::Variable(path) => Words::of_path(path, "variable"),
        }
    }

    fn of_path(path: &str, kind: &str) -> Words {
        let place = owner(path).map_or("at top level".into(), |outer| format!("in {outer}"));
        let sentence = format!("select the {kind} {place}");
        Words { name: name(path).into(), sentence, keys: String::new(), is_hindered: false }
    }
}

fn draw_offer(app: &App, words: &Words, selected: bool, pen: &mut Pen) {
    let theme = app.theme();
    let (name, keys) = if words.is_hindered { (theme.dim(), theme.dim()) } else { (theme.bold(), theme.key()) };
    pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
    if pen.room() >= WIDE - 1 {
        pen.put_right(" ", theme.normal());
        pen.right_column(&words.keys, KEYS, keys).put_right(" ", theme.normal());
        pen.column(&words.name, NAME.max(format::width(&words.name)), name).put(" ", theme.normal());
        pen.put(&words.sentence, theme.dim());
    } else {
        pen.put_right(" ", theme.normal()).put_right(&words.keys, keys).put_right(" ", theme.normal());
        pen.put(&words.name, name);
    }
    if selected {
        pen.wash(theme.selected());
    }
}
