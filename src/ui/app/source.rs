//! The program's text as a person reads it: which file, which line, and what is written there.

use std::rc::Rc;

use super::movement::Move;
use super::{App, LogRow};
use crate::model::{MachineId, Program, StateId, TransitionId, VarId};
use crate::runtime::command::BreakAt;
use crate::syntax::{FileId, Source, Span};
use crate::ui::ink::Inked;
use crate::ui::layout::Pane;
use crate::ui::text::Text;
use crate::ui::view::Problem;

/// Columns that the text moves sideways at once.
const SIDEWAYS: u16 = 8;

/// A line of one of the program's texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextLine {
    pub file: FileId,
    /// From 1.
    pub line: usize,
}

/// Where a person went to in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cursor {
    /// What was selected there: the cursor ends as soon as something else is.
    of: Option<TextLine>,
    line: TextLine,
    /// The byte that tells which of several elements on the line is meant.
    offset: usize,
}

/// What is written at a place, the innermost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    Variable(VarId),
    Transition(TransitionId),
    State(StateId),
    Machine(MachineId),
}

impl App {
    /// The line a person is at: where they went to, else that of what is selected.
    pub fn text_line(&self) -> Option<TextLine> {
        let home = self.home();
        let cursor = self.cursor.filter(|cursor| cursor.of == home);
        cursor.map(|cursor| cursor.line).or(home).or_else(|| self.first_line())
    }

    /// The text that is read.
    pub fn text(&self) -> Option<(TextLine, Text<'_>)> {
        let line = self.text_line()?;
        Some((line, Text::of(&self.view, line.file)?))
    }

    /// The first line of it that is seen, as far as nothing stands between the lines.
    pub fn source_top(&self) -> usize {
        self.source_scroll.top() + 1
    }

    /// Columns that are out of sight at the left.
    pub fn source_left(&self) -> u16 {
        self.source_left
    }

    /// Kept from the last frame where nothing changed.
    pub fn inked(&self, source: &Source) -> Rc<Inked> {
        let mut kept = self.inked.borrow_mut();
        match &*kept {
            Some((text, inked)) if std::sync::Arc::ptr_eq(text, &source.text) => inked.clone(),
            _ => {
                let inked = Rc::new(Inked::of(source));
                *kept = Some((source.text.clone(), inked.clone()));
                inked
            }
        }
    }

    /// Where what is selected is written.
    fn home(&self) -> Option<TextLine> {
        let place = match self.subject {
            Pane::Variables => self.place_of_value(),
            Pane::Log => self.place_of_log(),
            _ => None,
        };
        let (file, line, _) = place.or_else(|| self.place_of_element())?;
        let file = FileId(self.program()?.sources.iter().position(|source| source.name == file)? as u16);
        let text = Text::of(&self.view, file)?;
        let here = if self.reads_refused() { Some(line) } else { text.line_here(line) };
        Some(TextLine { file, line: here.unwrap_or(line).clamp(1, text.source.line_count().max(1)) })
    }

    /// Whether what is selected is a problem of a text that wasn't taken over.
    fn reads_refused(&self) -> bool {
        let Some(LogRow::Problem(key)) = &self.reading.place else { return false };
        let problem = self.view.problems.iter().find(|problem| problem.key == *key);
        self.subject == Pane::Log && problem.is_some_and(Problem::is_of_rejected_text)
    }

    /// Where nothing is selected: what keeps the program from running, else its beginning.
    fn first_line(&self) -> Option<TextLine> {
        let file = FileId::default();
        let last = Text::of(&self.view, file)?.source.line_count();
        let broken = self.view.broken().map_or(1, |first| first.line);
        Some(TextLine { file, line: broken.clamp(1, last.max(1)) })
    }

    pub(super) fn go_in_source(&mut self, how: Move) {
        let Some((at, Text { source, .. })) = self.text() else { return };
        let length = source.line_count();
        let to = how.from(Some(at.line - 1), length, self.page(Pane::Source)).unwrap_or(0) + 1;
        let text = source.line_range(to);
        let indent = source.text[text.clone()].find(|c: char| !c.is_whitespace()).unwrap_or(0);
        self.go_to_text(TextLine { line: to, ..at }, text.start + indent);
    }

