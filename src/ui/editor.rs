//! Opens the user's editor at a place in a file: beside the screen where tmux or the editor's own window allows it, else in
//! front of it. Knows how editors want to be told a line, and nothing of what is edited.

use std::env;
use std::ffi::{OsStr, OsString};
use std::fmt;
use std::io;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

use ratatui::layout::Size;

use super::foreground;

/// Tried in this order where the user has named none.
const USUAL: [&str; 3] = ["nano", "vim", "vi"];

/// From this many columns on, tmux puts the editor beside the screen rather than below.
const WIDE: u16 = 120;

/// What the choice of an editor, and of a place for it, depends on.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// $VISUAL or $EDITOR, a command with its arguments.
    pub editor: Option<String>,
    /// $PATH
    pub search: OsString,
    pub multiplexer: Multiplexer,
    pub size: Size,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiplexer {
    Tmux,
    None,
}

impl Surroundings {
    /// Of this process, on a terminal of this size.
    pub fn here(size: Size) -> Surroundings {
        let mut named = ["VISUAL", "EDITOR"].iter().filter_map(|name| env::var(name).ok());
        Surroundings {
            editor: named.find(|editor| !editor.trim().is_empty()),
            search: env::var_os("PATH").unwrap_or_default(),
            multiplexer: if env::var_os("TMUX").is_some() { Multiplexer::Tmux } else { Multiplexer::None },
            size,
        }
    }
}

/// Where the editor appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// In a pane of its own, beside or below ours.
    Split,
    /// In a window of its own, if it runs here at all.
    Window,
    /// In front of the screen, which must be left, and its input held, until it ends.
    Covering,
}

/// Why no editor can be opened. Displays as one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoEditor {
    Missing { name: String },
    NoneFound,
}

impl fmt::Display for NoEditor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { name } => write!(f, "the editor `{name}` isn't there; set VISUAL or EDITOR to one that is"),
            Self::NoneFound => write!(f, "no editor found; set VISUAL or EDITOR to the one you use"),
        }
    }
}

impl std::error::Error for NoEditor {}

/// An editor about to be opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    pub manner: Manner,
    /// The program to run, tmux where it splits, with its arguments; no shell reads them.
    pub command: Vec<OsString>,
}

impl Launch {
    /// Line and column count from one.
    pub fn new(file: &Path, line: usize, column: usize, around: &Surroundings) -> Result<Launch, NoEditor> {
        let editor = match &around.editor {
            Some(editor) => editor.as_str(),
            None => *USUAL.iter().find(|name| find(name, &around.search).is_some()).ok_or(NoEditor::NoneFound)?,
        };
        let mut command = command_line(editor, file, line, column);
        let name = command[0].to_string_lossy().into_owned();
        command[0] = find(&name, &around.search).ok_or(NoEditor::Missing { name: name.clone() })?.into();
        Ok(match (Dialect::of(&name), around.multiplexer) {
            (Dialect::Goto | Dialect::Suffix(Home::Window), _) => Launch { manner: Manner::Window, command },
            (_, Multiplexer::Tmux) => Launch { manner: Manner::Split, command: split(command, around.size) },
            (_, Multiplexer::None) => Launch { manner: Manner::Covering, command },
        })
    }

    /// Runs it; a thread calls back when it has ended, or when tmux has made the pane, with what went wrong in one line.
    pub fn start(self, done: impl FnOnce(Result<(), String>) + Send + 'static) -> io::Result<()> {
        thread::Builder::new().name("editor".into()).spawn(move || done(self.run())).map(drop)
    }

    fn run(&self) -> Result<(), String> {
        let program = Path::new(&self.command[0]);
        let name = program.file_name().unwrap_or_default().to_string_lossy();
        let mut command = Command::new(program);
        command.args(&self.command[1..]);
        let ended = match self.manner {
            Manner::Covering => foreground::run(&mut command).map(|status| (status, Vec::new())),
            Manner::Split | Manner::Window => {
                command.stdin(Stdio::null()).output().map(|output| (output.status, output.stderr))
            }
        };
        match ended {
            Ok((status, _)) if status.success() => Ok(()),
            Ok((status, said)) => {
                let said = String::from_utf8_lossy(&said);
                Err(format!("`{name}` ended with {status}: {}", said.trim()).trim_end_matches([':', ' ']).to_owned())
            }
            Err(error) => Err(format!("`{name}` can't be started: {error}")),
        }
    }
}

/// Vim takes `*.lrp` for an archive, as the Linux Router Project made them, unless it believes its plugin for those loaded.
const NO_ARCHIVE: &str = "let g:loaded_tarPlugin=1";

