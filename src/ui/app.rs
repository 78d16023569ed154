//! The screen as a value: records and keys go in, effects and a frame come out.
//! Knows nothing of threads, the clock or how a terminal is set up.

mod answers;
mod arranging;
mod beat;
mod breaking;
mod copying;
mod draw;
mod edited;
mod follow;
mod guide;
mod helping;
mod hindrance;
mod looking;
mod menu;
mod moment;
mod mouse;
mod movement;
mod palette;
mod perform;
mod reading;
mod robots;
mod saves;
mod scroll;
mod seeking;
mod source;
mod typing;
mod values;
mod writing;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::rc::Rc;
use std::sync::Arc;

use crossterm::event::{KeyEvent, KeyEventKind};
use ratatui::layout::Size;

pub use helping::{Help, SearchLine};
pub use looking::Nearness;
pub use movement::Move;
pub use palette::{Offer, Palette};
pub use reading::{Filter, LogRow, Reading, Shown};
pub use scroll::top_for;
pub use source::{TextLine, Written};
pub use typing::{Goal, Text, Typing};
pub use writing::WriteBack;

use self::beat::Beat;
use self::follow::Follow;
use self::looking::Looking;
use self::moment::Moment;
use self::scroll::Scroll;
use self::source::Cursor;
use super::action::Action;
use super::hints::Hints;
use super::ink::Inked;
use super::key::Key;
use super::layout::{Chosen, Divide, Extent, Figure, Pane};
use super::menu::Menu;
use super::panes::diagram::{Diagram, View as Closeness};
use super::pointer::{Mouse, Pointer};
use super::scope::Arrangement;
use super::settings::Settings;
use super::tour::Tour;
use super::view::{Choices, Origin, Path, Problem, ProblemKey, Renames, View};
use crate::model::MachineId;
use crate::runtime::command::Command;
use crate::runtime::record::{Finding, Level, Log, Record, What};

#[derive(Clone, Debug)]
pub struct Options {
    /// The program's file as the user named it.
    pub file: Arc<str>,
    /// Steps a second; 0: as fast as possible.
    pub rate: f64,
    /// At the start; a person may choose otherwise.
    pub choices: Choices,
    pub settings: Settings,
    /// Of the terminal at the start; later sizes come as events.
    pub size: Size,
}

/// What the outer loop tells of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    Key(KeyEvent),
    Pointer(Pointer),
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
    /// Files to be written; what became of it is told by `App::written`.
    WriteBack(Vec<WriteBack>),
    /// A text for the clipboard.
    Copy(String),
    /// After the robot was stopped.
    Quit,
    /// After the robot was stopped.
    Suspend,
    Redraw,
    /// Whose the mouse is from now on.
    Mouse(Mouse),
}

pub struct App {
    view: View,
    options: Options,
    focus: Pane,
    figure: Figure,
    extent: Extent,
    chosen: Chosen,
    /// What the mouse has hold of.
    dragged: Option<Divide>,
    /// The pane whose selection the detail tells of.
    subject: Pane,
    /// The machine or state a person is at.
    selected: Option<Path>,
    /// Whether that is only for want of anything that runs.
    provisional: bool,
    folded: BTreeSet<Path>,
    /// The variable or field a person is at.
    value: Option<Path>,
    /// How the variables are listed.
    arrangement: Arrangement,
    /// Values that files have, though the program that runs doesn't come from them yet.
    written: BTreeMap<Path, serde_json::Value>,
    /// What of the last writing can't be written, and why.
    refused: String,
    reading: Reading,
    follow: Follow,
    beat: Beat,
    overlay: Overlay,
    /// What was chosen by name, the last first.
    recent: Vec<&'static str>,
    /// A sentence for the person, until the next key.
    message: Option<String>,
    /// The robot was stopped outside the engine, which may not have said so yet.
    halted: bool,
    /// A number on its way to the engine, so that quick nudges add up.
    nudged: Option<(Path, serde_json::Value)>,
    /// A value that was typed and is on its way to the engine, which may refuse it.
    sent: Option<Typing>,
    /// Since the last save was taken over.
    moment: Option<Moment>,
    /// The step in which something went wrong last, and what.
    fault: Option<(u64, ProblemKey)>,
    /// The row of the robots a person is at, and which of what is seen there is listed.
    robot_row: Option<String>,
    robots_filter: String,
    robots_scroll: Scroll,
    /// The line of the detail a person is at.
    detail_at: usize,
    /// Where a person is in the program's text, if they went there.
    cursor: Option<Cursor>,
    source_left: u16,
    /// What was looked for in it last.
    sought: String,
    source_scroll: Scroll,
    tree_scroll: Scroll,
    values_scroll: Scroll,
    detail_scroll: Scroll,
    tour: Option<Tour>,
    hints: Hints,
    dirty: bool,
    looking: Looking,
    /// Those of the last frames.
    diagrams: RefCell<VecDeque<(DiagramKey, Rc<Diagram>)>>,
    inked: RefCell<Option<(Arc<str>, Rc<Inked>)>>,
}

/// What a drawing depends on: which program, which machine, how near, how much room.
type DiagramKey = (u64, MachineId, Closeness, Size);

