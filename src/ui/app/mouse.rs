//! What the mouse does: it takes hold of what is drawn at a cell, and everything it does there is what a key does, too.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::movement::Move;
use super::{App, Effect, LogRow, Overlay};
use crate::model::TransitionId;
use crate::ui::action::Action;
use crate::ui::layout::{Layout, Pane};
use crate::ui::panes::{self, Target, footer};
use crate::ui::pointer::{Gesture, Mouse, Pointer};
use crate::ui::text::Text;

/// Rows that the wheel moves at once.
const WHEEL: usize = 3;

impl App {
    pub(super) fn point(&mut self, Pointer { at, gesture }: Pointer) -> Vec<Effect> {
        let Some(layout) = self.layout(self.area()) else { return Vec::new() };
        match gesture {
            Gesture::Drag => self.drag(&layout, at),
            Gesture::Release => self.dragged = None,
            Gesture::WheelUp => self.wheel(&layout, at, Move::Up),
            Gesture::WheelDown => self.wheel(&layout, at, Move::Down),
            Gesture::Click | Gesture::DoubleClick | Gesture::RightClick => return self.press(&layout, at, gesture),
        }
        Vec::new()
    }

    /// The mouse for the terminal's own selection of text, or for the screen again.
    pub(super) fn switch_mouse(&mut self) -> Vec<Effect> {
        let (mouse, said) = match self.options.settings.mouse {
            Mouse::Ours => (Mouse::Terminals, "the mouse selects text of the terminal from now on"),
            Mouse::Terminals => {
                (Mouse::Ours, "the mouse is the screen's from now on (Shift selects text in most terminals)")
            }
        };
        self.options.settings.mouse = mouse;
        self.say(said);
        vec![Effect::Mouse(mouse)]
    }

    fn press(&mut self, layout: &Layout, at: Position, gesture: Gesture) -> Vec<Effect> {
        if layout.footer.contains(at) {
            return self.press_in_footer(layout, at);
        }
        let body = body(layout);
        match &mut self.overlay {
            Overlay::Typing(_) | Overlay::Held { .. } | Overlay::Help(_) => Vec::new(),
            Overlay::Breakpoints { at: row } => {
                let there = panes::breakpoints::row_at(self.view.breakpoints.len(), *row, body, at);
                there.into_iter().for_each(|there| *row = there);
                if gesture == Gesture::DoubleClick { self.enter() } else { Vec::new() }
            }
            Overlay::Menu(menu) => match menu.row_at(at, body) {
                Some(row) => self.choose_in_menu(row),
                None => {
                    self.overlay = Overlay::Nothing;
                    Vec::new()
                }
            },
            Overlay::Palette(palette) => match panes::palette::row_at(palette, body, at) {
                Some(row) => {
                    palette.at = row;
                    self.take_offer()
                }
                None => {
                    self.overlay = Overlay::Nothing;
                    Vec::new()
                }
            },
            Overlay::Nothing => self.press_on_pane(layout, at, gesture),
        }
    }

    /// As the key that stands there.
    fn press_in_footer(&mut self, layout: &Layout, at: Position) -> Vec<Effect> {
        let mut scratch = Buffer::empty(layout.footer);
        let footer = footer::draw(self, layout.footer, &mut scratch);
        let action = footer.actions.into_iter().find(|(columns, _)| columns.contains(&at.x));
        let Some((_, action)) = action else { return Vec::new() };
        let key = self.keys().rows().filter(|(entry, _)| entry.action == action).find_map(|(_, keys)| keys.first());
        match key.copied() {
            Some(key) if action != Action::Runstop => self.key(key.into()),
            _ => self.perform(action),
        }
    }

    fn press_on_pane(&mut self, layout: &Layout, at: Position, gesture: Gesture) -> Vec<Effect> {
        self.message = None;
        self.moment = None;
        if gesture == Gesture::Click {
            self.dragged = layout.border_at(at).map(|border| border.divide);
        }
        let Some((pane, area)) = layout.pane_at(at) else { return Vec::new() };
        let target = panes::at(self, pane, area, at);
        self.focus_on(pane);
        let Some(target) = target else { return Vec::new() };
        self.take(target, at.y.saturating_sub(area.y + 1));
        match gesture {
            Gesture::DoubleClick => self.enter(),
            Gesture::RightClick => self.open_menu_at(at),
            _ => Vec::new(),
        }
    }

    /// Enter's meaning.
    fn enter(&mut self) -> Vec<Effect> {
        self.key(KeyEvent::new(KeyCode::Enter, KeyModifiers::NONE))
    }

