//! The program's text: the active states marked, what is wrong in place, colours as the parser reads it.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthChar;

use super::breakpoints::mark;
use super::log::sign;
use super::{Target, Title, draw_nothing};
use crate::model::{Program, State};
use crate::runtime::record::Setter;
use crate::syntax::Source;
use crate::syntax::keyword::Keyword;
use crate::ui::app::{App, TextLine};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::graph::EdgeKind;
use crate::ui::ink::{Ink, Inked};
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::text::Text;
use crate::ui::view::{Path, Problem};

/// Columns of a tab stop.
const TAB: usize = 4;
/// Columns at the end of a line from which on a message stands there and not below it.
const SENTENCE: u16 = 24;
/// Columns beside a line's number.
const MARGIN: u16 = 4;

/// A row of the pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    Line(usize),
    /// What is wrong with the line above, where there is no room beside it.
    Message(usize),
}

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let Some(page) = Page::of(app, area.width) else {
        draw_nothing(app, area, buffer, "No program yet: here is its text, with what is active in it.");
        return Title::new(Pane::Source.title(), "");
    };
    let rows = page.rows(usize::from(area.height));
    for (y, row) in (0..area.height).zip(&rows) {
        let pen = Pen::new(buffer, area, y);
        match *row {
            Shown::Line(line) => page.draw_line(line, pen),
            Shown::Message(line) => page.draw_message(line, pen),
        }
    }
    let refused = if page.text.is_refused() { "  not taken over" } else { "" };
    let title = format!("{}  {}{refused}", Pane::Source.title(), format::file_name(&page.source.name));
    Title::new(title, page.note(&rows))
}

/// The line and the byte at a cell; for a message those of the line that it is about.
pub fn at(app: &App, area: Rect, cell: Position) -> Option<Target> {
    let page = Page::of(app, area.width)?;
    let row = page.rows(usize::from(area.height)).into_iter().nth(usize::from(cell.y - area.y))?;
    let (Shown::Line(line) | Shown::Message(line)) = row;
    let column = (cell.x - area.x).saturating_sub(page.digits + MARGIN) + app.source_left();
    Some(Target::Text(TextLine { line, ..page.spot }, page.offset(line, usize::from(column))))
}

struct Page<'a> {
    app: &'a App,
    spot: TextLine,
    text: Text<'a>,
    source: &'a Source,
    /// Lines with what is wrong there, the worst first.
    problems: Vec<(usize, &'a Problem)>,
    active: Vec<Active>,
    /// Columns of a line's number.
    digits: u16,
    /// Columns for the text.
    room: u16,
}

/// The lines of an active state; the innermost last.
struct Active {
    name: Path,
    lines: Range<usize>,
    has_active_inside: bool,
}

impl<'a> Page<'a> {
    fn of(app: &'a App, width: u16) -> Option<Page<'a>> {
        let (spot, text) = app.text()?;
        let source = text.source;
        let own = app.view().problems.iter().filter(|problem| problem.key.file == source.name);
        let line = |problem: &Problem| match (problem.is_of_rejected_text(), text.is_refused()) {
            (true, true) => Some(problem.key.line),
            (true, false) => None,
            (false, _) => text.line_here(problem.key.line),
        };
        let mut problems: Vec<(usize, &Problem)> = own.filter_map(|problem| Some((line(problem)?, problem))).collect();
        problems.sort_by_key(|(line, problem)| (*line, std::cmp::Reverse(problem.gravity)));
        let digits = source.line_count().to_string().len() as u16;
        let room = width.saturating_sub(digits + MARGIN);
        let active = app.program().map_or_else(Vec::new, |program| active(app, program, &text));
        Some(Page { app, spot, text, source, problems, active, digits, room })
    }

    /// From the first line seen on; where messages stand between lines, so that a person's line is seen all the same.
    fn rows(&self, height: usize) -> Vec<Shown> {
        let top = self.app.source_top();
        let is_seen = (top..top + height).contains(&self.spot.line);
        let from = |top: usize| -> Vec<Shown> {
            let lines = (top..=self.source.line_count()).flat_map(|line| {
                let message = self.stands_below(line).then_some(Shown::Message(line));
                [Shown::Line(line)].into_iter().chain(message)
            });
            lines.take(height).collect()
        };
        let mut tops = (top..=self.spot.line.max(top)).map(from);
        let first = tops.next().unwrap_or_default();
        let wanted = |rows: &Vec<Shown>| !is_seen || rows.contains(&Shown::Line(self.spot.line));
        if wanted(&first) { first } else { tops.find(wanted).unwrap_or(first) }
    }

    fn problem(&self, line: usize) -> Option<&'a Problem> {
        self.problems.iter().find(|(at, _)| *at == line).map(|(_, problem)| *problem)
    }

