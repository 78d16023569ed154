//! What each pane shows, row by row. A pane reads the app and writes cells; it changes nothing.

pub mod breakpoints;
pub mod bridge;
pub mod detail;
pub mod diagram;
pub mod footer;
pub mod graph;
pub mod held;
pub mod help;
pub mod log;
pub mod machines;
pub mod menu;
pub mod news;
pub mod palette;
pub mod sheet;
pub mod source;
pub mod status;
pub mod strip;
pub mod variables;
pub mod world;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::app::{App, LogRow, TextLine};
use super::glyphs;
use super::layout::Pane;
use super::pen::Pen;
use super::view::Path;
use super::words::{Tone, Word};
use crate::model::TransitionId;

/// The words in a pane's first row, and what is noted at their right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Title {
    pub text: String,
    pub note: String,
}

impl Title {
    pub fn new(text: impl Into<String>, note: impl Into<String>) -> Title {
        Title { text: text.into(), note: note.into() }
    }
}

/// A pane with its title.
pub fn draw(app: &App, pane: Pane, area: Rect, buffer: &mut Buffer) {
    let inside = below_title(area);
    let title = match pane {
        Pane::Machines => machines::draw(app, inside, buffer),
        Pane::Graph => graph::draw(app, inside, buffer),
        Pane::Variables => variables::draw(app, inside, buffer),
        Pane::Log => log::draw(app, inside, buffer),
        Pane::World => world::draw(app, inside, buffer),
        Pane::Detail => detail::draw(app, inside, buffer),
        Pane::Source => source::draw(app, inside, buffer),
        Pane::Bridge => bridge::draw(app, inside, buffer),
    };
    draw_title(app, pane, &title, Pen::new(buffer, area, 0));
}

/// What a person takes hold of at a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A machine or a state.
    Element(Path),
    Transition(TransitionId),
    /// A variable, a part of one, or what comes from a robot.
    Value(Path),
    Log(LogRow),
    /// A row of the robots.
    Robot(String),
    /// A line of the detail.
    Detail(usize),
    /// A line of a text, and the byte of it.
    Text(TextLine, usize),
}

/// What a pane shows at a cell of the screen; nothing in its title.
pub fn at(app: &App, pane: Pane, area: Rect, cell: Position) -> Option<Target> {
    let inside = below_title(area);
    if !inside.contains(cell) {
        return None;
    }
    let row = usize::from(cell.y - inside.y);
    match pane {
        Pane::Machines => machines::at(app, row).map(Target::Element),
        Pane::Graph => graph::target(app, area, cell),
        Pane::Variables => variables::at(app, inside, row).map(Target::Value),
        Pane::Log => log::at(app, inside, row).map(Target::Log),
        Pane::Detail => detail::at(app, inside, row).map(Target::Detail),
        Pane::Source => source::at(app, inside, cell),
        Pane::Bridge => app.robot_rows().get(app.robots_top() + row)?.key().map(Target::Robot),
        Pane::World => None,
    }
}

/// A pane's area without its first row.
fn below_title(area: Rect) -> Rect {
    Rect { y: area.y + 1.min(area.height), height: area.height.saturating_sub(1), ..area }
}

fn draw_title(app: &App, pane: Pane, title: &Title, mut pen: Pen) {
    let theme = app.theme();
    let style = if app.focus() == pane { theme.focused_title() } else { theme.title() };
    pen.put(glyphs::RULE, theme.rule()).put(" ", theme.rule()).put_right(glyphs::RULE, theme.rule());
    if !title.note.is_empty() && pen.room() > 24 {
        pen.put_right(" ", style).put_right(&title.note, style).put_right(" ", style);
    }
    pen.put(&title.text, style).put(" ", style).fill(glyphs::RULE, theme.rule());
}

/// Words of a line, keys and code told apart.
fn draw_words(app: &App, words: &[Word], pen: &mut Pen) {
    let theme = app.theme();
    let style = |tone| match tone {
        Tone::Text => theme.normal(),
        Tone::Key => theme.key(),
        Tone::Code => theme.fresh(),
    };
    for (i, word) in words.iter().enumerate() {
        pen.put(if i > 0 { " " } else { "" }, theme.normal());
        for (tone, text) in word {
            pen.put(text, style(*tone));
        }
    }
}

/// A sentence where there is nothing else to show.
fn draw_nothing(app: &App, area: Rect, buffer: &mut Buffer, sentence: &str) {
    let lines = super::format::wrap(sentence, area.width.saturating_sub(2));
    for (y, line) in (0..area.height).zip(lines) {
        Pen::new(buffer, area, y).put(" ", app.theme().dim()).put(&line, app.theme().dim());
    }
}
