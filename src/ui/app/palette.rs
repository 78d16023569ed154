//! Everything that can be done or gone to, by its name.

use std::cmp::Reverse;

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent, KeyModifiers};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

use super::movement::Move;
use super::{App, Effect, Overlay};
use crate::ui::action::{Entry, Reach, TABLE};
use crate::ui::fuzzy;
use crate::ui::key::Key;
use crate::ui::layout::Pane;
use crate::ui::tree;
use crate::ui::view::{Path, name, owner};

#[derive(Clone, Debug)]
pub struct Palette {
    pub input: Input,
    /// What fits what was typed. It holds still while the program changes.
    pub offers: Vec<Offer>,
    /// The one a person is at.
    pub at: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Offer {
    Action(&'static Entry),
    /// To select a machine or a state.
    Place(Path),
    /// To select a variable.
    Variable(Path),
}

/// A name among others is worth more than a part of a path or of a sentence.
const ASIDE: i32 = -40;

impl Palette {
    pub(super) fn go(&mut self, how: Move, page: usize) {
        self.at = how.from(Some(self.at), self.offers.len(), page).unwrap_or(0);
    }
}

impl App {
    pub(super) fn open_palette(&mut self) {
        let (input, offers) = (Input::default(), self.fitting(""));
        self.overlay = Overlay::Palette(Palette { input, offers, at: 0 });
    }

    pub(super) fn key_in_palette(&mut self, event: KeyEvent) -> Vec<Effect> {
        let page = usize::from(self.options.size.height / 2);
        let movement = self.movement_while_typing(Key::from(event));
        let Overlay::Palette(palette) = &mut self.overlay else { return Vec::new() };
        match (event.code, movement) {
            (KeyCode::Esc, _) => self.overlay = Overlay::Nothing,
            (KeyCode::Enter, _) => return self.take_offer(),
            (_, Some(how)) => palette.go(how, page),
            _ => {
                let before = palette.input.value().to_owned();
                palette.input.handle_event(&TerminalEvent::Key(event));
                let typed = palette.input.value().to_owned();
                if typed != before {
                    self.offer_anew(&typed);
                }
            }
        }
        Vec::new()
    }

    /// A key that neither types anything nor moves in the line.
    pub(super) fn movement_while_typing(&self, key: Key) -> Option<Move> {
        match key.code {
            KeyCode::Char('p') if key.modifiers == KeyModifiers::CONTROL => Some(Move::Up),
            KeyCode::Char('n') if key.modifiers == KeyModifiers::CONTROL => Some(Move::Down),
            KeyCode::Char(_) => None,
            _ => {
                let how = self.keys().action(key, Pane::World).and_then(Move::of);
                how.filter(|how| !matches!(how, Move::First | Move::Last))
            }
        }
    }

    fn offer_anew(&mut self, typed: &str) {
        let offers = self.fitting(typed);
        if let Overlay::Palette(palette) = &mut self.overlay {
            (palette.offers, palette.at) = (offers, 0);
        }
    }

    /// The best first; among equals what was used last, then as in the table. Without anything typed no places.
    fn fitting(&self, typed: &str) -> Vec<Offer> {
        let mut offers: Vec<(i32, Offer)> = actions()
            .filter_map(|entry| Some((worth(typed, entry)?, entry)))
            .map(|(worth, entry)| (worth, Offer::Action(entry)))
            .collect();
        if !typed.trim().is_empty() {
            let named = |path: &Path| fuzzy::fit(typed, name(path)).or_else(|| Some(fuzzy::fit(typed, path)? + ASIDE));
            let places = self.places().filter_map(|path| Some((named(&path)?, Offer::Place(path))));
            offers.extend(places);
            let variables = self.program().into_iter().flat_map(|program| &program.vars).map(|var| var.path.clone());
            offers.extend(variables.filter_map(|path| Some((named(&path)?, Offer::Variable(path)))));
        }
        offers.sort_by_cached_key(|(worth, offer)| (Reverse(*worth), self.last_used(offer)));
        offers.into_iter().map(|(_, offer)| offer).collect()
    }

    fn places(&self) -> impl Iterator<Item = Path> {
        let machines = self.program().into_iter().flat_map(|program| &program.machines).map(|machine| &machine.path);
        let states = self.program().into_iter().flat_map(|program| &program.states).map(|state| &state.path);
        machines.chain(states).cloned()
    }

    fn last_used(&self, offer: &Offer) -> usize {
        let Offer::Action(entry) = offer else { return usize::MAX };
        self.recent.iter().position(|id| *id == entry.id).unwrap_or(usize::MAX)
    }

    pub(super) fn take_offer(&mut self) -> Vec<Effect> {
        let Overlay::Palette(palette) = std::mem::replace(&mut self.overlay, Overlay::Nothing) else {
            return Vec::new();
        };
        match palette.offers.into_iter().nth(palette.at) {
            Some(Offer::Action(entry)) => self.perform_where_it_works(entry),
            Some(Offer::Place(path)) => self.go_to_place(path),
            Some(Offer::Variable(path)) => self.go_to_variable(path),
            None => self.say(format!("nothing is called {}", palette.input.value().trim())),
        }
    }

    /// As if its key had been pressed in a pane that has it.
    fn perform_where_it_works(&mut self, entry: &'static Entry) -> Vec<Effect> {
        if let Some(why) = self.hindrance(entry.action) {
            return self.say(why);
        }
        self.recent.retain(|id| *id != entry.id);
        self.recent.insert(0, entry.id);
        if let Reach::Panes([pane, ..]) = entry.reach
            && !entry.works_in(self.focus)
        {
            self.focus_on(*pane);
        }
        self.perform(entry.action)
    }

    fn go_to_place(&mut self, path: Path) -> Vec<Effect> {
        if self.program().is_none_or(|program| tree::element(program, &path).is_none()) {
            return self.say(format!("{path} is gone"));
        }
        if self.focus != Pane::Graph {
            self.focus_on(Pane::Machines);
        }
        self.take_as_subject(self.focus);
        self.select(path);
        Vec::new()
    }

    /// The machine that has it, so that it is listed.
    fn go_to_variable(&mut self, path: Path) -> Vec<Effect> {
        if self.program().is_none_or(|program| program.var(&path).is_none()) {
            return self.say(format!("{path} is gone"));
        }
        self.arrangement.filter.clear();
        if let Some(machine) = owner(&path) {
            self.select(machine.into());
        }
        self.focus_on(Pane::Variables);
        self.take_as_subject(Pane::Variables);
        self.value = Some(path);
        Vec::new()
    }
}

/// Each once, as its first row has it.
fn actions() -> impl Iterator<Item = &'static Entry> {
    let first =
        |entry: &&Entry| TABLE.iter().find(|other| other.action == entry.action).map(|it| it.id) == Some(entry.id);
    TABLE.iter().filter(first)
}

fn worth(typed: &str, entry: &Entry) -> Option<i32> {
    fuzzy::fit(typed, entry.id).or_else(|| fuzzy::begins_words(typed, entry.help).then_some(ASIDE))
}
