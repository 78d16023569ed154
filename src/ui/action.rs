//! The one table of what a person can do: the key map, the footer, the help and docs/keys.md are all made from it.

use super::key::Key;
use super::layout::Pane;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    Runstop,
    Pause,
    Step,
    Faster,
    Slower,
    Restart,
    TransitionTo,
    JumpTo,
    PutAtStart,
    Tell,
    ToggleRobots,
    EditValue,
    Increase,
    Decrease,
    IncreaseMuch,
    DecreaseMuch,
    WriteBack,
    WriteAll,
    Reset,
    Pin,
    Search,
    Into,
    OutOf,
    Fold,
    Unfold,
    SwitchOnEdit,
    SwitchSaves,
    HeldEdit,
    ApplyHeld,
    DropHeld,
    GiveBack,
    ToggleBreakpoint,
    BreakWhen,
    Breakpoints,
    SwitchOnError,
    OpenEditor,
    Inspect,
    WhyNot,
    Follow,
    NextBeside,
    Nearness,
    PanLeft,
    PanRight,
    PanUp,
    PanDown,
    NextPane,
    PreviousPane,
    Focus(Pane),
    Up,
    Down,
    PageUp,
    PageDown,
    First,
    Last,
    ToggleWorld,
    ToggleSource,
    ScrollLeft,
    ScrollRight,
    Find,
    FindNext,
    FindPrevious,
    Menu,
    SwitchMouse,
    Hide,
    ShowAll,
    Narrower,
    Wider,
    Shorter,
    Taller,
    Zoom,
    Filter,
    OnlyMachine,
    Copy,
    Back,
    Help,
    TourNext,
    TourStrip,
    Palette,
    Quit,
    Suspend,
    Redraw,
}

/// Where its keys work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Everywhere, also in the help and while a value is typed.
    Always,
    /// In every pane.
    Screen,
    Panes(&'static [Pane]),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    Robot,
    Program,
    Edits,
    Breaks,
    Values,
    Moving,
    Looking,
    Lrp,
}

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub action: Action,
    /// For configuration: lower case with hyphens.
    pub id: &'static str,
    /// Unless a person has others.
    pub keys: &'static [&'static str],
    /// For the footer; empty where it isn't shown there.
    pub label: &'static str,
    /// One line without a full stop.
    pub help: &'static str,
    pub group: Group,
    pub reach: Reach,
}

const STATES: Reach = Reach::Panes(&[Pane::Machines, Pane::Graph]);
/// Where a state can be selected.
const PLACES: Reach = Reach::Panes(&[Pane::Machines, Pane::Graph, Pane::Source]);
const SOURCE: Reach = Reach::Panes(&[Pane::Source]);
const GRAPH: Reach = Reach::Panes(&[Pane::Graph]);
const TREE: Reach = Reach::Panes(&[Pane::Machines]);
const VALUES: Reach = Reach::Panes(&[Pane::Variables]);
const LINES: Reach = Reach::Panes(&[Pane::Log, Pane::Source]);
const ROBOTS: Reach = Reach::Panes(&[Pane::Bridge]);
/// What can be searched.
const LISTS: Reach = Reach::Panes(&[Pane::Variables, Pane::Bridge, Pane::Log]);
const LOG: Reach = Reach::Panes(&[Pane::Log]);

macro_rules! table {
    ($($action:expr, $id:literal, [$($key:literal),*], $label:literal, $help:literal, $group:ident, $reach:expr;)*) => {
        /// In the order of the help; the footer shows what has a label, first what belongs to the focused pane.
        pub const TABLE: &[Entry] = &[$(Entry {
            action: $action, id: $id, keys: &[$($key),*], label: $label, help: $help,
            group: Group::$group, reach: $reach,
        },)*];
    };
}

