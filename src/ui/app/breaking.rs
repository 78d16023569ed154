//! Where a person wants the program to pause, and what is looked at when it has.

use tui_input::Input;

use super::movement::Move;
use super::{App, Effect, Goal, LogRow, Overlay, Text, Typing};
use crate::model::TransitionId;
use crate::model::transition_names::TransitionNames;
use crate::runtime::command::{BreakAt, Breaking, Command, OnError};
use crate::runtime::record::Setter;
use crate::ui::action::Action;
use crate::ui::key::Key;
use crate::ui::layout::Pane;
use crate::ui::panes::detail;
use crate::ui::tree::{self, Element};
use crate::ui::view::{Kind, Path, is_own_doing};

impl App {
    /// At the state, or at the transition in the log or the detail, that is selected.
    pub(super) fn toggle_breakpoint(&mut self) -> Vec<Effect> {
        let at = match self.focus {
            Pane::Detail => self.transition_in_detail().map_or_else(|| self.selected_break(), |id| self.break_on(id)),
            Pane::Log => self.break_in_log(),
            Pane::Source | Pane::Graph => self.break_in_text(),
            _ => self.selected_break(),
        };
        match at {
            Ok(at) => self.toggle_break_at(at),
            Err(why) => self.say(why),
        }
    }

    pub(super) fn selected_break(&self) -> Result<BreakAt, String> {
        match self.selected_element() {
            Some((state, Element::State(_))) => Ok(BreakAt::State { state }),
            Some((path, Element::Machine(_))) => {
                let key = self.keys().name(Action::BreakWhen);
                Err(format!("{path} is a machine; select a state, or type a condition ({key})"))
            }
            None => Err("no state is selected".into()),
        }
    }

    pub(super) fn break_on(&self, id: TransitionId) -> Result<BreakAt, String> {
        let program = self.program().ok_or("there is no program")?;
        Ok(BreakAt::Transition { transition: TransitionNames::of(program).name(id) })
    }

    /// The transition of a line of the log, as far as its program still runs.
    pub(super) fn break_in_log(&self) -> Result<BreakAt, String> {
        let Some(LogRow::Entry(number)) = &self.reading.place else {
            return Err("select a transition in the log, or a state".into());
        };
        match self.view.journal.get(*number).map(|entry| &entry.kind) {
            Some(Kind::Change(cause)) => match cause.transition {
                Some((load, id)) if load == self.view.loads => self.break_on(id),
                _ => Err("the program has changed since; take a later line".into()),
            },
            _ => Err("this line is no transition".into()),
        }
    }

    /// The way out of a state that a person is at in the detail.
    pub(super) fn transition_in_detail(&self) -> Option<TransitionId> {
        let lines = detail::lines(self, self.columns(Pane::Detail));
        lines.get(self.detail_at)?.transition
    }

    fn toggle_break_at(&mut self, at: BreakAt) -> Vec<Effect> {
        let (mode, said) = match self.view.breakpoint(&at) {
            None => (Breaking::Set, format!("pauses at {at}")),
            Some(Setter::Command) => (Breaking::Clear, format!("no longer pauses at {at}")),
            Some(Setter::Source) => (Breaking::Clear, format!("its (break) stays in the text: no pause at {at}")),
        };
        self.say(said);
        vec![Effect::Command(Command::Break { at, mode })]
    }

    /// Asks for a Lua expression in the scope of the selected machine.
    pub(super) fn ask_for_condition(&mut self) -> Vec<Effect> {
        let machine = self.program().zip(self.machine()).map(|(program, machine)| program[machine].path.clone());
        let goal = Goal::Condition(machine.unwrap_or_default());
        self.overlay = Overlay::Typing(Typing { goal, input: Input::default(), text: Text::Typed });
        Vec::new()
    }

    pub(super) fn switch_on_error(&mut self) -> Vec<Effect> {
        let (mode, said) = match self.view.choices.on_error {
            OnError::Continue => (OnError::Pause, "pauses when something goes wrong from now on"),
            OnError::Pause => (OnError::Continue, "goes on when something goes wrong from now on"),
        };
        self.say(said);
        vec![Effect::Command(Command::OnError { mode })]
    }

    pub(super) fn breakpoints_changed(&mut self) {
        if self.sent.as_ref().is_some_and(|typing| matches!(typing.goal, Goal::Condition(_))) {
            self.sent = None;
        }
        if let Overlay::Breakpoints { at } = &mut self.overlay {
            *at = (*at).min(self.view.breakpoints.len().saturating_sub(1));
        }
    }

    pub(super) fn key_in_breakpoints(&mut self, key: Key) -> Vec<Effect> {
        let Overlay::Breakpoints { at } = self.overlay else { return Vec::new() };
        let action = self.keys().action(key, Pane::Machines);
        match action {
            Some(Action::Runstop | Action::Pause | Action::Step) => {
                action.map_or_else(Vec::new, |action| self.perform(action))
            }
            Some(Action::ToggleBreakpoint | Action::Into) => self.clear_breakpoint(at),
            Some(Action::DropHeld) => self.clear_breakpoints(),
            other => {
                match other.and_then(Move::of).map(|how| how.from(Some(at), self.view.breakpoints.len(), 10)) {
                    Some(to) => self.overlay = Overlay::Breakpoints { at: to.unwrap_or(0) },
                    None => self.overlay = Overlay::Nothing,
                }
                Vec::new()
            }
        }
    }

    fn clear_breakpoint(&mut self, at: usize) -> Vec<Effect> {
        match self.view.breakpoints.get(at).map(|breakpoint| breakpoint.at.clone()) {
            Some(at) => self.toggle_break_at(at),
            None => Vec::new(),
        }
    }

    fn clear_breakpoints(&mut self) -> Vec<Effect> {
        let clear = |at: &BreakAt| Effect::Command(Command::Break { at: at.clone(), mode: Breaking::Clear });
        self.view.breakpoints.iter().map(|breakpoint| clear(&breakpoint.at)).collect()
    }

    /// What a person has to look at is selected and in sight: the state, and the error if that is why.
    pub(super) fn paused(&mut self, step: u64, reason: &str, at: Option<&Path>) {
        if is_own_doing(reason) {
            return;
        }
        // It would cover the reason.
        self.moment = None;
        if let Some(at) = at.filter(|at| self.program().is_some_and(|program| tree::element(program, at).is_some())) {
            self.select(at.clone());
        }
        let by_error = reason.split("; ").any(|part| part.starts_with("error"));
        if let Some((_, key)) = self.fault.as_ref().filter(|(then, _)| by_error && *then == step) {
            self.reading.place = Some(LogRow::Problem(key.clone()));
            self.reading.since = self.view.journal.next();
            self.reading.row = 0;
            self.subject = Pane::Log;
        }
        self.settle();
    }
}
