//! What each action does: to the screen itself, or as an effect outside.

use super::arranging::Resize;
use super::movement::Move;
use super::values::Nudge;
use super::{App, Effect, Help, LogRow, Overlay};
use crate::runtime::command::Command;
use crate::syntax::Span;
use crate::ui::action::Action;
use crate::ui::layout::{Extent, Figure, Pane, Way};
use crate::ui::tree::{self, Element};
use crate::ui::view::{Mode, Path};

/// What + and - go through, steps a second; above them is as fast as possible.
const RATES: [f64; 13] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];

impl App {
    pub(super) fn perform(&mut self, action: Action) -> Vec<Effect> {
        self.noticed(action);
        if let Some(why) = self.hindrance(action) {
            return self.say(why);
        }
        match action {
            Action::Runstop => return command(Command::Runstop),
            Action::Pause => return command(self.pause_or_run()),
            Action::Step => return self.step(),
            Action::Faster => return command(Command::Rate { hz: faster(self.view.rate) }),
            Action::Slower => return command(Command::Rate { hz: slower(self.view.rate) }),
            Action::Restart => return command(Command::Restart),
            Action::TransitionTo => return self.send_to(|state| Command::TransitionTo { state }),
            Action::JumpTo => return self.send_to(|state| Command::JumpTo { state }),
            Action::PutAtStart => return self.put_at_start(),
            Action::EditValue => return self.begin_typing(),
            Action::Increase => return self.nudge(Nudge::Up),
            Action::Decrease => return self.nudge(Nudge::Down),
            Action::IncreaseMuch => return self.nudge(Nudge::FarUp),
            Action::DecreaseMuch => return self.nudge(Nudge::FarDown),
            Action::WriteBack => return self.write_selected(),
            Action::WriteAll => return self.write_all(),
            Action::Reset => return self.reset(),
            Action::Pin => return self.pin(),
            Action::Search => return self.search(),
            Action::Tell => return self.tell(),
            Action::SwitchOnEdit => return self.switch_on_edit(),
            Action::SwitchSaves => return self.switch_saves(),
            Action::ApplyHeld => return self.decide_held(Command::ApplyHeld),
            Action::DropHeld => return self.decide_held(Command::DropHeld),
            Action::GiveBack => return self.give_back(),
            Action::ToggleBreakpoint => return self.toggle_breakpoint(),
            Action::BreakWhen => return self.ask_for_condition(),
            Action::SwitchOnError => return self.switch_on_error(),
            Action::OpenEditor => return self.open_editor(),
            Action::Copy => return self.copy(),
            Action::Find => return self.ask_for_words(),
            Action::FindNext => return self.find(Way::On),
            Action::FindPrevious => return self.find(Way::Back),
            Action::Menu => return self.open_menu(),
            Action::SwitchMouse => return self.switch_mouse(),
            Action::Hide => return self.hide(),
            Action::ShowAll => return self.show_all(),
            Action::Narrower => return self.resize(Resize::Narrower),
            Action::Wider => return self.resize(Resize::Wider),
            Action::Shorter => return self.resize(Resize::Shorter),
            Action::Taller => return self.resize(Resize::Taller),
            Action::TourNext => return self.next_task(),
            Action::TourStrip => return self.toggle_strip(),
            Action::Quit => return vec![Effect::Quit],
            Action::Suspend => return vec![Effect::Suspend],
            Action::Redraw => return vec![Effect::Redraw],
            Action::Into => self.go_into(),
            Action::OutOf => self.go_out(),
            Action::Fold => self.fold(),
            Action::Unfold => self.unfold(),
            Action::Follow => self.toggle_follow(),
            Action::Nearness => self.look_otherwise(),
            Action::PanLeft | Action::PanRight | Action::PanUp | Action::PanDown => self.pan(action),
            Action::NextBeside => self.next_beside(),
            Action::NextPane => self.next_pane(1),
            Action::PreviousPane => self.next_pane(-1),
            Action::Focus(pane) => self.focus_on(pane),
            Action::Up | Action::Down | Action::PageUp | Action::PageDown | Action::First | Action::Last => {
                Move::of(action).into_iter().for_each(|how| self.go(how));
            }
            Action::ToggleWorld => self.toggle(Figure::World),
            Action::ToggleSource => self.toggle(Figure::Source),
            Action::ToggleRobots => self.toggle(Figure::Bridge),
            Action::ScrollLeft => self.scroll_left(),
            Action::ScrollRight => self.scroll_right(),
            Action::Inspect => self.toggle(Figure::Detail),
            Action::WhyNot => self.why_not(),
            Action::Zoom => self.zoom(),
            Action::Filter => self.reading.filter = self.reading.filter.next(),
            Action::OnlyMachine => self.read_only_machine(),
            Action::Back => self.back(),
            Action::HeldEdit => self.overlay = Overlay::Held { top: 0 },
            Action::Breakpoints => self.overlay = Overlay::Breakpoints { at: 0 },
            Action::Palette => self.open_palette(),
            Action::Help => self.overlay = Overlay::Help(Help::default()),
        }
        Vec::new()
    }

    fn pause_or_run(&self) -> Command {
        match self.view.mode {
            Mode::Running if !self.halted => Command::Pause,
            _ => Command::Resume,
        }
    }

    fn step(&mut self) -> Vec<Effect> {
        match self.view.mode {
            Mode::Running => vec![Effect::Command(Command::Pause)],
            Mode::Waiting { .. } => vec![Effect::Command(Command::Resume)],
            Mode::Paused { .. } | Mode::Stopped => vec![Effect::Command(Command::Step)],
        }
    }

