//! Every colour and weight on the screen, each for a meaning. Only the terminal's own 16 colours, so that its palette decides.

use ratatui::style::{Color, Modifier, Style};

use super::graph::EdgeKind;
use super::view::{Gravity, Mode};
use crate::runtime::record::{Health, Level};

/// What the colours have to be read on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Palette {
    #[default]
    Dark,
    Light,
    /// No colours: weight alone tells.
    Mono,
}

impl Palette {
    pub fn named(name: &str) -> Option<Palette> {
        match name {
            "dark" => Some(Palette::Dark),
            "light" => Some(Palette::Light),
            "mono" => Some(Palette::Mono),
            _ => None,
        }
    }
}

/// What a style means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Rule,
    Title,
    FocusedTitle,
    /// The row a person is at, in the pane with the focus.
    Selected,
    Active,
    Fresh,
    /// Set by hand, and no file has it.
    Unwritten,
    Error,
    Warning,
    Hint,
    /// Where the program will pause.
    Breakpoint,
    /// An edit that waits to be taken over.
    Held,
    Key,
    Running,
    Paused,
    Stopped,
    Up,
    Connecting,
    On,
    Eps,
    Ontime,
    Wildcard,
    Robot,
    Trail,
    Wall,
    Comment,
    /// What is Lua in a program's text.
    Lua,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Meaning {
    pub role: Role,
    /// For configuration.
    pub id: &'static str,
    weight: Modifier,
    dark: Option<Color>,
    light: Option<Color>,
}

const PLAIN: Modifier = Modifier::empty();
const FAINT: Modifier = Modifier::DIM;
const HEAVY: Modifier = Modifier::BOLD;
const TURNED: Modifier = Modifier::REVERSED;
const BADGE: Modifier = HEAVY.union(TURNED);

macro_rules! table {
    ($($role:ident $id:literal $weight:ident $dark:ident $light:ident;)*) => {
        /// On light ground yellow, green and cyan can't be read, nor what bold makes of them.
        pub const TABLE: &[Meaning] = &[$(Meaning {
            role: Role::$role, id: $id, weight: $weight, dark: table!(@ $dark), light: table!(@ $light),
        },)*];
    };
    (@ None) => { None };
    (@ $colour:ident) => { Some(Color::$colour) };
}

table! {
    Rule "rule" FAINT None None;
    Title "title" FAINT None None;
    FocusedTitle "focused-title" HEAVY None None;
    Selected "selected" TURNED None None;
    Active "active" HEAVY Green Blue;
    Fresh "fresh" HEAVY Yellow Magenta;
    Unwritten "unwritten" PLAIN Yellow Magenta;
    Error "error" HEAVY Red Red;
    Warning "warning" PLAIN Yellow Magenta;
    Hint "hint" FAINT None None;
    Breakpoint "breakpoint" PLAIN Red Red;
    Held "held" HEAVY LightBlue Blue;
    Key "key" HEAVY None None;
    Running "running" BADGE Green Blue;
    Paused "paused" BADGE Yellow Magenta;
    Stopped "stopped" BADGE Red Red;
    Up "up" PLAIN Green Blue;
    Connecting "connecting" PLAIN Yellow Magenta;
    On "on" PLAIN LightBlue Blue;
    Eps "eps" PLAIN Green DarkGray;
    Ontime "ontime" PLAIN Yellow Red;
    Wildcard "wildcard" PLAIN Magenta Magenta;
    Robot "robot" HEAVY Cyan Blue;
    Trail "trail" FAINT Cyan Blue;
    Wall "wall" FAINT None None;
    Comment "comment" FAINT None None;
    Lua "lua" PLAIN Cyan Blue;
}

/// What a person may write for a style.
const WEIGHTS: [(&str, Modifier); 5] =
    [("plain", PLAIN), ("bold", HEAVY), ("dim", FAINT), ("underlined", Modifier::UNDERLINED), ("reversed", TURNED)];

const COLOURS: [(&str, Color); 16] = [
    ("black", Color::Black),
    ("red", Color::Red),
    ("green", Color::Green),
    ("yellow", Color::Yellow),
    ("blue", Color::Blue),
    ("magenta", Color::Magenta),
    ("cyan", Color::Cyan),
    ("white", Color::Gray),
    ("bright-black", Color::DarkGray),
    ("bright-red", Color::LightRed),
    ("bright-green", Color::LightGreen),
    ("bright-yellow", Color::LightYellow),
    ("bright-blue", Color::LightBlue),
    ("bright-magenta", Color::LightMagenta),
    ("bright-cyan", Color::LightCyan),
    ("bright-white", Color::White),
];

pub const WORDS: &str = "a colour (black, red, green, yellow, blue, magenta, cyan, white, or bright- one of them), \
                         and bold, dim, underlined, reversed or plain, as in \"bold red\"";

