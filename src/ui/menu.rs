//! What can be done with what is selected, by hand: rows of the table of actions, chosen for each kind of thing.

use ratatui::layout::{Position, Rect};

use super::action::{self, Action, Entry};
use super::format;
use super::layout::Pane;

#[derive(Clone, Debug, PartialEq)]
pub struct Menu {
    pub title: String,
    /// The cell it was asked for.
    pub at: Position,
    pub rows: Vec<&'static Entry>,
    /// The row a person is at.
    pub row: usize,
}

/// What a menu is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    State,
    Machine,
    Transition,
    Variable,
    /// What comes from a robot or goes to it.
    Carried,
    LogLine,
}

impl Topic {
    pub fn actions(self) -> &'static [Action] {
        match self {
            Topic::State => &[
                Action::TransitionTo,
                Action::JumpTo,
                Action::ToggleBreakpoint,
                Action::WhyNot,
                Action::Inspect,
                Action::Focus(Pane::Source),
                Action::OpenEditor,
                Action::Into,
            ],
            Topic::Machine => &[
                Action::Into,
                Action::BreakWhen,
                Action::WhyNot,
                Action::Inspect,
                Action::OnlyMachine,
                Action::Focus(Pane::Source),
                Action::OpenEditor,
            ],
            Topic::Transition => &[Action::ToggleBreakpoint, Action::Focus(Pane::Source), Action::OpenEditor],
            Topic::Variable => &[
                Action::EditValue,
                Action::Reset,
                Action::WriteBack,
                Action::Pin,
                Action::Inspect,
                Action::Focus(Pane::Source),
                Action::OpenEditor,
            ],
            Topic::Carried => &[Action::Pin, Action::Inspect],
            Topic::LogLine => &[
                Action::OpenEditor,
                Action::Focus(Pane::Source),
                Action::ToggleBreakpoint,
                Action::Inspect,
                Action::OnlyMachine,
                Action::Filter,
            ],
        }
    }
}

/// Columns and rows that the frame takes.
const FRAME: u16 = 2;

impl Menu {
    /// `offered`: whether an action does anything now.
    pub fn new(title: String, topic: Topic, at: Position, offered: impl Fn(Action) -> bool) -> Menu {
        let actions = topic.actions().iter().filter(|&&action| offered(action));
        Menu { title, at, rows: actions.filter_map(|&action| action::entry(action)).collect(), row: 0 }
    }

    /// Beside the cell it was asked for, as far as there is room.
    pub fn area(&self, body: Rect) -> Rect {
        let longest = self.rows.iter().map(|entry| format::width(entry.help)).max().unwrap_or(0);
        let width = (longest + KEY + 3).max(format::width(&self.title) + 6) + FRAME;
        let (width, height) = (width.min(body.width), (self.rows.len() as u16 + FRAME).min(body.height));
        let x = (self.at.x + 1).min(body.right() - width).max(body.x);
        let y = (self.at.y + 1).min(body.bottom() - height).max(body.y);
        Rect { x, y, width, height }
    }

    /// The row at a cell.
    pub fn row_at(&self, at: Position, body: Rect) -> Option<usize> {
        let area = self.area(body);
        let row = usize::from(at.y.checked_sub(area.y + 1)?);
        (area.contains(at) && at.y + 1 < area.bottom() && row < self.rows.len()).then_some(row)
    }
}

/// Columns of a key.
pub const KEY: u16 = 6;
