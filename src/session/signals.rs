//! The signals that concern a running program, handed on one by one from a thread of their own. Decides nothing about them.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGTERM, SIGTSTP};
use signal_hook::iterator::Handle;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// Ctrl-C on a terminal in its usual mode.
    Interrupt,
    Terminate,
    /// The terminal is gone.
    HangUp,
    /// Ctrl-Z on a terminal in its usual mode. The process goes on until it calls [`suspend`].
    Suspend,
    /// The process was stopped, also by means it never heard of, and goes on.
    Continue,
}

impl Signal {
    fn of(number: i32) -> Option<Signal> {
        match number {
            SIGINT => Some(Signal::Interrupt),
            SIGTERM => Some(Signal::Terminate),
            SIGHUP => Some(Signal::HangUp),
            SIGTSTP => Some(Signal::Suspend),
            SIGCONT => Some(Signal::Continue),
            _ => None,
        }
    }
}

/// While it lives, these signals do nothing but call back; once it is dropped, they do nothing at all.
pub struct Signals {
    handle: Handle,
    thread: Option<JoinHandle<()>>,
}

impl Signals {
    /// Several of one kind that come faster than they are taken count as one.
    pub fn watch(on: impl Fn(Signal) + Send + 'static) -> io::Result<Signals> {
        let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT])?;
        let handle = signals.handle();
        let thread = thread::Builder::new()
            .name("signals".into())
            .spawn(move || signals.forever().filter_map(Signal::of).for_each(on))?;
        Ok(Signals { handle, thread: Some(thread) })
    }
}

impl Drop for Signals {
    fn drop(&mut self) {
        self.handle.close();
        if let Some(thread) = self.thread.take() {
            // A panic there has already been reported.
            let _ = thread.join();
        }
    }
}

/// How long a stop may take to arrive. Where nobody could continue the process, it never does.
const STOP_TAKES: Duration = Duration::from_millis(100);

/// Stops the process and its group as Ctrl-Z would; returns when it is continued. Does nothing where no shell waits for it.
pub fn suspend() -> io::Result<()> {
    let continued = Arc::new(AtomicBool::new(false));
    let id = signal_hook::flag::register(SIGCONT, continued.clone())?;
    let stopped = stop_group(&continued);
    signal_hook::low_level::unregister(id);
    stopped
}

fn stop_group(continued: &AtomicBool) -> io::Result<()> {
    let ours = default_action(SIGTSTP)?;
    // SAFETY: no memory is involved; 0 is the caller's own process group.
    let sent = unsafe { libc::kill(0, SIGTSTP) };
    let error = io::Error::last_os_error();
    // The signal may go to any thread, so the stop may come a moment after the call.
    let pause = Duration::from_millis(2);
    for _ in 0..STOP_TAKES.as_millis() / pause.as_millis() {
        if continued.load(Ordering::Relaxed) {
            break;
        }
        thread::sleep(pause);
    }
    restore_action(SIGTSTP, &ours)?;
    if sent == 0 { Ok(()) } else { Err(error) }
}

fn default_action(signal: i32) -> io::Result<libc::sigaction> {
    // SAFETY: zeroes are a valid sigaction, with the default action and an empty mask; both are ours.
    unsafe {
        let mut before: libc::sigaction = std::mem::zeroed();
        let mut default: libc::sigaction = std::mem::zeroed();
        default.sa_sigaction = libc::SIG_DFL;
        checked(libc::sigaction(signal, &default, &mut before))?;
        Ok(before)
    }
}

fn restore_action(signal: i32, action: &libc::sigaction) -> io::Result<()> {
    // SAFETY: the action is what the system gave for this signal.
    checked(unsafe { libc::sigaction(signal, action, std::ptr::null_mut()) })
}

fn checked(result: i32) -> io::Result<()> {
    if result == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
}
