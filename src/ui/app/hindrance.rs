//! Why an action can't be done now, in a sentence: said when it is tried, and beside it where all are listed.

use super::App;
use crate::ui::action::Action;
use crate::ui::tree::Element;

impl App {
    pub fn hindrance(&self, action: Action) -> Option<String> {
        match action {
            Action::ApplyHeld | Action::DropHeld | Action::HeldEdit => self.nothing_held(),
            Action::GiveBack => {
                let lost = self.view.lost().next();
                lost.is_none().then(|| "no value set by hand was lost".into())
            }
            Action::TransitionTo | Action::JumpTo => self.no_state(),
            Action::PutAtStart => self.view.world.is_none().then(|| "there is no simulated robot to put back".into()),
            Action::EditValue
            | Action::Increase
            | Action::Decrease
            | Action::IncreaseMuch
            | Action::DecreaseMuch
            | Action::WriteBack
            | Action::Pin => self.value.is_none().then(|| self.no_variable()),
            Action::Reset => match self.selected_variable() {
                Some(path) => self.refusal(&path),
                None => Some(self.no_variable()),
            },
            Action::WriteAll => {
                let unwritten = self.unwritten().next();
                unwritten.is_none().then(|| "every value set by hand is in the text".into())
            }
            _ => None,
        }
    }

    fn nothing_held(&self) -> Option<String> {
        let nothing = || format!("no edit is held; {} holds the next saves", self.keys().name(Action::SwitchSaves));
        self.view.held.is_none().then(nothing)
    }

    fn no_variable(&self) -> String {
        format!("no variable is selected; {} selects the first", self.keys().name(Action::Down))
    }

    fn no_state(&self) -> Option<String> {
        match self.selected_element() {
            Some((_, Element::State(_))) => None,
            Some((path, Element::Machine(_))) => Some(format!("{path} is a machine; select one of its states")),
            None => Some("no state is selected".into()),
        }
    }
}
