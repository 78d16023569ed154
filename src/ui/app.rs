//! The screen as a value: records and keys go in, effects and a frame come out.
//! Knows nothing of threads, the clock or how a terminal is set up.

mod draw;
mod follow;
mod movement;
mod perform;
mod reading;
mod typing;
mod values;

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::rc::Rc;
use std::sync::Arc;

use crossterm::event::{KeyEvent, KeyEventKind};
use ratatui::layout::{Rect, Size};

pub use movement::top_for;
pub use reading::{Filter, LogRow, Reading, Shown};
pub use typing::{Text, Typing};

use self::follow::Follow;
use super::action;
use super::key::Key;
use super::layout::{Extent, Figure, Layout, Pane, Simulated, Wish};
use super::panes::diagram::Diagram;
use super::scope::Listing;
use super::theme::Theme;
use super::tree;
use super::view::{Path, View};
use crate::model::{MachineId, Program};
use crate::runtime::command::Command;
use crate::runtime::record::{Level, Log, Record, What};

#[derive(Clone, Debug)]
pub struct Options {
    /// The program's file as the user named it.
    pub file: Arc<str>,
    /// Steps a second; 0: as fast as possible.
    pub rate: f64,
    pub theme: Theme,
    /// Of the terminal at the start; later sizes come as events.
    pub size: Size,
}

/// What the outer loop tells of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    Key(KeyEvent),
    Resize(Size),
}

/// What the outer loop is to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    Command(Command),
    OpenEditor {
        file: Arc<str>,
        line: usize,
        column: usize,
    },
    /// After the robot was stopped.
    Quit,
    /// After the robot was stopped.
    Suspend,
    Redraw,
}

pub struct App {
    view: View,
    options: Options,
    focus: Pane,
    figure: Figure,
    extent: Extent,
    /// The pane whose selection the detail tells of.
    subject: Pane,
    /// The machine or state a person is at.
    selected: Option<Path>,
    /// Whether that is only for want of anything that runs.
    provisional: bool,
    folded: BTreeSet<Path>,
    /// The variable or field a person is at.
    value: Option<Path>,
    reading: Reading,
    follow: Follow,
    overlay: Overlay,
    /// A sentence for the person, until the next key.
    message: Option<String>,
    /// The robot was stopped outside the engine, which may not have said so yet.
    halted: bool,
    /// A number on its way to the engine, so that quick nudges add up.
    nudged: Option<(Path, serde_json::Value)>,
    /// A value that was typed and is on its way to the engine, which may refuse it.
    sent: Option<Typing>,
    /// First rows shown.
    tree_top: usize,
    values_top: usize,
    detail_top: usize,
    dirty: bool,
    diagram: RefCell<Option<(DiagramKey, Rc<Diagram>)>>,
}

/// What a drawing depends on: which program, which machine, how much room.
type DiagramKey = (u64, MachineId, Size);

#[derive(Clone, Debug)]
pub enum Overlay {
    Nothing,
    /// From this line on.
    Help {
        top: usize,
    },
    Value(Typing),
}

/// A command that had no effect comes back as an error from nowhere in the program.
fn is_refusal(log: &Log) -> bool {
    log.level == Level::Error && log.state.is_empty() && log.file.is_empty()
}

impl App {
    pub fn new(options: Options) -> App {
        App {
            view: View::new(options.rate),
            options,
            focus: Pane::Machines,
            figure: Figure::Graph,
            extent: Extent::Shared,
            subject: Pane::Machines,
            selected: None,
            provisional: true,
            folded: BTreeSet::new(),
            value: None,
            reading: Reading::default(),
            follow: Follow::default(),
            overlay: Overlay::Nothing,
            message: None,
            halted: false,
            nudged: None,
            sent: None,
            tree_top: 0,
            values_top: 0,
            detail_top: 0,
            dirty: true,
            diagram: RefCell::new(None),
        }
    }

    pub fn record(&mut self, record: &Record) {
        let before = match &record.what {
            What::Load(_) => self.view.program.clone(),
            _ => None,
        };
        self.view.apply(record);
        if let What::Set { var, by, .. } = &record.what
            && **by == *"command"
            && self.sent.as_ref().is_some_and(|typing| typing.var == *var)
        {
            self.sent = None;
        }
        match &record.what {
            What::Load(_) => self.program_changed(before),
            What::Spawn { machine, by: None } if self.provisional => self.first_runs(machine),
            What::Enter { state } => self.entered(record.step, state),
            What::Set { var, .. } if self.nudged.as_ref().is_some_and(|(path, _)| path == var) => self.nudged = None,
            What::Resume => self.halted = false,
            What::Log(log) if is_refusal(log) => {
                self.message = Some(log.message.clone());
                self.nudged = None;
                self.type_again();
            }
            _ => (),
        }
        self.dirty = true;
    }