    fn send_to(&self, to: impl Fn(String) -> Command) -> Vec<Effect> {
        self.selected.iter().flat_map(|path| command(to(path.to_string()))).collect()
    }

    fn put_at_start(&self) -> Vec<Effect> {
        let bridges = self.view.world.iter().map(|world| world.bridge.to_string());
        bridges.flat_map(|bridge| command(Command::PutAtStart { bridge })).collect()
    }

    pub(super) fn selected_element(&self) -> Option<(Path, Element)> {
        let path = self.selected.clone()?;
        let element = tree::element(self.program()?, &path)?;
        Some((path, element))
    }

    /// A figure that is seen already is gone to; one that isn't takes the place of the drawing, or gives it back.
    fn toggle(&mut self, figure: Figure) {
        let pane = figure.pane();
        if self.focus == pane
            || (self.figure == figure && !self.chosen.hides(pane) && !self.is_beside_the_drawing(pane))
        {
            return self.leave_figure();
        }
        self.figure = figure;
        self.chosen.show(pane);
        if Figure::of(self.focus).is_some() || self.is_beside_the_drawing(pane) || self.page(pane) <= 1 {
            self.focus_on(pane);
        }
    }

    /// The detail of the state, whatever else it tells of now.
    fn why_not(&mut self) {
        let tells_of_other = matches!(self.subject, Pane::Variables | Pane::Log);
        self.take_as_subject(Pane::Machines);
        if !(tells_of_other && self.shows_detail()) {
            self.toggle(Figure::Detail);
        }
    }

    /// Back to the drawing; where it has no place of its own, to the machines.
    pub(super) fn leave_figure(&mut self) {
        self.figure = Figure::Graph;
        if Figure::of(self.focus).is_some() {
            self.focus = Pane::Graph;
            let shared = self.seen_without_focus().contains(&Pane::Graph);
            self.focus_on(if shared { self.subject } else { Pane::Machines });
        }
    }

    fn is_beside_the_drawing(&self, pane: Pane) -> bool {
        let seen = self.seen_without_focus();
        seen.contains(&pane) && seen.contains(&Pane::Graph)
    }

    fn zoom(&mut self) {
        self.extent = match self.extent {
            Extent::Shared => Extent::Alone,
            Extent::Alone => Extent::Shared,
        };
    }

    fn back(&mut self) {
        if self.extent == Extent::Alone {
            self.extent = Extent::Shared;
        } else if self.focus == Pane::Variables && !self.arrangement.filter.is_empty() {
            self.arrangement.filter.clear();
        } else if self.reading.place.is_some() && self.focus == Pane::Log {
            self.read_newest();
        } else if self.focus == Pane::Log && !self.reading.text.is_empty() {
            self.reading.text.clear();
        } else if self.figure != Figure::Graph || Figure::of(self.focus).is_some() {
            self.leave_figure();
        }
    }

    fn open_editor(&mut self) -> Vec<Effect> {
        let way = Some(Pane::Detail).filter(|&pane| pane == self.focus).and_then(|_| self.transition_in_detail());
        let place = match self.subject {
            _ if self.focus == Pane::Source || self.transition_is_drawn() => self.place_in_text(),
            _ if way.is_some() => way.and_then(|id| self.place(self.program()?[id].span)),
            Pane::Variables => self.place_of_value(),
            Pane::Log => self.place_of_log(),
            _ => self.place_of_element(),
        };
        match place {
            Some((file, line, column)) => vec![Effect::OpenEditor { file, line, column }],
            None => self.say("what is selected has no line in a file"),
        }
    }

    pub(super) fn place_of_element(&self) -> Option<(Path, usize, usize)> {
        let program = self.program()?;
        let (_, element) = self.selected_element()?;
        self.place(match element {
            Element::Machine(machine) => program[machine].name_span,
            Element::State(state) => program[state].name_span,
        })
    }

    /// A person took hold of a transition in the drawing.
    fn transition_is_drawn(&self) -> bool {
        self.focus == Pane::Graph && self.transition_in_text().is_some()
    }

    fn place_in_text(&self) -> Option<(Path, usize, usize)> {
        let (line, text) = self.text()?;
        Some((text.source.name.clone(), line.line, 1))
    }

    pub(super) fn place_of_value(&self) -> Option<(Path, usize, usize)> {
        let program = self.program()?;
        self.place(program[program.var(self.value.as_ref()?)?].name_span)
    }

    /// Of the selected line; without one, of the first problem.
    pub(super) fn place_of_log(&self) -> Option<(Path, usize, usize)> {
        let first = || self.view.problems.first().map(|problem| LogRow::Problem(problem.key.clone()));
        match self.reading.place.clone().or_else(first)? {
            LogRow::Problem(key) => (key.line > 0).then(|| (key.file, key.line, key.column.max(1))),
            LogRow::Entry(number) => {
                let (file, line) = self.view.journal.get(number)?.place.clone()?;
                Some((file, line, 1))
            }
        }
    }

    fn place(&self, span: Span) -> Option<(Path, usize, usize)> {
        let source = self.program()?.sources.get(usize::from(span.file.0))?;
        let position = source.position(span.start as usize);
        Some((source.name.clone(), position.line, position.column))
    }
}

fn command(command: Command) -> Vec<Effect> {
    vec![Effect::Command(command)]
}

fn faster(rate: f64) -> f64 {
    let above = RATES.into_iter().find(|&step| step > rate * 1.001);
    if rate == 0.0 { 0.0 } else { above.unwrap_or(0.0) }
}

fn slower(rate: f64) -> f64 {
    let last = RATES[RATES.len() - 1];
    let below = RATES.into_iter().rev().find(|&step| step < rate * 0.999);
    if rate == 0.0 { last } else { below.unwrap_or(RATES[0]) }
}
