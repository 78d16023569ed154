//! A reader's place in the log: it holds still on the screen while entries come and go.

use super::App;
use super::movement::Move;
use crate::runtime::record::Level;
use crate::ui::layout::Pane;
use crate::ui::view::{Entry, Gravity, Kind, ProblemKey, View};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// None: the newest are shown as they come.
    pub place: Option<LogRow>,
    /// The pane's row the place is held at.
    pub row: usize,
    pub filter: Filter,
    /// The number of the next entry when the place was taken.
    pub since: u64,
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
    WithoutChanges,
    Warnings,
}

impl Filter {
    pub fn next(self) -> Filter {
        match self {
            Filter::Everything => Filter::WithoutChanges,
            Filter::WithoutChanges => Filter::Warnings,
            Filter::Warnings => Filter::Everything,
        }
    }

    /// For the title.
    pub fn label(self) -> &'static str {
        match self {
            Filter::Everything => "",
            Filter::WithoutChanges => "without transitions",
            Filter::Warnings => "warnings only",
        }
    }

    pub fn shows(self, entry: &Entry) -> bool {
        match self {
            Filter::Everything => true,
            Filter::WithoutChanges => entry.kind != Kind::Change,
            Filter::Warnings => matches!(entry.kind, Kind::Log(Level::Warn | Level::Error)),
        }
    }

    pub fn shows_problem(self, gravity: Gravity) -> bool {
        self != Filter::Warnings || gravity > Gravity::Hint
    }
}

impl Reading {
    /// The problems, then the entries with the newest first.
    pub fn rows(&self, view: &View) -> Vec<LogRow> {
        let problems = view.problems.iter().filter(|problem| self.filter.shows_problem(problem.gravity));
        let entries = view.journal.newest_first().filter(|entry| self.filter.shows(entry));
        let problems = problems.map(|problem| LogRow::Problem(problem.key.clone()));
        problems.chain(entries.map(|entry| LogRow::Entry(entry.number))).collect()
    }

    /// The rows a pane of `height` shows: problems stay at the top, in half of it at most.
    pub fn window(&self, view: &View, height: usize) -> Window {
        let rows = self.rows(view);
        let problems = rows.iter().filter(|row| matches!(row, LogRow::Problem(_))).count();
        let at = self.place.as_ref().and_then(|place| rows.iter().position(|row| row == place));
        let pinned = problems.min(height.div_ceil(2));
        let first_problem = match at {
            Some(at) if at < problems => (at + 1).saturating_sub(pinned),
            _ => 0,
        };
        let space = height - pinned;
        let entries = rows.len() - problems;
        let first_entry = match at.and_then(|at| at.checked_sub(problems)) {
            Some(entry) => {
                let row = self.row.saturating_sub(pinned).min(space.saturating_sub(1));
                entry.saturating_sub(row).min(entries.saturating_sub(1))
            }
            None => 0,
        };
        let shown_problems = rows[first_problem..first_problem + pinned].iter();
        let shown_entries = rows[problems + first_entry..].iter().take(space);
        Window { rows: shown_problems.chain(shown_entries).cloned().collect(), hidden_problems: problems - pinned }
    }
}

/// What of the log is seen.
pub struct Window {
    pub rows: Vec<LogRow>,
    pub hidden_problems: usize,
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
        let seen = self.reading.window(&self.view, page).rows;
        let shown = seen.iter().position(|row| *row == rows[to]);
        let moved = to as isize - at.unwrap_or(0) as isize;
        let row = shown.map_or(self.reading.row as isize + moved, |row| row as isize);
        self.reading.row = row.clamp(0, page.saturating_sub(1) as isize) as usize;
        if self.reading.place.is_none() {
            self.reading.since = self.view.journal.next();
        }
        self.reading.place = Some(rows[to].clone());
        self.detail_top = 0;
    }

    pub(super) fn read_newest(&mut self) {
        self.reading.place = None;
        self.reading.row = 0;
    }
}