    fn stands_below(&self, line: usize) -> bool {
        self.problem(line).is_some_and(|problem| {
            let beside = self.room.saturating_sub(self.width(line) + 2);
            beside < SENTENCE.min(format::width(&message(problem)))
        })
    }

    /// Columns of a line that are seen.
    fn width(&self, line: usize) -> u16 {
        let text = &self.source.text[self.source.line_range(line)];
        let columns = text.trim_end().chars().fold(0, |at, c| at + columns(c, at));
        columns.saturating_sub(usize::from(self.app.source_left())).min(usize::from(u16::MAX)) as u16
    }

    /// The byte that stands in a column of a line; at its beginning and end the nearest that is written.
    fn offset(&self, line: usize, column: usize) -> usize {
        let range = self.source.line_range(line);
        let text = &self.source.text[range.clone()];
        let written = text.trim();
        let first = text.find(written).unwrap_or(0);
        let mut at = 0;
        let there = text.char_indices().find(|&(_, c)| {
            at += columns(c, at);
            at > column
        });
        let last = written.char_indices().last().map_or(first, |(last, _)| first + last);
        range.start + there.map_or(last, |(offset, _)| offset).clamp(first, last)
    }

    fn draw_line(&self, line: usize, mut pen: Pen) {
        let theme = self.app.theme();
        let selected = line == self.spot.line;
        pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
        self.draw_sign(line, &mut pen);
        let active = self.active.iter().rev().find(|active| active.lines.contains(&line));
        let (glyph, style) = match active {
            Some(active) if active.lines.start == line => (glyphs::ACTIVE, theme.active()),
            Some(active) if !active.has_active_inside => (glyphs::UPRIGHT, theme.active()),
            _ => (" ", theme.dim()),
        };
        let number = if glyph == glyphs::ACTIVE { theme.active() } else { theme.dim() };
        pen.column_right(&line.to_string(), self.digits, number).put(glyph, style).put(" ", theme.normal());
        for (text, style) in self.stretches(line) {
            pen.put(&text, style);
        }
        if let Some(problem) = self.problem(line).filter(|_| !self.stands_below(line)) {
            pen.put("  ", theme.normal()).put(&message(problem), theme.gravity(problem.gravity));
        }
        if selected && self.app.focus() == Pane::Source {
            pen.wash(theme.selected());
        }
    }

    fn draw_message(&self, line: usize, mut pen: Pen) {
        let theme = self.app.theme();
        let Some(problem) = self.problem(line) else { return };
        let style = theme.gravity(problem.gravity);
        pen.column("", self.digits + MARGIN, theme.normal())
            .put(glyphs::BOTTOM_LEFT, style)
            .put(" ", style)
            .put(&message(problem), style);
    }

    /// What is wrong with the line, else where the program will pause.
    fn draw_sign(&self, line: usize, pen: &mut Pen) {
        let theme = self.app.theme();
        match (self.problem(line), self.breakpoint(line)) {
            (Some(problem), _) => pen.put(sign(problem.gravity), theme.gravity(problem.gravity)),
            (None, Some(by)) => pen.put(mark(by), theme.breakpoint()),
            (None, None) => pen.put(" ", theme.normal()),
        };
    }

    fn breakpoint(&self, line: usize) -> Option<Setter> {
        let view = self.app.view();
        let program = self.app.program().filter(|_| !view.breakpoints.is_empty())?;
        let bytes = self.text.running(line)?;
        let begins = |span: crate::syntax::Span| {
            span.file == self.spot.file && (bytes.start..=bytes.end).contains(&(span.start as usize))
        };
        let states = program.states.iter().filter(|state| begins(state.name_span));
        let at_state = states.filter_map(|state| view.breaks_at_state(&state.path)).next();
        let transitions = program.machines.iter().flat_map(|machine| &machine.transitions);
        let transitions = transitions.filter(|&&id| begins(program[id].span));
        at_state.or_else(|| transitions.filter_map(|&id| view.breaks_at_transition(id)).next())
    }