table! {
    Action::Runstop, "runstop", ["!"], "STOP", "stop the robot at once", Robot, Reach::Screen;
    Action::Runstop, "runstop-always", ["Ctrl-X"], "", "stop the robot at once, also while typing", Robot, Reach::Always;
    Action::PutAtStart, "put-at-start", ["b"], "", "put the simulated robot back at its start", Robot, Reach::Screen;
    Action::Tell, "tell", ["Enter", "e"], "send", "send by hand; or write what is seen there into the program", Robot, ROBOTS;

    Action::Pause, "pause", ["Space"], "pause", "pause, or run on", Program, Reach::Screen;
    Action::Step, "step", ["s"], "step", "make one step; while it runs, pause", Program, Reach::Screen;
    Action::Faster, "faster", ["+", "="], "", "more steps a second", Program, Reach::Screen;
    Action::Slower, "slower", ["-"], "", "fewer steps a second", Program, Reach::Screen;
    Action::TransitionTo, "transition-to", ["t"], "go to state", "go to the selected state: its actions run", Program, PLACES;
    Action::JumpTo, "jump-to", ["J"], "jump", "jump to the selected state: no action runs", Program, PLACES;
    Action::Restart, "restart", ["Ctrl-R"], "", "restart the program from scratch", Program, Reach::Screen;

    Action::SwitchOnEdit, "on-edit", ["M"], "", "edits of active states: restart, or keep", Edits, Reach::Screen;
    Action::SwitchSaves, "saves", ["S"], "", "hold saves until applied, or no more", Edits, Reach::Screen;
    Action::ApplyHeld, "apply-held", ["A"], "apply", "apply the held edit", Edits, Reach::Screen;
    Action::DropHeld, "drop-held", ["X"], "drop", "drop the held edit", Edits, Reach::Screen;
    Action::HeldEdit, "held-edit", ["E"], "show", "what the held edit would do, and back", Edits, Reach::Screen;
    Action::GiveBack, "give-back", ["u"], "tuned", "set values again that an edit took", Edits, Reach::Screen;

    Action::ToggleBreakpoint, "breakpoint", ["B"], "", "pause at what is selected, or no more", Breaks, Reach::Screen;
    Action::BreakWhen, "break-when", ["C"], "", "pause when what you type becomes true", Breaks, Reach::Screen;
    Action::Breakpoints, "breakpoints", ["D"], "", "all breakpoints, to clear them", Breaks, Reach::Screen;
    Action::SwitchOnError, "on-error", ["P"], "", "pause when something goes wrong, or go on", Breaks, Reach::Screen;

    Action::EditValue, "edit-value", ["e", "Enter"], "edit", "type a value: any Lua expression", Values, VALUES;
    Action::Increase, "increase", ["Right", "l", ">"], "more", "a little more; tables open, booleans turn", Values, VALUES;
    Action::Decrease, "decrease", ["Left", "h", "<"], "less", "a little less; tables close, booleans turn", Values, VALUES;
    Action::IncreaseMuch, "increase-much", ["Shift-Right", "L"], "", "much more", Values, VALUES;
    Action::DecreaseMuch, "decrease-much", ["Shift-Left", "H"], "", "much less", Values, VALUES;
    Action::WriteBack, "write-back", ["w"], "write back", "into the file as its initial value", Values, VALUES;
    Action::WriteAll, "write-all", ["W"], "", "all values marked * into their files", Values, Reach::Screen;
    Action::Reset, "reset", ["r"], "reset", "the initial value again", Values, VALUES;
    Action::Pin, "pin", ["p"], "pin", "keep it on top, or no more", Values, VALUES;
    Action::Search, "search", ["/"], "find", "only what has this in its name or words; Esc shows all", Values, LISTS;

    Action::Up, "up", ["Up", "k"], "", "the row above", Moving, Reach::Screen;
    Action::Down, "down", ["Down", "j"], "", "the row below", Moving, Reach::Screen;
    Action::PageUp, "page-up", ["PgUp"], "", "a page up", Moving, Reach::Screen;
    Action::PageDown, "page-down", ["PgDn"], "", "a page down", Moving, Reach::Screen;
    Action::First, "first", ["Home", "g"], "", "the first row; in the log the newest", Moving, Reach::Screen;
    Action::Last, "last", ["End", "G"], "", "the last row", Moving, Reach::Screen;
    Action::Into, "into", ["Enter"], "", "into the nested machine", Moving, STATES;
    Action::OutOf, "out-of", ["Backspace"], "", "out to the enclosing state", Moving, PLACES;
    Action::Unfold, "unfold", ["Right", "l"], "", "show what is inside", Moving, TREE;
    Action::Fold, "fold", ["Left", "h"], "", "hide what is inside, then go out", Moving, TREE;
    Action::ScrollLeft, "scroll-left", ["Left", "h"], "", "what is left of the text seen", Moving, SOURCE;
    Action::ScrollRight, "scroll-right", ["Right", "l"], "", "what is right of the text seen", Moving, SOURCE;
    Action::Find, "find", ["/"], "find", "words in the text", Moving, SOURCE;
    Action::FindNext, "find-next", ["n"], "", "the next line with these words", Moving, SOURCE;
    Action::FindPrevious, "find-previous", ["N"], "", "the line before with these words", Moving, SOURCE;
    Action::Follow, "follow", ["f"], "", "follow the innermost change, or hold still", Moving, Reach::Screen;
    Action::NextBeside, "next-beside", ["."], "", "the next of the machines that run beside each other", Moving, STATES;
    Action::PanLeft, "pan-left", ["Left", "h"], "", "move the drawing to see more on its left", Moving, GRAPH;
    Action::PanRight, "pan-right", ["Right", "l"], "", "move the drawing to see more on its right", Moving, GRAPH;
    Action::PanUp, "pan-up", ["Shift-Up"], "", "move the drawing to see more above", Moving, GRAPH;
    Action::PanDown, "pan-down", ["Shift-Down"], "", "move the drawing to see more below", Moving, GRAPH;

    Action::NextPane, "next-pane", ["Tab"], "", "the next pane", Looking, Reach::Screen;
    Action::PreviousPane, "previous-pane", ["Shift-Tab"], "", "the pane before", Looking, Reach::Screen;
    Action::Focus(Pane::Machines), "machines", ["1"], "", "the machines", Looking, Reach::Screen;
    Action::Focus(Pane::Graph), "graph", ["2"], "", "the drawing of the selected machine", Looking, Reach::Screen;
    Action::Focus(Pane::Variables), "variables", ["3"], "", "the variables", Looking, Reach::Screen;
    Action::Focus(Pane::Log), "log", ["4"], "", "the log", Looking, Reach::Screen;
    Action::Focus(Pane::World), "world", ["5"], "", "the simulated world", Looking, Reach::Screen;
    Action::Focus(Pane::Source), "source", ["6"], "", "the program's text", Looking, Reach::Screen;
    Action::Focus(Pane::Bridge), "robots", ["7"], "", "the robots: what comes and goes, calls, devices", Looking, Reach::Screen;
    Action::WhyNot, "why-not", ["y"], "why", "why not: what each way out of the state waits for, and back", Looking, Reach::Screen;
    Action::ToggleWorld, "toggle-world", ["w"], "world", "the world for the drawing, and back", Looking, Reach::Screen;
    Action::ToggleSource, "toggle-source", ["c"], "source", "the program's text for the drawing, and back", Looking, Reach::Screen;
    Action::ToggleRobots, "toggle-robots", ["R"], "", "the robots for the drawing, and back", Looking, Reach::Screen;
    Action::Inspect, "inspect", ["i"], "inspect", "all about what is selected, and back", Looking, Reach::Screen;
    Action::Nearness, "nearness", ["d"], "", "the drawing: as it fits, boxes, a table, around the state", Looking, Reach::Screen;
    Action::Zoom, "zoom", ["z"], "", "the focused pane alone, and back", Looking, Reach::Screen;
    Action::Menu, "menu", ["a"], "menu", "what can be done with what is selected", Looking, Reach::Screen;
    Action::Narrower, "narrower", ["[", "Alt-Left"], "", "the focused pane narrower", Looking, Reach::Screen;
    Action::Wider, "wider", ["]", "Alt-Right"], "", "the focused pane wider", Looking, Reach::Screen;
    Action::Shorter, "shorter", ["{", "Alt-Up"], "", "the focused pane shorter", Looking, Reach::Screen;
    Action::Taller, "taller", ["}", "Alt-Down"], "", "the focused pane taller", Looking, Reach::Screen;
    Action::Hide, "hide", ["x"], "", "hide the focused pane; its key shows it again", Looking, Reach::Screen;
    Action::ShowAll, "show-all", ["0"], "", "all panes, as large as usual", Looking, Reach::Screen;
    Action::Filter, "filter", ["v"], "filter", "the log: all, transitions, the rest, warnings, errors", Looking, LOG;
    Action::OnlyMachine, "only-machine", ["m"], "", "the log: only the selected machine, or all", Looking, LOG;
    Action::OpenEditor, "open-editor", ["o"], "open", "open your editor at the selected line", Looking, Reach::Screen;
    Action::OpenEditor, "open-editor-at-log", ["Enter"], "", "open your editor at the line", Looking, LINES;
    Action::Copy, "copy", ["Y"], "", "to the clipboard: the path, value, line or detail selected", Looking, Reach::Screen;
    Action::Back, "back", ["Esc"], "", "leave: typing, help, full screen, detail", Looking, Reach::Screen;

    Action::Palette, "palette", [":", "Ctrl-P"], "", "all that can be done or gone to, by name", Lrp, Reach::Screen;
    Action::Help, "help", ["?"], "help", "this help", Lrp, Reach::Screen;
    Action::TourNext, "tour-next", ["n"], "", "the tour: skip this task; at its end, take up what was skipped", Lrp, Reach::Screen;
    Action::TourStrip, "tour-strip", ["N"], "", "the tour: its strip away, and back", Lrp, Reach::Screen;
    Action::Quit, "quit", ["q"], "", "stop the robot and quit", Lrp, Reach::Screen;
    Action::Quit, "quit-always", ["Ctrl-C"], "", "stop the robot and quit, also while typing", Lrp, Reach::Always;
    Action::Suspend, "suspend", ["Ctrl-Z"], "", "stop the robot and go to the shell", Lrp, Reach::Always;
    Action::SwitchMouse, "mouse", ["T"], "", "the mouse for lrp, or to select the terminal's text", Lrp, Reach::Screen;
    Action::Redraw, "redraw", ["Ctrl-L"], "", "draw the screen afresh", Lrp, Reach::Always;
}

