//! What panes ask of the app: it answers and changes nothing.

use std::rc::Rc;

use ratatui::layout::{Rect, Size};

use super::{App, Options, Overlay, Reading};
use crate::model::{MachineId, Program};
use crate::runtime::Explain;
use crate::ui::action::Action;
use crate::ui::keymap::Keymap;
use crate::ui::layout::{Layout, Pane, Simulated, Wish};
use crate::ui::panes::diagram::{Diagram, View as Closeness};
use crate::ui::scope::{Arrangement, Listing, Row};
use crate::ui::theme::Theme;
use crate::ui::tree::{self, Element};
use crate::ui::view::{Edit, Outcome, Path, View, within};

impl App {
    pub fn view(&self) -> &View {
        &self.view
    }

    pub fn options(&self) -> &Options {
        &self.options
    }

    pub fn theme(&self) -> &Theme {
        &self.options.settings.theme
    }

    pub fn keys(&self) -> &Keymap {
        &self.options.settings.keys
    }

    pub fn focus(&self) -> Pane {
        self.focus
    }

    pub fn subject(&self) -> Pane {
        self.subject
    }

    pub fn overlay(&self) -> &Overlay {
        &self.overlay
    }

    pub fn message(&self) -> Option<&str> {
        self.message.as_deref()
    }

    pub fn halted(&self) -> bool {
        self.halted
    }

    pub fn follows(&self) -> bool {
        self.follow.is_on()
    }

    /// The path of the selected machine or state.
    pub fn selected(&self) -> Option<&Path> {
        self.selected.as_ref()
    }

    /// The path of the selected variable or field.
    pub fn selected_value(&self) -> Option<&Path> {
        self.value.as_ref()
    }

    pub fn reading(&self) -> &Reading {
        &self.reading
    }

    pub fn is_folded(&self, path: &str) -> bool {
        self.folded.contains(path)
    }

    pub fn program(&self) -> Option<&Program> {
        self.view.program.as_deref()
    }

    /// The machine that is drawn and whose variables are listed.
    pub fn machine(&self) -> Option<MachineId> {
        let program = self.program()?;
        let selected = self.selected.as_ref().and_then(|path| tree::machine_of(program, path));
        selected.or_else(|| program.tops.first().copied())
    }

    pub fn tree(&self) -> Vec<tree::Row> {
        self.program().map_or_else(Vec::new, |program| tree::rows(program, &self.folded))
    }

    pub fn values(&self) -> Listing {
        Listing::new(&self.view, self.machine(), &self.arrangement)
    }

    pub fn arrangement(&self) -> &Arrangement {
        &self.arrangement
    }

    /// The variable a person is at, also inside its table; or what comes from the robot.
    pub fn selected_variable(&self) -> Option<Path> {
        let path = self.value.as_ref()?;
        match self.values().row(path) {
            Some(Row::Item { root, .. }) => Some(root.clone()),
            _ => Some(path.clone()),
        }
    }

    pub fn tree_top(&self) -> usize {
        self.tree_scroll.top()
    }

    pub fn values_top(&self) -> usize {
        self.values_scroll.top()
    }

    pub fn detail_top(&self) -> usize {
        self.detail_scroll.top()
    }

    /// The line of the detail a person is at.
    pub fn detail_at(&self) -> usize {
        self.detail_at
    }

    /// Whether the engine is to tell what guards come to: while there is a place where that is seen.
    pub fn explain(&self) -> Explain {
        if self.shows_detail() { Explain::On } else { Explain::Off }
    }

    /// Whether a key does anything now: some only where there is something to do it with.
    pub fn offers(&self, action: Action) -> bool {
        match action {
            Action::ApplyHeld | Action::DropHeld | Action::HeldEdit | Action::GiveBack => {
                self.hindrance(action).is_none()
            }
            Action::WriteBack => self.selected_variable().is_some_and(|path| self.unwritten_value(&path).is_some()),
            Action::Into => self.has_inside(),
            Action::ToggleBreakpoint if self.focus == Pane::Log => self.break_in_log().is_ok(),
            Action::Reset => self.value.as_ref().is_some_and(|path| self.view.by_hand.contains_key(path)),
            _ => true,
        }
    }

    /// Whether there is anything in the selected machine or state.
    fn has_inside(&self) -> bool {
        let Some((program, (_, element))) = self.program().zip(self.selected_element()) else { return false };
        match element {
            Element::Machine(machine) => !program[machine].states.is_empty(),
            Element::State(state) => !program[state].machines.is_empty(),
        }
    }

    /// What the last save did, while it is news.
    pub fn news(&self) -> Option<&Outcome> {
        match &self.view.edit {
            Some(Edit::Taken(outcome)) if self.moment.is_some() => {
                let tells = outcome.is_eventful() || self.offers(Action::GiveBack);
                Some(outcome).filter(|_| tells)
            }
            _ => None,
        }
    }

    /// None where the screen is too small.
    pub fn layout(&self, area: Rect) -> Option<Layout> {
        Layout::new(area, self.wish())
    }

    pub(super) fn wish(&self) -> Wish<'_> {
        let simulated = if self.view.world.is_some() { Simulated::World } else { Simulated::Nothing };
        let tree = self.program().map_or(0, |program| program.machines.len() + program.states.len());
        Wish { focus: self.focus, figure: self.figure, extent: self.extent, simulated, tree, chosen: &self.chosen }
    }

    /// The path of a machine from outside in, also where it is spawned in another place than it is written.
    pub fn breadcrumb(&self, program: &Program, machine: MachineId) -> String {
        let path = &program[machine].path;
        let top = path.split('/').next().unwrap_or(path);
        let spawner = self.view.machines.get(top).and_then(|machine| machine.spawned_by.as_ref());
        match spawner.filter(|spawner| !within(spawner, top)) {
            Some(spawner) => format!("{spawner}/{path}"),
            None => path.to_string(),
        }
    }

    /// The drawing of a machine for a place: kept from the last frames where nothing changed.
    pub fn diagram(&self, program: &Program, machine: MachineId, view: Closeness, size: Size) -> Rc<Diagram> {
        let key = (self.view.loads, machine, view, size);
        let mut kept = self.diagrams.borrow_mut();
        if let Some((_, diagram)) = kept.iter().find(|(of, _)| *of == key) {
            return diagram.clone();
        }
        let diagram = Rc::new(Diagram::new(program, machine, view, size, self.options.settings.charset));
        kept.truncate(DIAGRAMS_KEPT - 1);
        kept.push_front((key, diagram.clone()));
        diagram
    }
}

/// As many as a frame may need, with those for which there was no room in the end.
const DIAGRAMS_KEPT: usize = 12;
