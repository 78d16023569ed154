//! Typing a value for a variable: one line at the bottom, so that nothing is covered.

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent, KeyModifiers};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

use super::values::NOTHING_SELECTED;
use super::{App, Effect, Overlay};
use crate::runtime::command::Command;
use crate::ui::format;
use crate::ui::view::Path;

#[derive(Clone, Debug)]
pub struct Typing {
    /// The variable.
    pub var: Path,
    pub input: Input,
    pub text: Text,
}

/// Whose words stand in the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// The present value: the first character typed takes its place, moving in it keeps it.
    Present,
    Typed,
}

impl App {
    pub(super) fn begin_typing(&mut self) -> Vec<Effect> {
        let Some(var) = self.value.clone() else { return self.say(NOTHING_SELECTED) };
        // What can't be set is said, and letters typed all the same are no commands.
        self.message = self.refusal(&var);
        let value = self.view.variables.get(&var).and_then(|variable| variable.value.as_ref());
        let text = value.and_then(format::source).unwrap_or_default();
        self.overlay = Overlay::Value(Typing { var, input: Input::new(text), text: Text::Present });
        Vec::new()
    }

    pub(super) fn type_value(&mut self, event: KeyEvent) -> Vec<Effect> {
        let Overlay::Value(typing) = &mut self.overlay else { return Vec::new() };
        match event.code {
            KeyCode::Esc => self.overlay = Overlay::Nothing,
            KeyCode::Enter => return self.finish_typing(),
            code => {
                let replaces =
                    matches!(code, KeyCode::Char(_)) && event.modifiers.difference(KeyModifiers::SHIFT).is_empty();
                if std::mem::replace(&mut typing.text, Text::Typed) == Text::Present && replaces {
                    typing.input.reset();
                }
                typing.input.handle_event(&TerminalEvent::Key(event));
            }
        }
        Vec::new()
    }

    fn finish_typing(&mut self) -> Vec<Effect> {
        let Overlay::Value(typing) = &self.overlay else { return Vec::new() };
        let (var, value) = (typing.var.to_string(), typing.input.value().trim().to_owned());
        if value.is_empty() {
            return self.say("a value is a Lua expression, as in 128 or {x = 1}; Esc leaves");
        }
        if let Some(refusal) = self.refusal(&var) {
            return self.say(refusal);
        }
        if let Overlay::Value(typing) = std::mem::replace(&mut self.overlay, Overlay::Nothing) {
            self.sent = Some(typing);
        }
        vec![Effect::Command(Command::Set { var, value })]
    }

    /// The engine refused a value: it can be mended where it was typed.
    pub(super) fn type_again(&mut self) {
        if let (Some(typing), Overlay::Nothing) = (self.sent.take(), &self.overlay) {
            self.overlay = Overlay::Value(typing);
        }
    }
}