    /// Selects what is drawn in a row of the focused pane.
    fn take(&mut self, target: Target, row: u16) {
        match target {
            Target::Element(path) => self.select(path),
            Target::Transition(id) => self.go_to_transition(id),
            Target::Value(path) => {
                self.value = Some(path);
                self.detail_anew();
            }
            Target::Log(place) => self.take_log_row(place, row),
            Target::Robot(key) => self.robot_row = Some(key),
            Target::Detail(line) => self.detail_at = line,
            Target::Text(line, offset) => self.go_to_text(line, offset),
        }
    }

    fn take_log_row(&mut self, place: LogRow, row: u16) {
        if self.reading.place.is_none() {
            self.reading.since = self.view.journal.next();
        }
        self.reading.place = Some(place);
        self.reading.row = usize::from(row);
        self.detail_anew();
    }

    /// Its line in the text is where a person is then; its name is said whole.
    fn go_to_transition(&mut self, id: TransitionId) {
        let Some(program) = self.view.program.clone() else { return };
        let span = program[id].span;
        let Some(own) = program.sources.get(usize::from(span.file.0)) else { return };
        let (number, start) = (own.line(span.start as usize), span.start as usize);
        let words = own.slice(span).split_whitespace().collect::<Vec<_>>().join(" ");
        self.message = Some(format!("{number}: {words}"));
        let text = Text::of(&self.view, span.file);
        let here = text.and_then(|text| Some((text.line_here(number)?, text.source)));
        let Some((line, source)) = here else { return };
        let offset = source.line_range(line).start + start - own.line_range(number).start;
        self.go_to_text(super::TextLine { file: span.file, line }, offset);
    }

    fn drag(&mut self, layout: &Layout, at: Position) {
        let border = layout.borders.iter().find(|border| Some(border.divide) == self.dragged);
        if let Some(border) = border {
            self.chosen.move_border(border, border.first_at(at));
        }
    }

    fn wheel(&mut self, layout: &Layout, at: Position, how: Move) {
        let rows = if how == Move::Up { -(WHEEL as isize) } else { WHEEL as isize };
        match &mut self.overlay {
            Overlay::Typing(_) => (),
            Overlay::Help(_) => (0..WHEEL).for_each(|_| self.go_in_help(how)),
            Overlay::Palette(palette) => palette.go(how, 1),
            Overlay::Held { .. } => {
                let length = panes::held::lines(self, self.options.size.width).len();
                (0..WHEEL).for_each(|_| self.scroll_overlay(how, length));
            }
            Overlay::Breakpoints { at: row } => {
                *row = how.from(Some(*row), self.view.breakpoints.len(), 1).unwrap_or(0);
            }
            Overlay::Menu(_) => self.go_in_menu(how),
            Overlay::Nothing => {
                if let Some((pane, _)) = layout.pane_at(at) {
                    self.wheel_on(pane, how, rows);
                }
            }
        }
    }

    /// The selection stays where it is, but for the log, where what is read is held.
    fn wheel_on(&mut self, pane: Pane, how: Move, rows: isize) {
        let page = self.page(pane);
        match pane {
            Pane::Machines => {
                let length = self.tree().len();
                self.tree_scroll.by(rows, length, page);
            }
            Pane::Variables => {
                let (rows_there, height) = self.values().shares(page).upper;
                self.values_scroll.by(rows, rows_there.len(), height);
            }
            Pane::Log => self.wheel_on_log(how),
            Pane::Detail => {
                let length = panes::detail::lines(self, self.columns(pane)).len();
                self.detail_scroll.by(rows, length, page);
            }
            Pane::Source => {
                let length = self.text().map_or(0, |(_, text)| text.source.line_count());
                self.source_scroll.by(rows, length, page);
            }
            Pane::Bridge => {
                let length = self.robot_rows().len();
                self.robots_scroll.by(rows, length, page);
            }
            Pane::Graph => self.pan_by(0, rows),
            Pane::World => (),
        }
    }

    /// Above the newest line nothing is held any more.
    fn wheel_on_log(&mut self, how: Move) {
        for _ in 0..WHEEL {
            let rows = self.reading.rows(&self.view);
            let is_first = self.reading.place.as_ref().is_none_or(|place| rows.first() == Some(place));
            match how {
                Move::Up if is_first => self.read_newest(),
                _ => self.go_in_log(how),
            }
        }
    }
}

/// What lies between the first line and the last.
pub(super) fn body(layout: &Layout) -> Rect {
    let height = layout.footer.y - layout.status.bottom();
    Rect { y: layout.status.bottom(), height, ..layout.status }
}
