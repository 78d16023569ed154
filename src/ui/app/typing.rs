//! Typing a value for a variable, a condition to pause at, or what variables are called: one line at the bottom, so that nothing is covered.

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent, KeyModifiers};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

use super::{App, Effect, Overlay};
use crate::runtime::command::{BreakAt, Breaking, Command};
use crate::ui::format;
use crate::ui::layout::Pane;
use crate::ui::view::{Path, Renames};

#[derive(Clone, Debug)]
pub struct Typing {
    pub goal: Goal,
    pub input: Input,
    pub text: Text,
}

/// What the expression is for.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// A variable's value.
    Value(Path),
    /// To pause when it becomes true, as seen from a machine; empty: from top level.
    Condition(Path),
    /// A part of the names or words that a pane lists.
    Filter(Pane),
    /// To be sent to a robot.
    Tell(Path),
    /// A setting to be written into a robot's form.
    Setting(Path),
    /// To go to where it stands in the program's text.
    Words,
}

/// Whose words stand in the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// The present value: the first character typed takes its place, moving in it keeps it.
    Present,
    Typed,
}

impl Goal {
    pub fn is_value_of(&self, var: &str) -> bool {
        matches!(self, Goal::Value(path) if **path == *var)
    }

    pub(super) fn rename(&mut self, renames: &Renames) {
        match self {
            Goal::Value(var) => *var = renames.variable(var),
            Goal::Condition(machine) => *machine = renames.place(machine),
            Goal::Filter(_) | Goal::Words | Goal::Tell(_) | Goal::Setting(_) => (),
        }
    }
}

impl App {
    pub(super) fn begin_typing(&mut self) -> Vec<Effect> {
        let Some(var) = self.selected_variable() else { return Vec::new() };
        // What can't be set is said, and letters typed all the same are no commands.
        self.message = self.refusal(&var);
        let value = self.view.variables.get(&var).and_then(|variable| variable.value.as_ref());
        let text = value.and_then(format::source).unwrap_or_default();
        self.overlay = Overlay::Typing(Typing { goal: Goal::Value(var), input: Input::new(text), text: Text::Present });
        Vec::new()
    }

    pub(super) fn type_on(&mut self, event: KeyEvent) -> Vec<Effect> {
        let Overlay::Typing(typing) = &mut self.overlay else { return Vec::new() };
        let filters = match typing.goal {
            Goal::Filter(pane) => Some(pane),
            _ => None,
        };
        match event.code {
            KeyCode::Esc => {
                self.overlay = Overlay::Nothing;
                filters.into_iter().for_each(|pane| self.sought(pane).clear());
            }
            KeyCode::Enter if filters.is_some() => self.overlay = Overlay::Nothing,
            KeyCode::Enter => return self.finish_typing(),
            code => {
                let replaces =
                    matches!(code, KeyCode::Char(_)) && event.modifiers.difference(KeyModifiers::SHIFT).is_empty();
                if std::mem::replace(&mut typing.text, Text::Typed) == Text::Present && replaces {
                    typing.input.reset();
                }
                typing.input.handle_event(&TerminalEvent::Key(event));
                let typed = typing.input.value().trim().to_owned();
                filters.into_iter().for_each(|pane| self.sought(pane).clone_from(&typed));
            }
        }
        Vec::new()
    }

    /// What is called as typed is listed while it is typed.
    pub(super) fn search(&mut self) -> Vec<Effect> {
        let pane = self.focus;
        let input = Input::new(self.sought(pane).clone());
        self.overlay = Overlay::Typing(Typing { goal: Goal::Filter(pane), input, text: Text::Present });
        Vec::new()
    }

    /// The text by which a pane's rows are chosen.
    fn sought(&mut self, pane: Pane) -> &mut String {
        match pane {
            Pane::Log => &mut self.reading.text,
            Pane::Bridge => &mut self.robots_filter,
            _ => &mut self.arrangement.filter,
        }
    }

    fn finish_typing(&mut self) -> Vec<Effect> {
        let Overlay::Typing(typing) = &self.overlay else { return Vec::new() };
        let (goal, text) = (typing.goal.clone(), typing.input.value().trim().to_owned());
        let command = match goal {
            Goal::Filter(_) => return Vec::new(),
            Goal::Tell(_) if text.is_empty() => {
                return self.say("what is sent is written as in a block: move{ .. }; Esc leaves");
            }
            Goal::Tell(robot) => Command::Tell { bridge: robot.to_string(), what: text },
            Goal::Setting(robot) => return self.write_setting(&robot, &text),
            Goal::Words => return self.seek(text),
            Goal::Value(_) if text.is_empty() => {
                return self.say("a value is a Lua expression, as in 128 or {x = 1}; Esc leaves");
            }
            Goal::Condition(_) if text.is_empty() => {
                return self.say("a condition is a Lua expression, as in speed > 0.3; Esc leaves");
            }
            Goal::Value(var) => {
                if let Some(refusal) = self.refusal(&var) {
                    return self.say(refusal);
                }
                Command::Set { var: var.to_string(), value: text }
            }
            Goal::Condition(machine) => {
                Command::Break { at: BreakAt::Condition { condition: text.into(), machine }, mode: Breaking::Set }
            }
        };
        if let Overlay::Typing(typing) = std::mem::replace(&mut self.overlay, Overlay::Nothing) {
            self.sent = Some(typing);
        }
        vec![Effect::Command(command)]
    }

    /// The engine refused what was typed: it can be mended where that was done.
    pub(super) fn type_again(&mut self) {
        if let (Some(typing), Overlay::Nothing) = (self.sent.take(), &self.overlay) {
            self.overlay = Overlay::Typing(typing);
        }
    }
}
