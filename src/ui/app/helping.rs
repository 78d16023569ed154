//! The help: gone through like a list, and searched.

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

use super::movement::Move;
use super::{App, Effect, Overlay};
use crate::ui::action::Action;
use crate::ui::key::Key;
use crate::ui::layout::Pane;
use crate::ui::panes::help;

#[derive(Clone, Debug, Default)]
pub struct Help {
    /// The first line that is seen.
    pub top: usize,
    /// Only what this finds.
    pub search: Input,
    pub line: SearchLine,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SearchLine {
    #[default]
    Closed,
    Open,
}

impl App {
    pub(super) fn key_in_help(&mut self, event: KeyEvent) -> Vec<Effect> {
        let Overlay::Help(help) = &mut self.overlay else { return Vec::new() };
        if help.line == SearchLine::Open {
            return self.search_help(event);
        }
        let key = Key::from(event);
        if self.keys().action(key, Pane::Variables) == Some(Action::Search) {
            self.change_help(|help| help.line = SearchLine::Open);
            return Vec::new();
        }
        match self.keys().action(key, Pane::World) {
            Some(Action::Runstop) => return self.perform(Action::Runstop),
            other => match other.and_then(Move::of) {
                Some(how) => self.go_in_help(how),
                None => self.overlay = Overlay::Nothing,
            },
        }
        Vec::new()
    }

    fn search_help(&mut self, event: KeyEvent) -> Vec<Effect> {
        if let Some(how) = self.movement_while_typing(Key::from(event)) {
            self.go_in_help(how);
            return Vec::new();
        }
        self.change_help(|help| match event.code {
            KeyCode::Enter => help.line = SearchLine::Closed,
            KeyCode::Esc => *help = Help::default(),
            _ => {
                help.search.handle_event(&TerminalEvent::Key(event));
                help.top = 0;
            }
        });
        Vec::new()
    }

    fn change_help(&mut self, change: impl FnOnce(&mut Help)) {
        if let Overlay::Help(help) = &mut self.overlay {
            change(help);
        }
    }

    pub(super) fn go_in_help(&mut self, how: Move) {
        let Overlay::Help(help) = &self.overlay else { return };
        let length = help::lines(self, help, self.options.size.width).len();
        self.scroll_overlay(how, length);
    }
}
