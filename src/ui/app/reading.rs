//! A reader's place in the log: it holds still on the screen while entries come and go.

use super::App;
use super::movement::Move;
use crate::runtime::record::Level;
use crate::ui::layout::Pane;
use crate::ui::panes::log;
use crate::ui::view::{Entry, Gravity, Kind, Path, Problem, ProblemKey, View, name, within};

/// Lines from which on a problem may take two.
const TALL: usize = 4;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// None: the newest are shown as they come.
    pub place: Option<LogRow>,
    /// The pane's row the place is held at.
    pub row: usize,
    pub filter: Filter,
    /// Only what belongs to this machine and what is in it.
    pub only: Option<Path>,
    /// Only what has this in its words.
    pub text: String,
    /// The number of the next entry when the place was taken.
    pub since: u64,
    /// Entries from this number on are not listed yet.
    pub until: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LogRow {
    Problem(ProblemKey),
    Entry(u64),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    #[default]
    Everything,
    Transitions,
    WithoutChanges,
    Warnings,
    Errors,
}

impl Filter {
    pub fn next(self) -> Filter {
        match self {
            Filter::Everything => Filter::Transitions,
            Filter::Transitions => Filter::WithoutChanges,
            Filter::WithoutChanges => Filter::Warnings,
            Filter::Warnings => Filter::Errors,
            Filter::Errors => Filter::Everything,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Filter::Everything => "",
            Filter::Transitions => "transitions",
            Filter::WithoutChanges => "without transitions",
            Filter::Warnings => "warnings only",
            Filter::Errors => "errors only",
        }
    }

    fn shows(self, entry: &Entry) -> bool {
        match self {
            Filter::Everything => true,
            Filter::Transitions => matches!(entry.kind, Kind::Change(_)),
            Filter::WithoutChanges => !matches!(entry.kind, Kind::Change(_)),
            Filter::Warnings => matches!(entry.kind, Kind::Log(Level::Warn | Level::Error)),
            Filter::Errors => matches!(entry.kind, Kind::Log(Level::Error)),
        }
    }

    fn shows_problem(self, gravity: Gravity) -> bool {
        match self {
            Filter::Warnings => gravity > Gravity::Hint,
            Filter::Errors => gravity == Gravity::Error,
            _ => true,
        }
    }
}

impl Reading {
    pub fn shows(&self, entry: &Entry) -> bool {
        entry.number < self.until
            && self.filter.shows(entry)
            && self.only.as_ref().is_none_or(|machine| within(&entry.state, machine))
            && self.finds([&entry.text, &*entry.state])
    }

    /// What belongs to no machine in particular concerns all of them.
    fn shows_problem(&self, problem: &Problem) -> bool {
        let here = |machine: &Path| problem.state.is_empty() || within(&problem.state, machine);
        self.filter.shows_problem(problem.gravity)
            && self.only.as_ref().is_none_or(here)
            && self.finds([&problem.message, &*problem.state])
    }

    fn finds(&self, words: [&str; 2]) -> bool {
        let wanted = self.text.to_lowercase();
        wanted.is_empty() || words.iter().any(|words| words.to_lowercase().contains(&wanted))
    }

    /// What is left out, for the title.
    pub fn label(&self) -> String {
        let label = match (self.filter.label(), &self.only) {
            ("", Some(machine)) => format!("only {}", name(machine)),
            (label, Some(machine)) => format!("{label}, {}", name(machine)),
            (label, None) => label.into(),
        };
        match (self.text.is_empty(), label.is_empty()) {
            (true, _) => label,
            (false, true) => format!("/{}", self.text),
            (false, false) => format!("/{}, {label}", self.text),
        }
    }

    /// The problems, then the entries with the newest first.
    pub fn rows(&self, view: &View) -> Vec<LogRow> {
        let problems = view.problems.iter().filter(|problem| self.shows_problem(problem));
        let entries = view.journal.newest_first().filter(|entry| self.shows(entry));
        let problems = problems.map(|problem| LogRow::Problem(problem.key.clone()));
        problems.chain(entries.map(|entry| LogRow::Entry(entry.number))).collect()
    }

    /// The rows a pane of `height` shows: problems stay at the top, in half of it at most. Where there is room among
    /// them, one that is `long` has a second line.
    pub fn window(&self, view: &View, height: usize, long: impl Fn(&ProblemKey) -> bool) -> Vec<Shown> {
        let rows = self.rows(view);
        let problems = rows.iter().filter(|row| matches!(row, LogRow::Problem(_))).count();
        let at = self.place.as_ref().and_then(|place| rows.iter().position(|row| row == place));
        let pinned = problems.min(height.div_ceil(2));
        let first_problem = match at {
            Some(at) if at < problems => (at + 1).saturating_sub(pinned),
            _ => 0,
        };
        let mut spare = if height < TALL { 0 } else { height.div_ceil(2).max(2) - pinned };
        let mut shown: Vec<Shown> = Vec::new();
        for row in &rows[first_problem..first_problem + pinned] {
            let second = spare > 0 && matches!(row, LogRow::Problem(key) if long(key));
            spare -= usize::from(second);
            shown.push(Shown { row: row.clone(), lines: 1 + u16::from(second) });
        }
        let pinned: usize = shown.iter().map(|shown| usize::from(shown.lines)).sum();
        let space = height - pinned;
        let entries = rows.len() - problems;
        let first_entry = match at.and_then(|at| at.checked_sub(problems)) {
            Some(entry) => {
                let row = self.row.saturating_sub(pinned).min(space.saturating_sub(1));
                entry.saturating_sub(row).min(entries.saturating_sub(1))
            }
            None => 0,
        };
        let entries = rows[problems + first_entry..].iter().take(space);
        shown.extend(entries.map(|row| Shown { row: row.clone(), lines: 1 }));
        shown
    }
}

/// A row that is seen, in one or two lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    pub row: LogRow,
    pub lines: u16,
}

impl App {
    pub(super) fn go_in_log(&mut self, how: Move) {
        let rows = self.reading.rows(&self.view);
        let page = self.page(Pane::Log);
        let at = self.reading.place.as_ref().and_then(|place| rows.iter().position(|row| row == place));
        if how == Move::First {
            return self.read_newest();
        }
        let Some(to) = how.from(at, rows.len(), page) else { return };
        let columns = self.columns(Pane::Log);
        let seen = self.reading.window(&self.view, page, |key| log::is_long(self, key, columns));
        let shown = seen.iter().position(|shown| shown.row == rows[to]);
        let shown = shown.map(|at| seen[..at].iter().map(|shown| usize::from(shown.lines)).sum::<usize>());
        let moved = to as isize - at.unwrap_or(0) as isize;
        let row = shown.map_or(self.reading.row as isize + moved, |row| row as isize);
        self.reading.row = row.clamp(0, page.saturating_sub(1) as isize) as usize;
        if self.reading.place.is_none() {
            self.reading.since = self.view.journal.next();
        }
        self.reading.place = Some(rows[to].clone());
        self.detail_anew();
    }

    /// All machines again, or the selected one alone.
    pub(super) fn read_only_machine(&mut self) {
        let selected = self.program().zip(self.machine()).map(|(program, machine)| program[machine].path.clone());
        self.reading.only = if self.reading.only.is_some() { None } else { selected };
    }

    pub(super) fn read_newest(&mut self) {
        self.reading.place = None;
        self.reading.row = 0;
    }
}
