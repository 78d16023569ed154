//! What a person does with the mouse, as the screen needs it: clicks counted, drags, the wheel. Knows nothing of what lies where.

use std::time::{Duration, Instant};

use crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Position;

/// Whose the mouse is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mouse {
    /// The screen's: the terminal tells of clicks.
    #[default]
    Ours,
    /// The terminal's, which selects text with it.
    Terminals,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pointer {
    pub at: Position,
    pub gesture: Gesture,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    Click,
    /// Its second click; the first has been told of.
    DoubleClick,
    RightClick,
    /// The left button is down.
    Drag,
    Release,
    WheelUp,
    WheelDown,
}

/// Longer than this after a click another one is a first one.
const SECOND: Duration = Duration::from_millis(400);

/// Counts clicks.
#[derive(Debug, Default)]
pub struct Hand {
    /// The click that the next one may double.
    first: Option<(Position, Instant)>,
}

impl Hand {
    /// None where it is nothing to the screen.
    pub fn read(&mut self, event: MouseEvent, now: Instant) -> Option<Pointer> {
        let at = Position::new(event.column, event.row);
        let gesture = match event.kind {
            MouseEventKind::Down(MouseButton::Left) => self.click(at, now),
            MouseEventKind::Down(MouseButton::Right) => Gesture::RightClick,
            MouseEventKind::Drag(MouseButton::Left) => Gesture::Drag,
            MouseEventKind::Up(MouseButton::Left) => Gesture::Release,
            MouseEventKind::ScrollUp => Gesture::WheelUp,
            MouseEventKind::ScrollDown => Gesture::WheelDown,
            _ => return None,
        };
        if !matches!(gesture, Gesture::Click | Gesture::Release) {
            self.first = None;
        }
        Some(Pointer { at, gesture })
    }

    fn click(&mut self, at: Position, now: Instant) -> Gesture {
        match self.first.take() {
            Some((place, then)) if place == at && now.duration_since(then) <= SECOND => Gesture::DoubleClick,
            _ => {
                self.first = Some((at, now));
                Gesture::Click
            }
        }
    }
}
