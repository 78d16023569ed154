//! The arguments of each command, with their help.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::{ArgAction, Parser, Subcommand, ValueEnum};

use super::explain::LIST;
use crate::lua::{Access, Limits};
use crate::model::Robot;
use crate::runtime::record::Finding;
use crate::runtime::{OnEdit, OnError, Options, Saves, Time};
use crate::session::engine_thread::Pacing;
use crate::session::live::Setup;
use crate::session::pace::Rate;
use crate::session::plugins::Plugins;
use crate::session::trace::Clock;
use crate::ui::config::{self, Look, Place};
use crate::ui::glyphs::Charset;
use crate::ui::pointer::Mouse;
use crate::ui::settings::{Settings, Surroundings};
use crate::ui::theme::Palette;
use crate::ui::tour::folder;

/// Live Robot Programming: state machines that change while they run.
///
/// `lrp FILE` opens the screen; every save of FILE changes the running program. `lrp` alone offers what there is.
#[derive(Parser)]
#[command(name = "lrp", version, args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    task: Option<Task>,
    #[command(flatten)]
    live: Option<RunArgs>,
    #[command(flatten)]
    screen: ScreenArgs,
}

impl Args {
    pub fn task(self) -> Task {
        let Args { task, live, screen } = self;
        task.or(live.map(|run| Task::Live(LiveArgs { run, screen }))).expect("clap asks for one of them")
    }
}