    /// A line in pieces of one style each, from the first column that is seen.
    fn stretches(&self, line: usize) -> Vec<(String, Style)> {
        let range = self.source.line_range(line);
        let inked = self.app.inked(self.source);
        let mut hidden = usize::from(self.app.source_left());
        let mut at = 0;
        let mut stretches = Vec::new();
        for (bytes, ink) in gapless(&inked, range) {
            let mut text = String::new();
            for c in self.source.text[bytes].chars() {
                let width = columns(c, at);
                at += width;
                match hidden.checked_sub(width) {
                    Some(rest) if width > 0 && hidden > 0 => hidden = rest,
                    _ if c == '\t' => text.extend(std::iter::repeat_n(' ', width)),
                    _ => text.push(c),
                }
            }
            stretches.push((text, self.style(ink)));
        }
        stretches
    }

    fn style(&self, ink: Option<Ink>) -> Style {
        let theme = self.app.theme();
        match ink {
            None => theme.normal(),
            Some(Ink::Comment) => theme.comment(),
            Some(Ink::Text | Ink::Bracket | Ink::LuaKeyword) => theme.lua(),
            Some(Ink::Form(keyword)) => match kind(keyword) {
                Some(kind) => theme.transition(kind),
                None => theme.bold(),
            },
        }
    }

    /// An active state that is out of sight.
    fn note(&self, rows: &[Shown]) -> String {
        let mut lines = rows.iter().filter_map(|row| match row {
            Shown::Line(line) => Some(*line),
            Shown::Message(_) => None,
        });
        let (first, last) = (lines.clone().next().unwrap_or(1), lines.next_back().unwrap_or(1));
        let Some(innermost) = self.active.last() else { return String::new() };
        let name = &innermost.name;
        match innermost.lines.start {
            line if line < first => format!("{} {name} {}", glyphs::ACTIVE, glyphs::UP),
            line if line > last => format!("{} {name} {}", glyphs::ACTIVE, glyphs::DOWN),
            _ => String::new(),
        }
    }
}

/// The active states of a file, outer ones before those nested in them, as far as their lines stand here.
fn active(app: &App, program: &Program, text: &Text) -> Vec<Active> {
    let view = app.view();
    let running = view.machines.keys().filter_map(|machine| program.state(view.active(machine)?));
    let states = running.map(|id| &program[id]).filter(|state| state.span.file == text.file);
    let mut active: Vec<Active> = states.filter_map(|state| active_lines(app, program, text, state)).collect();
    active.sort_by_key(|active| active.lines.start);
    active
}

fn active_lines(app: &App, program: &Program, text: &Text, state: &State) -> Option<Active> {
    let own = program.sources.get(usize::from(text.file.0))?;
    let first = text.line_here(own.line(state.name_span.start as usize))?;
    let last = text.line_here(own.line(state.span.end.saturating_sub(1) as usize)).unwrap_or(first).max(first);
    let inside = state.machines.iter().any(|&inner| app.view().active(&program[inner].path).is_some());
    Some(Active { name: state.name.clone(), lines: first..last + 1, has_active_inside: inside })
}

/// The range in stretches of one ink, plain ones between.
fn gapless(inked: &Inked, range: Range<usize>) -> Vec<(Range<usize>, Option<Ink>)> {
    let mut at = range.start;
    let mut all = Vec::new();
    for (stretch, ink) in inked.within(range.clone()) {
        all.push((at..stretch.start, None));
        at = stretch.end;
        all.push((stretch, Some(ink)));
    }
    all.push((at..range.end, None));
    all.retain(|(stretch, _)| !stretch.is_empty());
    all
}

/// How wide a character is in this column.
fn columns(c: char, at: usize) -> usize {
    if c == '\t' { TAB - at % TAB } else { c.width().unwrap_or(1) }
}

/// A transition's word has the colour of its lines in the drawing.
fn kind(keyword: Keyword) -> Option<EdgeKind> {
    match keyword {
        Keyword::On => Some(EdgeKind::On),
        Keyword::Eps => Some(EdgeKind::Eps),
        Keyword::Ontime => Some(EdgeKind::Ontime),
        Keyword::Exit => Some(EdgeKind::Exit),
        _ => None,
    }
}

fn message(problem: &Problem) -> String {
    let count = if problem.count > 1 { format!("  {}{}", glyphs::TIMES, problem.count) } else { String::new() };
    format!("{}{count}", problem.message)
}