/// How editors are told a line.
#[derive(Clone, Copy)]
enum Dialect {
    /// `+call cursor(12,5) file`
    Vim,
    /// `+12 file`
    Line,
    /// `+12,5 file`
    Comma,
    /// `+12:5 file`
    Colon,
    /// `file:12:5`
    Suffix(Home),
    /// `--goto file:12:5`
    Goto,
    /// `file`
    Unknown,
}

#[derive(Clone, Copy)]
enum Home {
    Terminal,
    Window,
}

impl Dialect {
    /// By the program's name, without what distributions append: `vim.basic`, `emacs-nox`.
    fn of(program: &str) -> Dialect {
        let name = program.rsplit('/').next().unwrap_or(program);
        match name.split(['.', '-']).next().unwrap_or(name) {
            "vim" | "nvim" => Dialect::Vim,
            "vi" => Dialect::Line,
            "nano" => Dialect::Comma,
            "emacs" | "emacsclient" | "kak" | "micro" => Dialect::Colon,
            "hx" | "helix" => Dialect::Suffix(Home::Terminal),
            "subl" => Dialect::Suffix(Home::Window),
            "code" | "codium" => Dialect::Goto,
            _ => Dialect::Unknown,
        }
    }
}

/// The editor's command line for a place in a file; line and column count from one. The editor is a command with its
/// arguments as a shell would read it, except that nothing in it is expanded.
pub fn command_line(editor: &str, file: &Path, line: usize, column: usize) -> Vec<OsString> {
    let mut command: Vec<OsString> = words(editor).into_iter().map(OsString::from).collect();
    if command.is_empty() {
        command.push(OsString::new());
    }
    let file = as_operand(file);
    let mut with_place = file.clone();
    with_place.push(format!(":{line}:{column}"));
    command.extend(match Dialect::of(&command[0].to_string_lossy()) {
        Dialect::Vim => {
            vec!["--cmd".into(), NO_ARCHIVE.into(), format!("+call cursor({line},{column})").into(), file]
        }
        Dialect::Line => vec![format!("+{line}").into(), file],
        Dialect::Comma => vec![format!("+{line},{column}").into(), file],
        Dialect::Colon => vec![format!("+{line}:{column}").into(), file],
        Dialect::Suffix(_) => vec![with_place],
        Dialect::Goto => vec!["--goto".into(), with_place],
        Dialect::Unknown => vec![file],
    });
    command
}

/// A name that begins like an option isn't one.
fn as_operand(file: &Path) -> OsString {
    match file.as_os_str().as_bytes() {
        [b'-' | b'+', ..] => Path::new(".").join(file).into(),
        _ => file.into(),
    }
}

/// Splits a command at white space outside of quotes; a backslash takes the next character as it is.
fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    let mut characters = command.chars();
    while let Some(c) = characters.next() {
        match (c, quote) {
            ('\\', None | Some('"')) => word.get_or_insert_default().extend(characters.next()),
            ('\'' | '"', None) => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (c, Some(open)) if c == open => quote = None,
            (c, None) if c.is_whitespace() => words.extend(word.take()),
            (c, _) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// The tmux command that runs this in a new pane. Given several words, tmux runs them without a shell.
fn split(command: Vec<OsString>, size: Size) -> Vec<OsString> {
    let direction = if size.width >= WIDE { "-h" } else { "-v" };
    let mut tmux: Vec<OsString> = ["tmux", "split-window", direction].map(OsString::from).into();
    if let Ok(folder) = env::current_dir() {
        tmux.extend(["-c".into(), literal(folder.as_os_str())]);
    }
    tmux.push("--".into());
    tmux.extend(command.into_iter().map(as_tmux_word));
    tmux
}

/// For arguments in which tmux expands formats, some of which run commands.
fn literal(text: &OsStr) -> OsString {
    let doubled = |&byte: &u8| {
        if byte == b'#' { vec![b'#', b'#'] } else { vec![byte] }
    };
    as_tmux_word(OsString::from_vec(text.as_bytes().iter().flat_map(doubled).collect()))
}

/// A last semicolon would begin another tmux command.
fn as_tmux_word(word: OsString) -> OsString {
    match word.as_bytes() {
        [before @ .., b';'] => OsString::from_vec([before, b"\\;"].concat()),
        _ => word,
    }
}

/// The program's path, from the search path unless its name is a path already.
fn find(program: &str, search: &OsStr) -> Option<PathBuf> {
    let runs =
        |path: &PathBuf| path.metadata().is_ok_and(|seen| seen.is_file() && seen.permissions().mode() & 0o111 != 0);
    if program.contains('/') {
        return Some(PathBuf::from(program)).filter(runs);
    }
    env::split_paths(search).map(|folder| folder.join(program)).find(runs)
}