    pub fn event(&mut self, event: Event) -> Vec<Effect> {
        let effects = match event {
            Event::Key(key) if key.kind == KeyEventKind::Release => return Vec::new(),
            Event::Key(key) => self.key(key),
            Event::Resize(size) => {
                self.options.size = size;
                Vec::new()
            }
        };
        self.settle();
        self.dirty = true;
        effects
    }

    /// A sentence for the person, shown until the next key: a file that went missing, an editor that couldn't start.
    pub fn notice(&mut self, text: impl Into<String>) {
        self.message = Some(text.into());
        self.dirty = true;
    }

    /// The robot was told to stop without waiting for the engine. Shown until the program is resumed.
    pub fn stopped(&mut self) {
        self.halted = true;
        self.dirty = true;
    }

    /// Whether a new frame would differ from the last one drawn.
    pub fn dirty(&self) -> bool {
        self.dirty
    }

    /// The frame is on the terminal.
    pub fn drawn(&mut self) {
        self.dirty = false;
    }

    pub fn view(&self) -> &View {
        &self.view
    }

    pub fn options(&self) -> &Options {
        &self.options
    }

    pub fn theme(&self) -> Theme {
        self.options.theme
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
        Listing::new(&self.view, self.machine())
    }

    pub fn tree_top(&self) -> usize {
        self.tree_top
    }

    pub fn values_top(&self) -> usize {
        self.values_top
    }

    pub fn detail_top(&self) -> usize {
        self.detail_top
    }

    /// None where the screen is too small.
    pub fn layout(&self, area: Rect) -> Option<Layout> {
        Layout::new(area, self.wish())
    }

    fn wish(&self) -> Wish {
        let simulated = if self.view.world.is_some() { Simulated::World } else { Simulated::Nothing };
        let tree = self.program().map_or(0, |program| program.machines.len() + program.states.len());
        Wish { focus: self.focus, figure: self.figure, extent: self.extent, simulated, tree }
    }

    /// The drawing of a machine for an area: kept from the last frame where nothing changed.
    pub fn diagram(&self, program: &Program, machine: MachineId, area: Rect) -> Rc<Diagram> {
        let key = (self.view.loads, machine, area.as_size());
        let mut kept = self.diagram.borrow_mut();
        match &*kept {
            Some((of, diagram)) if *of == key => diagram.clone(),
            _ => {
                let diagram = Rc::new(Diagram::new(program, machine, area.width, area.height));
                *kept = Some((key, diagram.clone()));
                diagram
            }
        }
    }

    fn program_changed(&mut self, before: Option<Arc<Program>>) {
        let Some(now) = self.view.program.clone() else { return };
        let kept = match (&self.selected, &before) {
            (Some(selected), Some(before)) => tree::survivor(before, &now, selected),
            _ => None,
        };
        let first = || now.tops.first().map(|&machine| now[machine].path.clone());
        self.selected = kept.or_else(first);
        self.folded.retain(|path| tree::element(&now, path).is_some());
        self.settle();
    }

    /// What runs is looked at first, until a person selects something else.
    fn first_runs(&mut self, machine: &Path) {
        if self.program().is_some_and(|program| program.machine(machine).is_some()) {
            self.select(machine.clone());
            self.settle();
        }
    }

    fn key(&mut self, event: KeyEvent) -> Vec<Effect> {
        self.message = None;
        let key = Key::from(event);
        if let Some(action) = action::of_key_always(key) {
            return self.perform(action);
        }
        match &mut self.overlay {
            Overlay::Value(_) => self.type_value(event),
            Overlay::Help { .. } => self.key_in_help(key),
            Overlay::Nothing => match action::of_key(key, self.focus) {
                Some(action) => self.perform(action),
                None => self.say(format!("{key} does nothing here; ? lists the keys")),
            },
        }
    }

    /// A sentence instead of an effect.
    fn say(&mut self, text: impl Into<String>) -> Vec<Effect> {
        self.message = Some(text.into());
        Vec::new()
    }
}
