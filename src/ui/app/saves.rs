//! What a person does about edits: how they are met, the one that is held, and the values they cost.

use super::moment::Moment;
use super::movement::Move;
use super::{App, Effect, Overlay};
use crate::runtime::command::{Command, OnEdit, Saves};
use crate::ui::action::Action;
use crate::ui::format;
use crate::ui::key::Key;
use crate::ui::layout::Pane;
use crate::ui::panes::held;
use crate::ui::view::{Edit, name};

impl App {
    /// A program was taken over: news, unless it is the first.
    pub(super) fn saved(&mut self) {
        if self.view.loads > 1 {
            self.moment = Some(Moment::default());
        }
        if matches!(self.overlay, Overlay::Held { .. }) {
            self.overlay = Overlay::Nothing;
        }
        if let Some(Edit::Taken(outcome)) = &self.view.edit {
            self.written.retain(|path, _| !outcome.gives(path));
        }
    }

    pub(super) fn switch_on_edit(&mut self) -> Vec<Effect> {
        let (mode, said) = match self.view.choices.on_edit {
            OnEdit::Restart => (OnEdit::Keep, "edits keep active states from now on"),
            OnEdit::Keep => (OnEdit::Restart, "edits of active states restart from now on"),
        };
        self.say(said);
        vec![Effect::Command(Command::OnEdit { mode })]
    }

    pub(super) fn switch_saves(&mut self) -> Vec<Effect> {
        let key = |action| self.keys().name(action);
        let (apply, drop, show) = (key(Action::ApplyHeld), key(Action::DropHeld), key(Action::HeldEdit));
        let (mode, said) = match self.view.choices.saves {
            Saves::Apply => {
                (Saves::Hold, format!("saves wait for {apply} (apply), {drop} (drop); {show} lists what they do"))
            }
            Saves::Hold => (Saves::Apply, "saves count at once from now on".into()),
        };
        self.say(said);
        vec![Effect::Command(Command::Saves { mode })]
    }

    pub(super) fn decide_held(&mut self, command: Command) -> Vec<Effect> {
        if matches!(self.overlay, Overlay::Held { .. }) {
            self.overlay = Overlay::Nothing;
        }
        vec![Effect::Command(command)]
    }

    /// The list stays while what it tells may still change by the same hand.
    pub(super) fn key_in_held(&mut self, key: Key) -> Vec<Effect> {
        let length = held::lines(self, self.options.size.width).len();
        match self.keys().action(key, Pane::World) {
            Some(
                action @ (Action::Runstop
                | Action::ApplyHeld
                | Action::DropHeld
                | Action::SwitchOnEdit
                | Action::Pause
                | Action::Step),
            ) => return self.perform(action),
            other => match other.and_then(Move::of) {
                Some(how) => self.scroll_overlay(how, length),
                None => self.overlay = Overlay::Nothing,
            },
        }
        Vec::new()
    }

    /// Sets the values again that initial values replaced.
    pub(super) fn give_back(&mut self) -> Vec<Effect> {
        let lost: Vec<(String, String)> = self.view.lost().map(|(path, value)| (path.to_string(), value)).collect();
        let told: Vec<String> = lost.iter().map(|(var, value)| format!("{} {value}", name(var))).collect();
        self.say(format!("set again: {}", format::fit(&told.join(", "), 60)));
        lost.into_iter().map(|(var, value)| Effect::Command(Command::Set { var, value })).collect()
    }
}
