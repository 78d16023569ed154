//! The terminal as a guard: while it is entered the screen is ours, and however that ends, the terminal is as it was.
//! Knows nothing of what is drawn.

use std::backtrace::{Backtrace, BacktraceStatus};
use std::fmt;
use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;
use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, ThreadId};

use crossterm::Command;
use crossterm::cursor::{Hide, Show};
use crossterm::event::DisableBracketedPaste;
use crossterm::execute;
use crossterm::style::ResetColor;
use crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode};
use ratatui::{Frame, Terminal};

use super::pointer::Mouse;
use super::quiet::{self, Quiet};
use crate::session::signals;

/// The screen of the thread that entered it.
pub struct Screen {
    terminal: Terminal<Quiet<File>>,
    out: File,
    shared: Arc<Shared>,
    earlier_hook: Arc<Hook>,
    mouse: Mouse,
}

/// Clicks, drags and the wheel are told, in any column; moves without a button are not, for they would wake us all the time.
struct TellOfMouse;

impl Command for TellOfMouse {
    fn write_ansi(&self, f: &mut impl fmt::Write) -> fmt::Result {
        f.write_str("\x1b[?1000h\x1b[?1002h\x1b[?1006h")
    }
}

struct KeepMouse;

impl Command for KeepMouse {
    fn write_ansi(&self, f: &mut impl fmt::Write) -> fmt::Result {
        f.write_str("\x1b[?1006l\x1b[?1002l\x1b[?1000l")
    }
}

type Hook = dyn Fn(&PanicHookInfo<'_>) + Send + Sync;

/// What the panic hook needs to know.
struct Shared {
    owner: ThreadId,
    ours: AtomicBool,
    stop_the_robot: Box<dyn Fn() + Send + Sync>,
    /// Panics of other threads, kept until they can be read.
    kept: Mutex<Vec<String>>,
}

impl Screen {
    /// Whether there is a terminal to enter.
    pub fn check() -> io::Result<()> {
        if !io::stdin().is_terminal() || !io::stdout().is_terminal() {
            return Err(io::Error::other("there is no terminal for the screen; `lrp run` works without one"));
        }
        if std::env::var_os("TERM").is_some_and(|term| term == "dumb") {
            return Err(io::Error::other(
                "a terminal of the kind `dumb` can't show the screen; `lrp run` works without it, and if it is none, set TERM",
            ));
        }
        Ok(())
    }

    /// Takes the terminal over. Should this thread panic, the terminal is given back, then `stop_the_robot` is called,
    /// then the panic is explained. Fails where there is no terminal, in a sentence for the user.
    pub fn enter(mouse: Mouse, stop_the_robot: impl Fn() + Send + Sync + 'static) -> io::Result<Screen> {
        Self::check()?;
        let out = File::from(io::stdout().as_fd().try_clone_to_owned()?);
        let terminal = Terminal::new(Quiet::new(out.try_clone()?, quiet::size()?))?;
        let shared = Arc::new(Shared {
            owner: thread::current().id(),
            ours: AtomicBool::new(false),
            stop_the_robot: Box::new(stop_the_robot),
            kept: Mutex::default(),
        });
        let earlier_hook = install_hook(&shared);
        let mut screen = Screen { terminal, out, shared, earlier_hook, mouse };
        screen.resume()?;
        Ok(screen)
    }

    /// Draws a frame; what hasn't changed since the last one costs no byte. While the terminal is left it does nothing.
    /// An error means that the terminal is gone.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame)) -> io::Result<()> {
        if !self.shared.ours.load(Ordering::Acquire) {
            return Ok(());
        }
        self.terminal.draw(render).map(drop)
    }

    /// What a terminal takes without showing anything.
    pub fn send(&mut self, sequence: &str) -> io::Result<()> {
        self.out.write_all(sequence.as_bytes())
    }

    /// Gives the terminal back for a while, to an editor for instance.
    pub fn leave(&mut self) {
        self.shared.leave(&mut self.out);
    }

    /// Takes the terminal again, whatever became of it meanwhile. The next frame is drawn whole.
    pub fn resume(&mut self) -> io::Result<()> {
        self.shared.ours.store(true, Ordering::Release);
        // Else it would count as raw already, though a shell may have changed it behind our back.
        disable_raw_mode()?;
        enable_raw_mode()?;
        execute!(self.out, EnterAlternateScreen, Hide, DisableBracketedPaste)?;
        self.tell_of_mouse()?;
        self.terminal.backend_mut().forget();
        self.terminal.clear()
    }

    /// From now on, also when the terminal is taken again.
    pub fn set_mouse(&mut self, mouse: Mouse) -> io::Result<()> {
        self.mouse = mouse;
        self.tell_of_mouse()
    }

    fn tell_of_mouse(&mut self) -> io::Result<()> {
        match self.mouse {
            Mouse::Ours => execute!(self.out, TellOfMouse),
            Mouse::Terminals => execute!(self.out, KeepMouse),
        }
    }

    /// Ctrl-Z: gives the terminal back, stops the process group, and takes it again once continued.
    pub fn suspend(&mut self) -> io::Result<()> {
        self.leave();
        let stopped = signals::suspend();
        self.resume()?;
        stopped
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.leave();
        // A panicking thread may not change the hook; then it stays, and does no harm.
        if !thread::panicking() {
            let earlier = self.earlier_hook.clone();
            panic::set_hook(Box::new(move |panic| earlier(panic)));
        }
    }
}

impl Shared {
    /// Only the first call after entering does anything. A terminal that is gone needs no restoring.
    fn leave(&self, out: &mut File) {
        if !self.ours.swap(false, Ordering::AcqRel) {
            return;
        }
        let _ = disable_raw_mode();
        let _ = execute!(out, KeepMouse, ResetColor, Show, LeaveAlternateScreen);
        for panic in self.kept.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
            say(&panic);
        }
    }

    fn panicked(&self, panic: &PanicHookInfo<'_>, out: Option<&mut File>, earlier: &Hook) {
        if thread::current().id() == self.owner {
            if let Some(out) = out {
                self.leave(out);
            }
            (self.stop_the_robot)();
            say(&explanation(panic));
        } else if self.ours.load(Ordering::Acquire) {
            self.kept.lock().unwrap_or_else(PoisonError::into_inner).push(explanation(panic));
        } else {
            earlier(panic);
        }
    }
}

fn install_hook(shared: &Arc<Shared>) -> Arc<Hook> {
    let earlier: Arc<Hook> = Arc::from(panic::take_hook());
    let (hook, shared) = (earlier.clone(), shared.clone());
    panic::set_hook(Box::new(move |panic| {
        let mut out = io::stdout().as_fd().try_clone_to_owned().map(File::from).ok();
        shared.panicked(panic, out.as_mut(), &*hook);
    }));
    earlier
}

fn explanation(panic: &PanicHookInfo<'_>) -> String {
    let payload = panic.payload();
    let owned = payload.downcast_ref::<String>().map(String::as_str);
    let what = owned.or(payload.downcast_ref::<&str>().copied()).unwrap_or("no message");
    let place = panic.location().map_or(String::from("an unknown place"), ToString::to_string);
    let thread = thread::current().name().unwrap_or("unnamed").to_owned();
    let mut text = format!(
        "lrp made a mistake it can't recover from, in its thread `{thread}` at {place}: {what}. \
         Please report it, with this text and the program that was running.\n"
    );
    let trace = Backtrace::capture();
    if trace.status() == BacktraceStatus::Captured {
        text += &format!("{trace}");
    }
    text
}

/// Unlike `eprint!` this is no panic where nobody listens.
fn say(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}