/// `bold bright-red`: a colour and weights; without a colour that of the terminal.
///
/// # Errors
/// A sentence naming the word that is neither.
pub fn style(words: &str) -> Result<Style, String> {
    let mut style = Style::new();
    for word in words.split_whitespace() {
        let colour = COLOURS.iter().find(|(name, _)| *name == word);
        let weight = WEIGHTS.iter().find(|(name, _)| *name == word);
        style = match (colour, weight) {
            (Some((_, colour)), _) => style.fg(*colour),
            (None, Some((_, weight))) => style.add_modifier(*weight),
            (None, None) => return Err(format!("`{word}` is neither a colour nor a weight")),
        };
    }
    Ok(style)
}

impl Meaning {
    fn style(&self, palette: Palette) -> Style {
        let colour = match palette {
            Palette::Dark => self.dark,
            Palette::Light => self.light,
            Palette::Mono => None,
        };
        let weight = match (palette, self.role) {
            // In a drawing nothing else tells of it.
            (Palette::Mono, Role::Warning) => Modifier::UNDERLINED,
            _ => self.weight,
        };
        Style { fg: colour, ..Style::new() }.add_modifier(weight)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Theme {
    /// Of each row of the table.
    styles: Vec<Style>,
}

impl Default for Theme {
    fn default() -> Theme {
        Theme::of(Palette::default())
    }
}

impl Theme {
    pub fn of(palette: Palette) -> Theme {
        Theme { styles: TABLE.iter().map(|meaning| meaning.style(palette)).collect() }
    }

    pub fn style(&self, role: Role) -> Style {
        let rows = TABLE.iter().zip(&self.styles);
        rows.into_iter().find(|(meaning, _)| meaning.role == role).map_or(Style::new(), |(_, style)| *style)
    }

    /// Gives what has this id another style.
    pub fn set(&mut self, id: &str, style: Style) {
        let rows = TABLE.iter().zip(&mut self.styles);
        rows.filter(|(meaning, _)| meaning.id == id).for_each(|(_, place)| *place = style);
    }

    pub fn normal(&self) -> Style {
        Style::new()
    }

    pub fn dim(&self) -> Style {
        Style::new().add_modifier(FAINT)
    }

    pub fn bold(&self) -> Style {
        Style::new().add_modifier(HEAVY)
    }

    pub fn rule(&self) -> Style {
        self.style(Role::Rule)
    }

    pub fn title(&self) -> Style {
        self.style(Role::Title)
    }

    pub fn focused_title(&self) -> Style {
        self.style(Role::FocusedTitle)
    }

    pub fn selected(&self) -> Style {
        self.style(Role::Selected)
    }

    pub fn active(&self) -> Style {
        self.style(Role::Active)
    }

    pub fn fresh(&self) -> Style {
        self.style(Role::Fresh)
    }

    pub fn unwritten(&self) -> Style {
        self.style(Role::Unwritten)
    }

    pub fn stop(&self) -> Style {
        self.style(Role::Error)
    }

    pub fn breakpoint(&self) -> Style {
        self.style(Role::Breakpoint)
    }

    pub fn held(&self) -> Style {
        self.style(Role::Held)
    }

    pub fn comment(&self) -> Style {
        self.style(Role::Comment)
    }

    pub fn lua(&self) -> Style {
        self.style(Role::Lua)
    }

    pub fn key(&self) -> Style {
        self.style(Role::Key)
    }

    pub fn mode(&self, mode: &Mode) -> Style {
        self.style(match mode {
            Mode::Running => Role::Running,
            Mode::Paused { .. } | Mode::Waiting { .. } => Role::Paused,
            Mode::Stopped => Role::Stopped,
        })
    }

    pub fn health(&self, health: Option<Health>) -> Style {
        match health {
            None => self.dim(),
            Some(Health::Up) => self.style(Role::Up),
            Some(Health::Connecting) => self.style(Role::Connecting),
            Some(Health::Lost) => self.stop(),
        }
    }

    pub fn transition(&self, kind: EdgeKind) -> Style {
        self.style(match kind {
            EdgeKind::On | EdgeKind::Exit => Role::On,
            EdgeKind::Eps => Role::Eps,
            EdgeKind::Ontime => Role::Ontime,
            EdgeKind::Wildcard => Role::Wildcard,
        })
    }

    pub fn gravity(&self, gravity: Gravity) -> Style {
        self.style(match gravity {
            Gravity::Error => Role::Error,
            Gravity::Warning => Role::Warning,
            Gravity::Hint => Role::Hint,
        })
    }

    pub fn level(&self, level: Level) -> Style {
        match level {
            Level::Error => self.gravity(Gravity::Error),
            Level::Warn => self.gravity(Gravity::Warning),
            Level::Info => self.normal(),
            Level::Debug => self.dim(),
        }
    }

    /// The painted line and the robot of a world.
    pub fn robot(&self) -> Style {
        self.style(Role::Robot)
    }

    pub fn trail(&self) -> Style {
        self.style(Role::Trail)
    }

    pub fn wall(&self) -> Style {
        self.style(Role::Wall)
    }
}
