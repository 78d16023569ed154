//! Keys and size changes from the terminal, handed on one by one from a thread of their own. Knows nothing of what they mean.

use std::io::{self, Read, Write};
use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::net::UnixStream;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use crossterm::event::{self, Event};
use signal_hook::SigId;
use signal_hook::consts::SIGWINCH;
use signal_hook::low_level::{pipe, unregister};

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Received {
    Event(Event),
    /// The terminal is gone; nothing follows.
    Gone,
}

/// Reads the terminal until it is dropped or the terminal is gone.
pub struct Input {
    shared: Arc<Shared>,
    resized: SigId,
}

/// While it lives the terminal isn't read: what is typed belongs to whoever else reads it.
pub struct Hold {
    shared: Arc<Shared>,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    waker: UnixStream,
}

struct State {
    holds: usize,
    reader: Reader,
    wanted: Wanted,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Reader {
    AtWork,
    Resting,
    Ended,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Reading,
    End,
}

/// Half an escape sequence keeps the reader until its rest comes; no editor shall wait for that.
const REST_TAKES: Duration = Duration::from_millis(50);

/// For what has been received already; reading it needs some time to be given.
const AT_ONCE: Duration = Duration::from_millis(5);

impl Input {
    /// The terminal should be raw by now.
    pub fn read(on: impl Fn(Received) + Send + 'static) -> io::Result<Input> {
        let (waker, woken) = UnixStream::pair()?;
        waker.set_nonblocking(true)?;
        woken.set_nonblocking(true)?;
        // This makes crossterm listen for size changes, before us: when we wake up, it knows.
        event::poll(AT_ONCE)?;
        let resized = pipe::register(SIGWINCH, waker.try_clone()?)?;
        let state = State { holds: 0, reader: Reader::AtWork, wanted: Wanted::Reading };
        let shared = Arc::new(Shared { state: Mutex::new(state), changed: Condvar::new(), waker });
        let input = Input { shared: shared.clone(), resized };
        thread::Builder::new().name("input".into()).spawn(move || {
            if shared.run(&woken, &on).is_err() {
                on(Received::Gone);
            }
            shared.set_reader(Reader::Ended);
        })?;
        Ok(input)
    }

    /// Returns when the terminal is free, within 50 ms. What was typed before has been handed on.
    pub fn hold(&self) -> Hold {
        let mut state = self.shared.lock();
        state.holds += 1;
        self.shared.wake();
        let at_work = |state: &mut State| state.reader == Reader::AtWork;
        drop(self.shared.changed.wait_timeout_while(state, REST_TAKES, at_work));
        Hold { shared: self.shared.clone() }
    }
}

impl Drop for Hold {
    fn drop(&mut self) {
        self.shared.lock().holds -= 1;
        self.shared.changed.notify_all();
    }
}

impl Drop for Input {
    fn drop(&mut self) {
        unregister(self.resized);
        self.shared.lock().wanted = Wanted::End;
        self.shared.changed.notify_all();
        self.shared.wake();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set_reader(&self, reader: Reader) {
        self.lock().reader = reader;
        self.changed.notify_all();
    }

    fn wake(&self) {
        // It fails only when full, and then the reader wakes up anyway.
        let _ = (&self.waker).write(&[0]);
    }

    /// Ends well when that is wanted, and with an error when the terminal is gone.
    fn run(&self, woken: &UnixStream, on: &impl Fn(Received)) -> io::Result<()> {
        while self.go_on() {
            wait(io::stdin().as_raw_fd(), woken)?;
            while event::poll(AT_ONCE)? {
                on(Received::Event(event::read()?));
            }
        }
        Ok(())
    }

    /// Rests while held; then, whether to read on.
    fn go_on(&self) -> bool {
        let mut state = self.lock();
        while state.holds > 0 && state.wanted == Wanted::Reading {
            state.reader = Reader::Resting;
            self.changed.notify_all();
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.reader = Reader::AtWork;
        state.wanted == Wanted::Reading
    }
}

/// Until there is something to read, or a call. An error means that the terminal is gone.
fn wait(terminal: RawFd, mut woken: &UnixStream) -> io::Result<()> {
    let interest = |fd| libc::pollfd { fd, events: libc::POLLIN, revents: 0 };
    let mut both = [interest(terminal), interest(woken.as_raw_fd())];
    // SAFETY: the array is as long as told.
    while unsafe { libc::poll(both.as_mut_ptr(), 2, -1) } < 0 {
        let error = io::Error::last_os_error();
        if error.kind() != io::ErrorKind::Interrupted {
            return Err(error);
        }
    }
    if both[0].revents & (libc::POLLHUP | libc::POLLERR | libc::POLLNVAL) != 0 {
        return Err(io::ErrorKind::BrokenPipe.into());
    }
    while matches!(woken.read(&mut [0; 64]), Ok(1..)) {}
    Ok(())
}
