//! Every colour and weight on the screen, each for a meaning. Only the terminal's own 16 colours, so that its palette decides.

use ratatui::style::{Color, Modifier, Style};

use super::graph::EdgeKind;
use super::view::{Gravity, Mode};
use crate::runtime::record::{Health, Level};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    Colours,
    /// `NO_COLOR`: weight alone tells.
    Plain,
}

impl Theme {
    /// What a person asked for in the environment: `NO_COLOR`, set and not empty, means no colours.
    pub fn from_no_color(value: Option<&str>) -> Theme {
        match value {
            None | Some("") => Theme::Colours,
            Some(_) => Theme::Plain,
        }
    }

    pub fn normal(self) -> Style {
        Style::new()
    }

    pub fn dim(self) -> Style {
        Style::new().add_modifier(Modifier::DIM)
    }

    pub fn bold(self) -> Style {
        Style::new().add_modifier(Modifier::BOLD)
    }

    pub fn rule(self) -> Style {
        self.dim()
    }

    pub fn title(self) -> Style {
        self.dim()
    }

    pub fn focused_title(self) -> Style {
        self.bold()
    }

    /// The row a person is at, in the pane with the focus.
    pub fn selected(self) -> Style {
        Style::new().add_modifier(Modifier::REVERSED)
    }

    pub fn active(self) -> Style {
        self.bold().patch(self.colour(Color::Green))
    }

    pub fn fresh(self) -> Style {
        self.bold().patch(self.colour(Color::Yellow))
    }

    /// Set by hand, and no file has it.
    pub fn unwritten(self) -> Style {
        self.colour(Color::Yellow)
    }

    pub fn stop(self) -> Style {
        self.bold().patch(self.colour(Color::Red))
    }

    /// Where the program will pause.
    pub fn breakpoint(self) -> Style {
        self.colour(Color::Red)
    }

    /// An edit that waits to be taken over.
    pub fn held(self) -> Style {
        self.bold().patch(self.colour(Color::LightBlue))
    }

    pub fn key(self) -> Style {
        self.bold()
    }

    pub fn mode(self, mode: &Mode) -> Style {
        let colour = match mode {
            Mode::Running => Color::Green,
            Mode::Paused { .. } => Color::Yellow,
            Mode::Stopped => Color::Red,
        };
        let weight = Modifier::BOLD | Modifier::REVERSED;
        self.colour(colour).add_modifier(weight)
    }

    pub fn health(self, health: Option<Health>) -> Style {
        match health {
            None => self.dim(),
            Some(Health::Up) => self.colour(Color::Green),
            Some(Health::Connecting) => self.colour(Color::Yellow),
            Some(Health::Lost) => self.stop(),
        }
    }

    pub fn transition(self, kind: EdgeKind) -> Style {
        self.colour(match kind {
            EdgeKind::On | EdgeKind::Exit => Color::LightBlue,
            EdgeKind::Eps => Color::Green,
            EdgeKind::Ontime => Color::Yellow,
            EdgeKind::Wildcard => Color::Magenta,
        })
    }

    pub fn gravity(self, gravity: Gravity) -> Style {
        match gravity {
            Gravity::Error => self.stop(),
            Gravity::Warning => self.colour(Color::Yellow),
            Gravity::Hint => self.dim(),
        }
    }

    pub fn level(self, level: Level) -> Style {
        match level {
            Level::Error => self.stop(),
            Level::Warn => self.colour(Color::Yellow),
            Level::Info => self.normal(),
            Level::Debug => self.dim(),
        }
    }

    /// The painted line and the robot of a world.
    pub fn robot(self) -> Style {
        self.bold().patch(self.colour(Color::Cyan))
    }

    pub fn trail(self) -> Style {
        self.colour(Color::Cyan).add_modifier(Modifier::DIM)
    }

    pub fn wall(self) -> Style {
        self.dim()
    }

    fn colour(self, colour: Color) -> Style {
        match self {
            Theme::Colours => Style::new().fg(colour),
            Theme::Plain => Style::new(),
        }
    }
}
