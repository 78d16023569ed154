//! The tour's strip above the screen: one task at a time. As high for each of them, so that nothing below moves.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::draw_words;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::layout::SMALLEST;
use crate::ui::pen::Pen;
use crate::ui::tour::{Shown, Tour};
use crate::ui::words::{Word, lines};

/// From so many rows on the task has a title.
const TALL: u16 = 16;

/// Before the text, where there is no title: ` 12 `.
const NUMBER: u16 = 5;

/// The strip's rows and those of the screen below it.
pub fn divide(app: &App, area: Rect) -> (Rect, Rect) {
    let Some(tour) = app.tour().filter(|tour| tour.shown == Shown::Strip) else {
        return (Rect { height: 0, ..area }, area);
    };
    let columns = columns(area);
    let wanted = if area.height >= TALL {
        1 + tour.rows(app.keys(), columns, 0)
    } else {
        tour.rows(app.keys(), columns, NUMBER - 1)
    };
    let height = wanted.min(area.height.saturating_sub(SMALLEST.1));
    (Rect { height, ..area }, Rect { y: area.y + height, height: area.height - height, ..area })
}

/// `whole`: the area that was divided.
pub fn draw(app: &App, tour: &Tour, (area, whole): (Rect, Rect), buffer: &mut Buffer) {
    if whole.height >= TALL {
        draw_title(app, tour, Pen::new(buffer, area, 0));
        let below = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
        draw_text(
            app,
            &lines(&tour.text(app.view(), app.keys()), columns(area), 0),
            Rect { x: area.x + 1, ..below },
            buffer,
        );
    } else {
        draw_compact(app, tour, area, buffer);
    }
}

fn columns(area: Rect) -> u16 {
    area.width.saturating_sub(2)
}

fn draw_title(app: &App, tour: &Tour, mut pen: Pen) {
    let theme = app.theme();
    draw_keys(app, tour, &mut pen);
    pen.put(&format!(" {} ", tour.heading()), theme.selected()).put(" ", theme.normal());
    pen.put(tour.title(), theme.bold());
    if let Some(praise) = tour.praise() {
        pen.put("   ", theme.normal()).put(praise, theme.active());
    }
}

/// Without a title; the praise where there is room for it.
fn draw_compact(app: &App, tour: &Tour, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let number = tour.step().map_or(String::new(), |(number, _)| number.to_string());
    let mut pen = Pen::new(buffer, area, 0);
    pen.column(&format!(" {number:>2} "), NUMBER - 1, theme.selected());
    let text = tour.text(app.view(), app.keys());
    let praise = tour.praise().map_or(0, |praise| format::width(praise) + 1);
    let praised = lines(&text, columns(area), NUMBER - 1 + praise);
    let fits = praised.len() <= usize::from(area.height);
    let (indent, lines) = match tour.praise().filter(|_| fits) {
        Some(words) => {
            pen.put(" ", theme.normal()).put(words, theme.active());
            (NUMBER + praise, praised)
        }
        None => (NUMBER, lines(&text, columns(area), NUMBER - 1)),
    };
    let mut last = Pen::new(buffer, area, area.height.saturating_sub(1));
    if lines.len() < usize::from(area.height) {
        draw_keys(app, tour, &mut last);
    }
    let first =
        Rect { x: area.x + indent, width: area.width.saturating_sub(indent), height: area.height.min(1), ..area };
    draw_text(app, &lines[..1], first, buffer);
    let below = Rect { x: area.x + 1, y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    draw_text(app, &lines[1..], below, buffer);
}

fn draw_text(app: &App, lines: &[Vec<Word>], area: Rect, buffer: &mut Buffer) {
    for (y, line) in (0..area.height).zip(lines) {
        draw_words(app, line, &mut Pen::new(buffer, area, y));
    }
}

fn draw_keys(app: &App, tour: &Tour, pen: &mut Pen) {
    let theme = app.theme();
    let next = if tour.step().is_some() { "skip" } else { "again" };
    for (action, label) in [("tour-strip", "hide"), ("tour-next", next)] {
        let key = app.keys().named(action);
        if pen.room() > 40 + format::width(&key) {
            pen.put_right(" ", theme.dim()).put_right(label, theme.dim()).put_right(" ", theme.dim());
            pen.put_right(&key, theme.key()).put_right(" ", theme.dim());
        }
    }
}
