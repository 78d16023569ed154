//! The menu of what is selected: opened at the mouse or by a key, and gone through by either.

use ratatui::layout::{Position, Rect};

use super::movement::Move;
use super::{App, Effect, LogRow, Overlay};
use crate::ui::action::Action;
use crate::ui::key::Key;
use crate::ui::layout::Pane;
use crate::ui::menu::{Menu, Topic};
use crate::ui::panes::{self, Target};
use crate::ui::tree::Element;
use crate::ui::view::{Kind, name};

impl App {
    /// Beside the selected row of the focused pane.
    pub(super) fn open_menu(&mut self) -> Vec<Effect> {
        let area = self.layout(self.area()).and_then(|layout| layout.area(self.focus));
        let at = area.map_or(Position::default(), |area| self.row_of_selection(area).unwrap_or(area.as_position()));
        self.open_menu_at(Position { x: at.x + 2, ..at })
    }

    pub(super) fn open_menu_at(&mut self, at: Position) -> Vec<Effect> {
        let Some((title, topic)) = self.topic() else { return self.say("nothing is selected") };
        let menu = Menu::new(title, topic, at, |action| self.offers(action));
        self.overlay = Overlay::Menu(menu);
        Vec::new()
    }

    pub(super) fn key_in_menu(&mut self, key: Key) -> Vec<Effect> {
        let (anywhere, in_list) = (self.keys().action(key, Pane::World), self.keys().action(key, Pane::Machines));
        let Overlay::Menu(menu) = &self.overlay else { return Vec::new() };
        let named = menu.rows.iter().position(|entry| self.keys().keys(entry).contains(&key));
        let row = if in_list == Some(Action::Into) { Some(menu.row) } else { named };
        match (row, anywhere.and_then(Move::of)) {
            (_, Some(how)) => self.go_in_menu(how),
            (Some(row), None) => return self.choose_in_menu(row),
            (None, None) => self.overlay = Overlay::Nothing,
        }
        match anywhere {
            Some(Action::Runstop) => self.perform(Action::Runstop),
            _ => Vec::new(),
        }
    }

    pub(super) fn go_in_menu(&mut self, how: Move) {
        if let Overlay::Menu(menu) = &mut self.overlay {
            menu.row = how.from(Some(menu.row), menu.rows.len(), menu.rows.len()).unwrap_or(0);
        }
    }

    pub(super) fn choose_in_menu(&mut self, row: usize) -> Vec<Effect> {
        match std::mem::replace(&mut self.overlay, Overlay::Nothing) {
            Overlay::Menu(menu) => menu.rows.get(row).map_or_else(Vec::new, |entry| self.perform(entry.action)),
            _ => Vec::new(),
        }
    }

    /// What is selected in the focused pane, in words, and which of the menus it has.
    fn topic(&self) -> Option<(String, Topic)> {
        let transition = match self.focus {
            Pane::Detail => self.transition_in_detail(),
            Pane::Graph | Pane::Source => self.transition_in_text(),
            _ => None,
        };
        if let Some(id) = transition {
            let program = self.program()?;
            let title = program[id].name.as_ref().map_or("transition", |name| name);
            return Some((title.into(), Topic::Transition));
        }
        let subject = match self.focus {
            Pane::Detail | Pane::Source | Pane::World => self.subject,
            pane => pane,
        };
        match subject {
            Pane::Variables => {
                let path = self.selected_variable()?;
                let known = self.program().is_some_and(|program| program.var(&path).is_some());
                Some((name(&path).into(), if known { Topic::Variable } else { Topic::Carried }))
            }
            Pane::Log => self.reading.place.as_ref().map(|row| (self.log_title(row), Topic::LogLine)),
            _ => {
                let (path, element) = self.selected_element()?;
                let topic = match element {
                    Element::Machine(_) => Topic::Machine,
                    Element::State(_) => Topic::State,
                };
                Some((name(&path).into(), topic))
            }
        }
    }

    fn log_title(&self, row: &LogRow) -> String {
        let entry = match row {
            LogRow::Problem(_) => return "problem".into(),
            LogRow::Entry(number) => self.view.journal.get(*number),
        };
        let is_change = entry.is_some_and(|entry| matches!(entry.kind, Kind::Change(_)));
        if is_change { "transition".into() } else { "log".into() }
    }

    fn row_of_selection(&self, area: Rect) -> Option<Position> {
        let rows = (area.y + 1..area.bottom()).map(|y| Position { x: area.x + 1, y });
        rows.into_iter().find(|&at| match panes::at(self, self.focus, area, at) {
            Some(Target::Element(path)) => self.selected.as_ref() == Some(&path),
            Some(Target::Value(path)) => self.value.as_ref() == Some(&path),
            Some(Target::Log(place)) => self.reading.place.as_ref() == Some(&place),
            Some(Target::Detail(line)) => self.detail_at == line,
            Some(Target::Robot(key)) => self.robot_row.as_ref() == Some(&key),
            Some(Target::Text(line, _)) => self.text_line() == Some(line),
            Some(Target::Transition(_)) | None => false,
        })
    }
}
