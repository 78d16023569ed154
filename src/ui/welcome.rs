//! `lrp` without a file, as a value: the behaviours at hand, the tour, a new one. Keys go in, a choice and a frame come out.

mod draw;
pub mod run;

use std::path::PathBuf;

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent};
use ratatui::layout::Size;
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

use super::action::Action;
use super::app::{Move, top_for};
use super::key::Key;
use super::layout::Pane;
use super::settings::Settings;
use crate::session::behaviours::{Behaviour, Found};

pub struct Welcome {
    options: Options,
    /// None while it is looked for.
    found: Option<Found>,
    selected: Row,
    /// Whether a person has moved or typed.
    touched: bool,
    top: usize,
    /// The name that is being typed.
    naming: Option<Input>,
    message: Option<String>,
}

#[derive(Clone, Debug)]
pub struct Options {
    /// The folder, for people.
    pub folder: String,
    /// How far the tour was taken here: `4 of 14`.
    pub tour: Option<String>,
    pub settings: Settings,
    pub size: Size,
}

/// What can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    Behaviour(usize),
    Tour,
    New,
}

/// What the outer loop is to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Choice {
    Open(PathBuf),
    /// A behaviour of this name is to be made, and opened.
    Make(String),
    Tour,
    Quit,
    Suspend,
    Redraw,
}

impl Welcome {
    pub fn new(options: Options) -> Welcome {
        Welcome { options, found: None, selected: Row::Tour, touched: false, top: 0, naming: None, message: None }
    }

    /// What was looked for. A person who has chosen meanwhile keeps the choice.
    pub fn found(&mut self, found: Found) {
        self.found = Some(found);
        if !self.touched && !self.behaviours().is_empty() {
            self.selected = Row::Behaviour(0);
        }
    }

    pub fn resize(&mut self, size: Size) {
        self.options.size = size;
        self.settle();
    }

    /// Why nothing was made of the choice; a name can be mended.
    pub fn refuse(&mut self, why: impl ToString) {
        self.message = Some(why.to_string());
    }

    pub fn key(&mut self, event: KeyEvent) -> Option<Choice> {
        self.message = None;
        self.touched = true;
        let key = Key::from(event);
        match self.options.settings.keys.action_always(key) {
            Some(Action::Quit) => return Some(Choice::Quit),
            Some(Action::Suspend) => return Some(Choice::Suspend),
            Some(Action::Redraw) => return Some(Choice::Redraw),
            _ => (),
        }
        let choice = match &self.naming {
            Some(_) => self.type_on(event),
            None => self.command(key),
        };
        self.settle();
        choice
    }

    fn command(&mut self, key: Key) -> Option<Choice> {
        match key.code {
            KeyCode::Char('t') => return Some(Choice::Tour),
            KeyCode::Char('n') => self.naming = Some(Input::default()),
            KeyCode::Enter => return self.choose(),
            _ => match self.options.settings.keys.action(key, Pane::World) {
                Some(Action::Quit | Action::Back) => return Some(Choice::Quit),
                Some(action) => match Move::of(action) {
                    Some(how) => self.go(how),
                    None => self.say_keys(key),
                },
                None => self.say_keys(key),
            },
        }
        None
    }

    fn say_keys(&mut self, key: Key) {
        self.message = Some(format!("{key} does nothing here: choose, and press Enter"));
    }

    fn choose(&mut self) -> Option<Choice> {
        match self.selected {
            Row::Behaviour(at) => Some(Choice::Open(self.behaviours().get(at)?.file.clone())),
            Row::Tour => Some(Choice::Tour),
            Row::New => {
                self.naming = Some(Input::default());
                None
            }
        }
    }

    fn type_on(&mut self, event: KeyEvent) -> Option<Choice> {
        let input = self.naming.as_mut()?;
        match event.code {
            KeyCode::Esc => self.naming = None,
            KeyCode::Enter => return Some(Choice::Make(input.value().to_string())),
            _ => _ = input.handle_event(&TerminalEvent::Key(event)),
        }
        None
    }

    fn go(&mut self, how: Move) {
        let rows = self.rows();
        let at = rows.iter().position(|row| *row == self.selected);
        if let Some(to) = how.from(at, rows.len(), self.page()) {
            self.selected = rows[to];
        }
    }

    fn settle(&mut self) {
        let at = match self.selected {
            Row::Behaviour(at) => Some(at),
            Row::Tour | Row::New => None,
        };
        self.top = top_for(self.top, at, self.behaviours().len(), self.page());
    }

    pub fn selected(&self) -> Row {
        self.selected
    }

    pub fn behaviours(&self) -> &[Behaviour] {
        self.found.as_ref().map_or(&[], |found| &found.all)
    }

    fn rows(&self) -> Vec<Row> {
        let behaviours = (0..self.behaviours().len()).map(Row::Behaviour);
        behaviours.chain([Row::Tour, Row::New]).collect()
    }
}