impl Group {
    pub const ALL: [Group; 8] = [
        Group::Robot,
        Group::Program,
        Group::Edits,
        Group::Breaks,
        Group::Values,
        Group::Moving,
        Group::Looking,
        Group::Lrp,
    ];

    pub fn title(self) -> &'static str {
        match self {
            Group::Robot => "The robot",
            Group::Program => "The program",
            Group::Edits => "Edits",
            Group::Breaks => "Breakpoints (a transition: in the log or the detail)",
            Group::Values => "Values (in the variables; *: only set by hand)",
            Group::Moving => "Moving about",
            Group::Looking => "What is on the screen",
            Group::Lrp => "lrp",
        }
    }

    pub fn entries(self) -> impl Iterator<Item = &'static Entry> {
        TABLE.iter().filter(move |entry| entry.group == self)
    }
}

impl Entry {
    pub fn works_in(&self, pane: Pane) -> bool {
        match self.reach {
            Reach::Always | Reach::Screen => true,
            Reach::Panes(panes) => panes.contains(&pane),
        }
    }

    /// Whether the two can't have the same key. A pane may have its own use for a key that means something else in the
    /// others, but not for the runstop's.
    pub fn clashes_with(&self, other: &Entry) -> bool {
        if self.action == other.action {
            return false;
        }
        match (self.reach, other.reach) {
            _ if self.action == Action::Runstop || other.action == Action::Runstop => true,
            (Reach::Panes(panes), Reach::Panes(others)) => panes.iter().any(|pane| others.contains(pane)),
            (Reach::Panes(_), Reach::Screen) | (Reach::Screen, Reach::Panes(_)) => false,
            _ => true,
        }
    }

    /// A test reads them all.
    pub fn default_keys(&self) -> Vec<Key> {
        self.keys.iter().filter_map(|text| text.parse().ok()).collect()
    }
}

/// The first row that does this.
pub fn entry(action: Action) -> Option<&'static Entry> {
    TABLE.iter().find(|entry| entry.action == action)
}

impl Reach {
    /// In words: `machines, graph`
    pub fn place(self) -> String {
        match self {
            Reach::Always => "everywhere, also while typing".into(),
            Reach::Screen => "every pane".into(),
            Reach::Panes(panes) => panes.iter().map(|pane| pane.title()).collect::<Vec<_>>().join(", "),
        }
    }
}
