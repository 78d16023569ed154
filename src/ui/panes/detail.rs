//! All about what is selected: a state with its actions and why it is not left, a variable with its history, a problem with its line.

mod element;
mod happening;
mod value;
mod ways;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::{Title, draw_nothing};
use crate::model::{BlockId, Program, TransitionId};
use crate::syntax::Span;
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::view::Gravity;

/// Words at the left, words at the right, and what they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub text: String,
    pub place: String,
    /// What it is about, where a breakpoint may be set at it.
    pub transition: Option<TransitionId>,
    pub tone: Tone,
    /// What stands before the words of a transition.
    pub lead: Lead,
}

/// A breakpoint's mark, then words in a column of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct Lead {
    pub mark: &'static str,
    pub text: String,
    pub tone: Tone,
}

impl Default for Lead {
    fn default() -> Lead {
        Lead { mark: " ", text: String::new(), tone: Tone::Aside }
    }
}

/// Columns where it is written for others to read.
const AMPLE: u16 = 160;
/// Columns of a transition's answer: `1:02:04`.
const LEAD: u16 = 7;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    Heading,
    Text,
    Aside,
    Code,
    Gravity(Gravity),
    Caret(Gravity),
    /// It is about to happen.
    Holds,
}

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let lines = lines(app, area.width);
    if lines.is_empty() {
        draw_nothing(app, area, buffer, "Select a state, a variable or a line of the log: here is all about it.");
    }
    let top = top(app, lines.len(), area);
    for (y, (index, line)) in (0..area.height).zip(lines.iter().enumerate().skip(top)) {
        draw_line(app, line, index == app.detail_at() && app.focus() == Pane::Detail, Pen::new(buffer, area, y));
    }
    let below = lines.len().saturating_sub(top + usize::from(area.height));
    let note = if below > 0 { format!("{below} more") } else { String::new() };
    Title::new(Pane::Detail.title(), note)
}

fn top(app: &App, lines: usize, area: Rect) -> usize {
    app.detail_top().min(lines.saturating_sub(usize::from(area.height)))
}

/// The line in a row.
pub fn at(app: &App, area: Rect, row: usize) -> Option<usize> {
    let lines = lines(app, area.width).len();
    Some(top(app, lines, area) + row).filter(|&line| line < lines)
}

fn draw_line(app: &App, line: &Line, selected: bool, mut pen: Pen) {
    let (theme, style) = (app.theme(), style(app, line.tone));
    pen.put_right(" ", style).put_right(&line.place, theme.dim());
    pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
    let Lead { mark, text, tone } = &line.lead;
    match line.tone {
        _ if line.transition.is_some() => {
            pen.put(mark, theme.breakpoint()).column(text, LEAD, self::style(app, *tone));
        }
        Tone::Heading | Tone::Gravity(_) => (),
        _ => _ = pen.put("  ", Style::new()),
    }
    pen.put(&line.text, style);
    if selected {
        pen.wash(theme.selected());
    }
}

pub fn style(app: &App, tone: Tone) -> Style {
    let theme = app.theme();
    match tone {
        Tone::Heading => theme.bold(),
        Tone::Text | Tone::Code => theme.normal(),
        Tone::Aside => theme.dim(),
        Tone::Holds => theme.active(),
        Tone::Gravity(gravity) | Tone::Caret(gravity) => theme.gravity(gravity),
    }
}

/// For a pane of this many columns.
pub fn lines(app: &App, width: u16) -> Vec<Line> {
    let mut page = Page { app, width: width.saturating_sub(4), lines: Vec::new() };
    match app.subject() {
        Pane::Variables => page.variable(),
        Pane::Log => page.log_row(),
        _ => page.element(),
    }
    page.lines
}

/// All of it as plain text.
pub fn text(app: &App) -> String {
    let line = |Line { text, place, lead, .. }: Line| {
        let words = [lead.text, text, place].into_iter().filter(|words| !words.is_empty());
        words.collect::<Vec<_>>().join("  ")
    };
    lines(app, AMPLE).into_iter().map(line).collect::<Vec<_>>().join("\n")
}

struct Page<'a> {
    app: &'a App,
    /// Columns of a line below a heading.
    width: u16,
    lines: Vec<Line>,
}

impl Page<'_> {
    fn add(&mut self, tone: Tone, text: impl Into<String>) {
        self.add_at(tone, text, String::new());
    }

    fn add_at(&mut self, tone: Tone, text: impl Into<String>, place: String) {
        self.lines.push(Line { text: text.into(), place, transition: None, tone, lead: Lead::default() });
    }

    /// In as many lines as it needs.
    fn add_wrapped(&mut self, tone: Tone, text: &str) {
        format::wrap(text, self.width).into_iter().for_each(|line| self.add(tone, line));
    }

    fn code(&mut self, program: &Program, block: BlockId) {
        for line in dedented(&program[block].code) {
            self.add(Tone::Code, line);
        }
    }
}

/// `:24`, and with the file where that isn't the program's own.
fn place(program: &Program, span: Span) -> String {
    let Some(source) = program.sources.get(usize::from(span.file.0)) else { return String::new() };
    let file = if span.file.0 == 0 { "" } else { format::file_name(&source.name) };
    format!("{file}:{}", source.line(span.start as usize))
}

/// The lines of a block without the indentation they share.
fn dedented(code: &str) -> Vec<String> {
    let code = code.trim_end();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let rest = code.lines().skip(1).filter(|line| !line.trim().is_empty());
    let shared = rest.map(indent).min().unwrap_or(0);
    let strip = |(i, line): (usize, &str)| {
        let cut = if i == 0 { indent(line) } else { shared.min(indent(line)) };
        line.get(cut..).unwrap_or(line).trim_end().to_owned()
    };
    code.lines().enumerate().map(strip).filter(|line| !line.is_empty()).collect()
}