#[derive(Clone, Debug)]
pub enum Overlay {
    Nothing,
    Help(Help),
    Typing(Typing),
    /// What the held edit would do, from this line on.
    Held {
        top: usize,
    },
    /// All breakpoints; the one a person is at.
    Breakpoints {
        at: usize,
    },
    /// What can be done with what is selected.
    Menu(Menu),
    Palette(Palette),
}

/// A command that had no effect comes back as an error from nowhere in the program.
fn is_refusal(log: &Log) -> bool {
    log.level == Level::Error && log.state.is_empty() && log.file.is_empty()
}

impl App {
    pub fn new(options: Options) -> App {
        let mut view = View::new(options.rate);
        view.choices = options.choices;
        App {
            view,
            options,
            focus: Pane::Machines,
            figure: Figure::Graph,
            extent: Extent::Shared,
            chosen: Chosen::default(),
            dragged: None,
            subject: Pane::Machines,
            selected: None,
            provisional: true,
            folded: BTreeSet::new(),
            value: None,
            arrangement: Arrangement::default(),
            written: BTreeMap::new(),
            refused: String::new(),
            reading: Reading::default(),
            follow: Follow::default(),
            beat: Beat::default(),
            overlay: Overlay::Nothing,
            recent: Vec::new(),
            message: None,
            halted: false,
            nudged: None,
            sent: None,
            moment: None,
            fault: None,
            robot_row: None,
            robots_filter: String::new(),
            robots_scroll: Scroll::default(),
            detail_at: 0,
            cursor: None,
            source_left: 0,
            sought: String::new(),
            source_scroll: Scroll::default(),
            tree_scroll: Scroll::default(),
            values_scroll: Scroll::default(),
            detail_scroll: Scroll::default(),
            tour: None,
            hints: Hints::default(),
            dirty: true,
            looking: Looking::default(),
            diagrams: RefCell::default(),
            inked: RefCell::new(None),
        }
    }

    pub fn record(&mut self, record: &Record) {
        let before = match &record.what {
            What::Load(_) => self.view.program.clone(),
            _ => None,
        };
        self.view.apply(record);
        match &record.what {
            What::Load(load) => {
                self.rename(&Renames::of(&load.changes));
                self.program_changed(before);
                self.saved();
            }
            What::Spawn { machine, by: None } if self.provisional => self.first_runs(machine),
            What::Enter { state } => self.entered(record.step, state),
            What::Set { var, by, .. } => self.was_set(var, by),
            What::Breakpoints { .. } => self.breakpoints_changed(),
            What::Error(fault) => self.fault = Some((record.step, ProblemKey::of(fault))),
            What::Pause { reason, at } => self.paused(record.step, reason, at.as_ref()),
            What::Resume => self.halted = false,
            What::Reject { .. } => self.settle(),
            What::Status { .. } => self.half_a_second(),
            What::Log(log) if is_refusal(log) => {
                self.message = Some(log.message.clone());
                self.nudged = None;
                self.type_again();
            }
            _ => (),
        }
        if let Some(tour) = &mut self.tour {
            tour.record(record, &self.view);
        }
        self.beat();
        self.dirty = true;
    }

    pub fn event(&mut self, event: Event) -> Vec<Effect> {
        let effects = match event {
            Event::Key(key) if key.kind == KeyEventKind::Release => return Vec::new(),
            Event::Key(key) => self.key(key),
            Event::Pointer(pointer) => self.point(pointer),
            Event::Resize(size) => {
                self.options.size = size;
                Vec::new()
            }
        };
        self.settle();
        self.reconsider_hint();
        self.beat_now();
        self.dirty = true;
        effects
    }

    /// What is wrong with the person's configuration is told with what is wrong with the program.
    pub fn found_in_config(&mut self, findings: &[Finding]) {
        let now = self.view.t;
        let problem = |finding| Problem::from_finding(finding, Origin::Config, now);
        self.view.problems.extend(findings.iter().map(problem));
        self.dirty = true;
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

    fn was_set(&mut self, var: &Path, by: &Path) {
        if **by == *"command" && self.sent.as_ref().is_some_and(|typing| typing.goal.is_value_of(var)) {
            self.sent = None;
        }
        if self.nudged.as_ref().is_some_and(|(path, _)| path == var) {
            self.nudged = None;
        }
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
        self.moment = None;
        let key = Key::from(event);
        if let Some(action) = self.keys().action_always(key) {
            return self.perform(action);
        }
        match &mut self.overlay {
            Overlay::Typing(_) => self.type_on(event),
            Overlay::Help(_) => self.key_in_help(event),
            Overlay::Held { .. } => self.key_in_held(key),
            Overlay::Breakpoints { .. } => self.key_in_breakpoints(key),
            Overlay::Menu(_) => self.key_in_menu(key),
            Overlay::Palette(_) => self.key_in_palette(event),
            Overlay::Nothing => match self.keys().action(key, self.focus) {
                Some(action) => self.perform(action),
                None => self.say(format!("{key} does nothing here; {} lists the keys", self.keys().name(Action::Help))),
            },
        }
    }

    /// A sentence instead of an effect.
    fn say(&mut self, text: impl Into<String>) -> Vec<Effect> {
        self.message = Some(text.into());
        Vec::new()
    }
}