    /// What is written there becomes selected.
    pub(super) fn go_to_text(&mut self, line: TextLine, offset: usize) {
        let written = self.stands_at(line, offset);
        if let Some((written, program)) = written.zip(self.view.program.clone()) {
            self.select_written(&program, written);
        }
        self.cursor = Some(Cursor { of: self.home(), line, offset });
    }

    fn select_written(&mut self, program: &Program, written: Written) {
        match written {
            Written::Variable(var) => {
                if let Some(machine) = program[var].machine {
                    self.select(program[machine].path.clone());
                }
                self.value = Some(program[var].path.clone());
                self.take_as_subject(Pane::Variables);
            }
            Written::Transition(id) => self.select_text(program[program[id].machine].path.clone()),
            Written::State(state) => self.select_text(program[state].path.clone()),
            Written::Machine(machine) => self.select_text(program[machine].path.clone()),
        }
    }

    /// What of the program that runs is written at a byte of a line.
    fn stands_at(&self, line: TextLine, offset: usize) -> Option<Written> {
        let offset = Text::of(&self.view, line.file)?.running_offset(line.line, offset)?;
        written_at(self.program()?, line.file, offset)
    }

    fn select_text(&mut self, path: super::Path) {
        if self.selected.as_ref() != Some(&path) {
            self.select(path);
        }
        self.take_as_subject(Pane::Machines);
    }

    /// The transition that a person went to in the text.
    pub(super) fn transition_in_text(&self) -> Option<TransitionId> {
        let cursor = self.cursor.filter(|cursor| Some(cursor.line) == self.text_line())?;
        match self.stands_at(cursor.line, cursor.offset)? {
            Written::Transition(id) => Some(id),
            _ => None,
        }
    }

    pub(super) fn break_in_text(&self) -> Result<BreakAt, String> {
        self.transition_in_text().map_or_else(|| self.selected_break(), |id| self.break_on(id))
    }

    pub(super) fn scroll_left(&mut self) {
        self.source_left = self.source_left.saturating_sub(SIDEWAYS);
    }

    pub(super) fn scroll_right(&mut self) {
        let longest = self.text().map_or(0, |(_, Text { source, .. })| {
            let lines = (1..=source.line_count()).map(|line| source.line_range(line).len());
            lines.max().unwrap_or(0).min(usize::from(u16::MAX)) as u16
        });
        self.source_left = self.source_left.saturating_add(SIDEWAYS).min(longest.saturating_sub(SIDEWAYS));
    }

    /// A line from elsewhere comes with what is around it; the next one moves the text as little as can be.
    pub(super) fn settle_source(&mut self, height: usize) {
        let Some((line, Text { source, .. })) = self.text() else { return };
        let (at, length, top) = (line.line - 1, source.line_count(), self.source_scroll.top());
        let near = self.source_scroll.at().is_some_and(|before| before.abs_diff(at) == 1);
        let is_seen = (top..top + height).contains(&at);
        if !is_seen && !near && self.source_scroll.is_new(Some(at), height) {
            self.source_scroll.go_to(at.saturating_sub(height / 3));
        }
        self.source_scroll.settle(Some(at), length, height);
    }
}

/// The innermost element of a file that a byte lies in.
pub fn written_at(program: &Program, file: FileId, offset: usize) -> Option<Written> {
    let lies = |span: Span| span.file == file && span.contains(offset);
    let index = |at: usize| at as u32;
    let var = program.vars.iter().position(|var| lies(var.span)).map(|at| Written::Variable(VarId(index(at))));
    let transition = || {
        let at = program.transitions.iter().position(|transition| lies(transition.span))?;
        Some(Written::Transition(TransitionId(index(at))))
    };
    let element = || {
        let states =
            program.states.iter().enumerate().map(|(at, state)| (state.span, Written::State(StateId(index(at)))));
        let machines = program.machines.iter().enumerate();
        let machines = machines.map(|(at, machine)| (machine.span, Written::Machine(MachineId(index(at)))));
        let around = states.chain(machines).filter(|(span, _)| lies(*span));
        around.min_by_key(|(span, _)| span.end - span.start).map(|(_, written)| written)
    };
    var.or_else(transition).or_else(element)
}