#[derive(Subcommand)]
pub enum Task {
    /// Open the screen on a program and run it (the same as `lrp FILE`)
    Live(LiveArgs),
    /// Run a program without a screen
    Run(RunArgs),
    /// Report what is wrong with programs; exit code 1 if any has errors
    Check {
        /// The programs
        #[arg(required_unless_present = "explain", value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Tell what a code means, with examples; without CODE, list all codes
        #[arg(long, value_name = "CODE", num_args = 0..=1, default_missing_value = LIST, conflicts_with = "files")]
        explain: Option<String>,
        /// A folder to look for bridges in, before all others
        #[arg(long, value_name = "FOLDER")]
        bridge_path: Vec<PathBuf>,
        /// For people or for tools
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
    /// Run behaviour tests (`*_test.lua`) in virtual time; all below the current folder by default
    Test {
        /// Test files, or folders of them
        #[arg(value_name = "PATH")]
        paths: Vec<PathBuf>,
    },
    /// Print the state graph of a machine
    Graph(GraphArgs),
    /// Make a first program NAME.lrp to edit
    New {
        /// Of the file, which must not exist yet; .lrp is added
        name: String,
    },
    /// Ten minutes in the simulator, in which each live thing is done once
    Tour {
        /// Where its program is kept, and how far you came
        #[arg(default_value = folder::USUAL)]
        folder: PathBuf,
    },
    /// Say where the configuration file is and what is wrong with it; exit code 1 if anything is
    Config {
        /// The file; by default the one that the screen would read
        #[arg(value_name = "PATH")]
        file: Option<PathBuf>,
    },
    /// List the kinds of bridges, or what one offers
    Bridges {
        /// The kind whose inputs and outputs to list
        kind: Option<String>,
        /// A folder to look for bridges in, before all others
        #[arg(long, value_name = "FOLDER")]
        bridge_path: Vec<PathBuf>,
    },
    /// The process that a bridge's library lives in
    #[command(hide = true)]
    BridgeHost { library: PathBuf },
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Format {
    Text,
    Json,
}

#[derive(clap::Args)]
pub struct LiveArgs {
    #[command(flatten)]
    pub run: RunArgs,
    #[command(flatten)]
    screen: ScreenArgs,
}

#[derive(Clone, Copy, ValueEnum)]
enum ThemeName {
    Auto,
    Dark,
    Light,
    Mono,
}

#[derive(Clone, Copy, ValueEnum)]
enum When {
    Auto,
    Always,
    Never,
}

// How the screen is used and looks; what isn't said is in the configuration file, or as the terminal seems to be.
#[derive(clap::Args)]
struct ScreenArgs {
    /// Hold every save until a key applies or drops it
    #[arg(long, action = ArgAction::SetTrue)]
    hold: bool,
    /// Leave the mouse to the terminal, which selects text with it
    #[arg(long, action = ArgAction::SetTrue)]
    no_mouse: bool,
    /// The configuration file; by default $LRP_CONFIG, else lrp/config.toml in $XDG_CONFIG_HOME or ~/.config
    #[arg(long, value_name = "PATH")]
    config: Option<PathBuf>,
    /// Colours for the ground the terminal has, or none
    #[arg(long, value_name = "THEME", value_enum)]
    theme: Option<ThemeName>,
    /// Only ASCII characters, or never; by default as the locale says
    #[arg(long, value_name = "WHEN", value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "always")]
    ascii: Option<When>,
}

#[derive(clap::Args)]
pub struct RunArgs {
    /// The program
    pub file: PathBuf,
    /// Steps a second; 0: as fast as possible
    #[arg(long, value_name = "HZ", default_value = "10", allow_hyphen_values = true, value_parser = rate)]
    pub rate: Rate,
    /// Which robot a name stands for, whatever the program says, such as robot=sim
    #[arg(long, value_name = "NAME=KIND", value_parser = robot)]
    pub bridge: Vec<Robot>,
    /// A folder to look for bridges in, before all others
    #[arg(long, value_name = "FOLDER")]
    pub bridge_path: Vec<PathBuf>,
    /// Write the records to a file, a JSON object a line; -: standard output
    #[arg(long, value_name = "PATH")]
    pub trace: Option<PathBuf>,
    /// End after this much program time, such as 500ms, 5s or 2m
    #[arg(long = "for", value_name = "TIME", allow_hyphen_values = true, value_parser = duration)]
    pub until: Option<Duration>,
    /// Virtual time: no waiting, and equal runs give equal records
    #[arg(long = "virtual", action = ArgAction::SetTrue)]
    pub virtual_time: bool,
    /// For everything random: the simulator's noise and math.random
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// What an edit does that changes an active state: restart begins the program again; keep swaps its actions in
    /// place, and starts only a machine again whose active state is gone or spawns something else
    #[arg(long, value_name = "HOW", value_enum, default_value_t = EditMode::Restart)]
    pub on_edit: EditMode,
    /// Pause when something goes wrong that no check of the text foresaw; without a screen, end there
    #[arg(long, action = ArgAction::SetTrue)]
    pub pause_on_error: bool,
    /// How long a block may run before it is stopped, ms
    #[arg(long, value_name = "MS", default_value = "250", value_parser = clap::value_parser!(u64).range(1..=60_000))]
    pub block_limit: u64,
    /// How much memory Lua may use, MiB
    #[arg(long, value_name = "MIB", default_value = "64", value_parser = clap::value_parser!(u64).range(4..=65_536))]
    pub memory_limit: u64,
    /// Let blocks use Lua's io, os and debug libraries
    #[arg(long, action = ArgAction::SetTrue)]
    pub allow_system: bool,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum EditMode {
    Restart,
    Keep,
}

#[derive(clap::Args)]
pub struct GraphArgs {
    /// The program
    pub file: PathBuf,
    /// The path of the machine, such as follower/looking/lookalgo; the first one by default
    pub machine: Option<String>,
    /// Columns at most; labels are shortened to fit
    #[arg(long, value_name = "N")]
    pub width: Option<u16>,
    /// Rows at most, as far as that can be: where boxes don't fit, a table may
    #[arg(long, value_name = "N")]
    pub height: Option<u16>,
    /// Boxes with lines, or a table with an arrow for each transition; what fits by default
    #[arg(long, value_enum)]
    pub form: Option<GraphForm>,
    /// Only this state of the machine, with what leads into and out of it
    #[arg(long, value_name = "STATE", conflicts_with = "form")]
    pub around: Option<String>,
    /// Only ASCII characters
    #[arg(long, action = ArgAction::SetTrue)]
    pub ascii: bool,
    /// A drawing in characters, or a text for Graphviz or Mermaid
    #[arg(long, value_enum, default_value_t = GraphFormat::Text)]
    pub format: GraphFormat,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GraphForm {
    Boxes,
    Table,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GraphFormat {
    Text,
    Dot,
    Mermaid,
}

impl LiveArgs {
    /// As if nothing else had been said on the command line.
    pub fn of(file: PathBuf) -> LiveArgs {
        let words = [OsString::from("lrp"), "--".into(), file.into()];
        match Args::parse_from(words).task() {
            Task::Live(live) => live,
            _ => unreachable!("a file after -- is a file"),
        }
    }

    pub fn setup(&self) -> Setup {
        let setup = self.run.setup();
        let saves = if self.screen.hold { Saves::Hold } else { Saves::Apply };
        Setup { options: Options { saves, ..setup.options }, ..setup }
    }

    /// The configuration file with what is said here over it, and what is wrong with the file.
    pub fn settings(&self) -> (Settings, Vec<Finding>) {
        let surroundings = Surroundings::here();
        let mut config = config::load(&Place::here(self.screen.config.as_deref()));
        let findings = std::mem::take(&mut config.findings);
        (config.settings(self.screen.look(&surroundings), &surroundings), findings)
    }
}

impl ScreenArgs {
    /// `auto` is said too: it overrules the file.
    fn look(&self, surroundings: &Surroundings) -> Look {
        Look {
            palette: self.theme.map(|name| match name {
                ThemeName::Auto => surroundings.palette(),
                ThemeName::Dark => Palette::Dark,
                ThemeName::Light => Palette::Light,
                ThemeName::Mono => Palette::Mono,
            }),
            charset: self.ascii.map(|when| match when {
                When::Auto => surroundings.charset(),
                When::Always => Charset::Ascii,
                When::Never => Charset::Unicode,
            }),
            mouse: self.no_mouse.then_some(Mouse::Terminals),
        }
    }
}

impl RunArgs {
    pub fn setup(&self) -> Setup {
        let limits =
            Limits { time: Duration::from_millis(self.block_limit), memory: (self.memory_limit << 20) as usize };
        let access = if self.allow_system { Access::System } else { Access::Sandboxed };
        let on_error = if self.pause_on_error { OnError::Pause } else { OnError::Continue };
        let clock = if self.virtual_time { Clock::Virtual } else { Clock::Real };
        let on_edit = match self.on_edit {
            EditMode::Restart => OnEdit::Restart,
            EditMode::Keep => OnEdit::Keep,
        };
        Setup {
            file: self.file.clone(),
            options: Options { limits, access, seed: self.seed, on_edit, on_error, ..Options::default() },
            pacing: Pacing { rate: self.rate, clock, until: self.until.map(|time| Time(time.as_micros() as u64)) },
            robots: self.bridge.clone(),
            plugins: Plugins::here(&self.bridge_path),
        }
    }
}

fn rate(text: &str) -> Result<Rate, String> {
    let wrong = || format!("a rate is a number of steps a second from 0 to {}", Rate::MAX_HZ);
    text.parse().ok().and_then(Rate::new).ok_or_else(wrong)
}

fn robot(text: &str) -> Result<Robot, String> {
    match text.split_once('=') {
        Some((name, kind)) if !name.is_empty() && !kind.is_empty() => {
            Ok(Robot { name: name.to_string(), kind: kind.to_string() })
        }
        _ => Err("write NAME=KIND, such as robot=sim".to_string()),
    }
}

fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || "a time is a number with its unit, such as 500ms, 5s or 2m".to_string();
    let split = text.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(wrong)?;
    let seconds = match &text[split..] {
        "ms" => 1e-3,
        "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(wrong()),
    };
    let number: f64 = text[..split].parse().map_err(|_| wrong())?;
    Duration::try_from_secs_f64(number * seconds).map_err(|_| wrong())
}
