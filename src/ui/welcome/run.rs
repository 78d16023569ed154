//! The welcome on a terminal: from the first frame to the choice. The folder is looked through beside it, since a disk may
//! take its time.

use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::mpsc::channel;
use std::thread::Builder;

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::layout::Size;

use super::{Choice, Options, Welcome};
use crate::session::behaviours::{self, BOUNDS, Found};
use crate::session::first_program;
use crate::session::signals::{Signal, Signals};
use crate::ui::config;
use crate::ui::input::{Input, Received};
use crate::ui::live::send;
use crate::ui::pointer::Mouse;
use crate::ui::terminal::Screen;

/// What a person wants.
#[derive(Debug)]
pub enum Wanted {
    Program(PathBuf),
    Tour,
    /// To leave, with this code.
    Nothing(ExitCode),
}

enum Happened {
    Terminal(Received),
    Signal(Signal),
    Found(Found),
}

/// `tour`: how far it was taken here.
pub fn ask(tour: Option<String>) -> io::Result<Wanted> {
    Screen::check()?;
    let size = crossterm::terminal::size().map(|(width, height)| Size { width, height }).unwrap_or_default();
    let settings = config::usual();
    let mut welcome = Welcome::new(Options { folder: here(), tour, settings, size });
    let (happened, inbox) = channel();
    let _signals = Signals::watch(send(&happened, Happened::Signal))?;
    // No robot moves yet.
    let mut screen = Screen::enter(Mouse::Terminals, || ())?;
    let input = Input::read(send(&happened, Happened::Terminal))?;
    let found = send(&happened, Happened::Found);
    Builder::new().name("find".into()).spawn(move || found(behaviours::find(Path::new("."), BOUNDS)))?;
    let wanted = loop {
        let drawn = screen.draw(|frame| {
            let area = frame.area();
            if let Some(cursor) = welcome.paint(area, frame.buffer_mut()) {
                frame.set_cursor_position(cursor);
            }
        });
        let Ok(happened) = inbox.recv() else { break Wanted::Nothing(ExitCode::FAILURE) };
        if drawn.is_err() {
            break Wanted::Nothing(ExitCode::SUCCESS);
        }
        if let Some(wanted) = take(&mut welcome, &mut screen, happened) {
            break wanted;
        }
    };
    // What is typed from here on belongs to the screen that follows.
    let hold = input.hold();
    drop(input);
    drop(hold);
    Ok(wanted)
}

fn take(welcome: &mut Welcome, screen: &mut Screen, happened: Happened) -> Option<Wanted> {
    match happened {
        Happened::Found(found) => welcome.found(found),
        Happened::Signal(Signal::Interrupt) => return Some(Wanted::Nothing(ExitCode::from(130))),
        Happened::Signal(Signal::HangUp | Signal::Terminate) | Happened::Terminal(Received::Gone) => {
            return Some(Wanted::Nothing(ExitCode::SUCCESS));
        }
        Happened::Signal(Signal::Suspend) => screen.suspend().unwrap_or_else(|error| welcome.refuse(error)),
        Happened::Signal(Signal::Continue) => screen.resume().unwrap_or_else(|error| welcome.refuse(error)),
        Happened::Terminal(Received::Event(TerminalEvent::Resize(width, height))) => {
            welcome.resize(Size { width, height });
        }
        Happened::Terminal(Received::Event(TerminalEvent::Key(key))) if key.kind != KeyEventKind::Release => {
            let interrupts = key.code == KeyCode::Char('c') && key.modifiers == KeyModifiers::CONTROL;
            match welcome.key(key)? {
                Choice::Open(file) => return Some(Wanted::Program(file)),
                Choice::Make(name) => match first_program::create(&name) {
                    Ok(file) => return Some(Wanted::Program(file)),
                    Err(why) => welcome.refuse(why),
                },
                Choice::Tour => return Some(Wanted::Tour),
                Choice::Quit if interrupts => return Some(Wanted::Nothing(ExitCode::from(130))),
                Choice::Quit => return Some(Wanted::Nothing(ExitCode::SUCCESS)),
                Choice::Suspend => screen.suspend().unwrap_or_else(|error| welcome.refuse(error)),
                Choice::Redraw => screen.resume().unwrap_or_else(|error| welcome.refuse(error)),
            }
        }
        Happened::Terminal(Received::Event(_)) => (),
    }
    None
}

/// The folder's own name, for it is the end of a path that tells.
fn here() -> String {
    let folder = std::env::current_dir().ok();
    let name = folder.as_deref().map(|folder| folder.file_name().map_or("/".into(), |name| name.to_string_lossy()));
    name.map_or_else(|| "this folder".into(), |name| name.chars().filter(|c| !c.is_control()).collect())
}
