//! Stops a call that takes too long: a thread watches the calls' numbers and signals the thread that calls. Knows nothing of blocks.
//!
//! Each call into Lua has a number, odd while it runs. The watchdog that sees the same odd number for longer than the limit writes it to `target` and
//! signals the calling thread; the handler, finding that call still running, sets a hook on every coroutine that is. The hook
//! raises an error at each instruction until the call has ended, so neither `pcall` nor a loop keeps it going. No hook is set before:
//! one that only counts would cost as much as the calls themselves.

use std::cell::Cell;
use std::ffi::c_int;
use std::ptr;
use std::sync::atomic::Ordering::{Relaxed, SeqCst};
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, compiler_fence};
use std::sync::{Arc, Once};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mlua_sys as ffi;

use super::desk::{desk, spot};

/// A coroutine being resumed, on the C stack of its `resume`.
pub(super) struct Running {
    coroutine: *mut ffi::lua_State,
    outer: *mut Running,
}

pub(super) struct Guard {
    /// The number of the call: odd while it runs.
    call: AtomicU64,
    /// The call that has run for too long.
    target: AtomicU64,
    /// The call whose hooks are set; 0 for none.
    armed: AtomicU64,
    /// By how much the running call is over the limit, in microseconds; 0 if it isn't.
    overdue: AtomicU64,
    main: AtomicPtr<ffi::lua_State>,
    running: AtomicPtr<Running>,
    /// The other guards of this thread.
    next: AtomicPtr<Guard>,
    /// The interpreter is gone.
    done: AtomicBool,
    limit: Duration,
    thread: libc::pthread_t,
}

thread_local! {
    /// The guards of the interpreters that this thread owns.
    static GUARDS: Cell<*mut Guard> = const { Cell::new(ptr::null_mut()) };
}

/// Watches the calls of one interpreter from a thread of its own, until dropped.
pub(super) struct Watchdog {
    guard: Arc<Guard>,
    thread: Option<JoinHandle<()>>,
}

/// Tells another thread whether a block has run for too long and can't be stopped: a call into Rust that doesn't return, say.
#[derive(Clone)]
pub struct Emergency(Arc<Guard>);

impl Emergency {
    /// By how much the running block is over its limit; zero where none is. Precise to a tenth of the limit or 25 ms, whichever is less.
    pub fn overdue(&self) -> Duration {
        Duration::from_micros(self.0.overdue.load(SeqCst))
    }
}

impl Guard {
    pub fn new(limit: Duration) -> Arc<Self> {
        Arc::new(Self {
            call: AtomicU64::new(0),
            target: AtomicU64::new(0),
            armed: AtomicU64::new(0),
            overdue: AtomicU64::new(0),
            main: AtomicPtr::default(),
            running: AtomicPtr::default(),
            next: AtomicPtr::default(),
            done: AtomicBool::new(false),
            limit,
            // SAFETY: always succeeds.
            thread: unsafe { libc::pthread_self() },
        })
    }

    /// A call into Lua begins.
    #[inline]
    pub fn enter(&self) {
        self.call.store(self.call.load(Relaxed) + 1, Relaxed);
        compiler_fence(SeqCst);
    }

    /// The call has ended; whether it had to be stopped.
    #[inline]
    pub fn leave(&self) -> bool {
        compiler_fence(SeqCst);
        self.call.store(self.call.load(Relaxed) + 1, Relaxed);
        compiler_fence(SeqCst);
        self.armed.load(Relaxed) != 0 && self.disarm()
    }

    /// The call has ended and another begins; unless it is being stopped: then it goes on, to be left.
    #[inline]
    pub fn next(&self) -> bool {
        compiler_fence(SeqCst);
        if self.is_over() {
            return false;
        }
        // Should the call be stopped right here, it has ended in time, and its hook takes itself away.
        self.call.store(self.call.load(Relaxed) + 2, Relaxed);
        compiler_fence(SeqCst);
        true
    }

    #[cold]
    fn disarm(&self) -> bool {
        // SAFETY: the state is live as long as calls are made.
        unsafe { ffi::lua_sethook(self.main.load(Relaxed), None, 0, 0) };
        self.armed.swap(0, Relaxed) + 1 == self.call.load(Relaxed)
    }

    /// Whether the running call is being stopped. Whatever loops in C asks now and then.
    #[inline]
    pub fn is_over(&self) -> bool {
        let armed = self.armed.load(Relaxed);
        armed != 0 && armed == self.call.load(Relaxed)
    }

    /// Sets the hooks, if the call meant is still running. Called in the signal handler: stores and lua_sethook, which may be used there.
    fn arm(&self) {
        let call = self.call.load(Relaxed);
        if call.is_multiple_of(2) || call != self.target.load(SeqCst) {
            return;
        }
        self.armed.store(call, Relaxed);
        // SAFETY: a call runs, so its state lives, as do those of the coroutines in the chain: their resume hasn't returned.
        unsafe {
            set_hook(self.main.load(Relaxed));
            let mut running = self.running.load(Relaxed);
            while let Some(link) = running.as_ref() {
                set_hook(link.coroutine);
                running = link.outer;
            }
        }
    }

    /// Runs `f` with `coroutine` among those that are stopped with the call.
    ///
    /// # Safety
    /// `coroutine` lives until `f` returns, and `f` raises no error.
    pub unsafe fn within(&self, coroutine: *mut ffi::lua_State, f: impl FnOnce() -> c_int) -> c_int {
        let mut link = Running { coroutine, outer: self.running.load(Relaxed) };
        self.running.store(&mut link, Relaxed);
        compiler_fence(SeqCst);
        if self.is_over() {
            unsafe { set_hook(coroutine) };
        }
        let result = f();
        compiler_fence(SeqCst);
        self.running.store(link.outer, Relaxed);
        result
    }
}

unsafe fn set_hook(state: *mut ffi::lua_State) {
    unsafe { ffi::lua_sethook(state, Some(hook), ffi::LUA_MASKCOUNT, 1) };
}

/// Ends the call that is over; a hook left on a coroutine by a call that is gone takes itself away.
unsafe extern "C-unwind" fn hook(state: *mut ffi::lua_State, _: *mut ffi::lua_Debug) {
    unsafe {
        let desk = desk(state);
        if !desk.guard.is_over() {
            return ffi::lua_sethook(state, None, 0, 0);
        }
        if desk.fault.get().is_none() {
            desk.fault.set(spot(state));
        }
        raise(state);
    }
}

/// The error of a call that is being stopped.
///
/// # Safety
/// Called from C that Lua called.
pub(super) unsafe fn raise(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        push_message(state);
        ffi::lua_error(state)
    }
}

/// Pushes the message of a call that is being stopped.
///
/// # Safety
/// As for `raise`.
pub(super) unsafe fn push_message(state: *mut ffi::lua_State) {
    unsafe { ffi::lua_pushstring(state, c"stopped, as it ran for too long".as_ptr()) };
}

extern "C" fn on_signal(_: c_int) {
    let mut guard = GUARDS.get();
    // SAFETY: a guard leaves this list on this thread, before it is dropped.
    while let Some(found) = unsafe { guard.as_ref() } {
        found.arm();
        guard = found.next.load(Relaxed);
    }
}

#[cfg(target_os = "linux")]
fn signal() -> c_int {
    libc::SIGRTMIN() + 1
}

/// Without real-time signals, one that is ignored unless handled.
#[cfg(not(target_os = "linux"))]
fn signal() -> c_int {
    libc::SIGURG
}

fn handle_signal() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // SAFETY: the handler does only what is allowed in one; all zeroes are a valid sigaction.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            action.sa_sigaction = on_signal as extern "C" fn(c_int) as usize;
            action.sa_flags = libc::SA_RESTART | libc::SA_ONSTACK;
            libc::sigaction(signal(), &action, ptr::null_mut());
        }
    });
}

impl Watchdog {
    /// Watches the calls made on `main` by this thread.
    pub fn new(guard: Arc<Guard>, main: *mut ffi::lua_State) -> Self {
        guard.main.store(main, SeqCst);
        guard.next.store(GUARDS.get(), SeqCst);
        GUARDS.set(Arc::as_ptr(&guard).cast_mut());
        handle_signal();
        let watched = guard.clone();
        let thread = std::thread::Builder::new().name("lua watchdog".to_owned()).spawn(move || watch(&watched)).ok();
        Self { guard, thread }
    }

    pub fn emergency(&self) -> Emergency {
        Emergency(self.guard.clone())
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.guard.done.store(true, SeqCst);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // It can only have panicked, and then it sends no signal either.
            let _ = thread.join();
        }
        unlink(&self.guard);
    }
}

/// Takes a guard out of this thread's list.
fn unlink(guard: &Arc<Guard>) {
    let (gone, next) = (Arc::as_ptr(guard).cast_mut(), guard.next.load(SeqCst));
    if GUARDS.get() == gone {
        return GUARDS.set(next);
    }
    let mut at = GUARDS.get();
    // SAFETY: the guards in the list are live.
    while let Some(found) = unsafe { at.as_ref() } {
        if found.next.load(SeqCst) == gone {
            return found.next.store(next, SeqCst);
        }
        at = found.next.load(SeqCst);
    }
}

/// The longest time between two signals about one call.
const PATIENCE: Duration = Duration::from_secs(1);

fn watch(guard: &Guard) {
    let pause = (guard.limit / 10).clamp(Duration::from_millis(1), Duration::from_millis(25));
    let mut seen = (0, Instant::now());
    // When the call is signalled next, since it was first seen, and how long after that again.
    let first = pause * 4;
    let (mut due, mut gap) = (guard.limit, first);
    while !guard.done.load(SeqCst) {
        std::thread::park_timeout(pause);
        let call = guard.call.load(SeqCst);
        let elapsed = seen.1.elapsed();
        if call != seen.0 {
            seen = (call, Instant::now());
            (due, gap) = (guard.limit, first);
            guard.overdue.store(0, SeqCst);
        } else if !call.is_multiple_of(2)
            && let Some(over) = elapsed.checked_sub(guard.limit)
        {
            guard.overdue.store(over.as_micros().max(1) as u64, SeqCst);
            guard.target.store(call, SeqCst);
            if elapsed < due {
                continue;
            }
            // SAFETY: the thread lives: it owns the interpreter, and waits for this one before it lets go of it.
            // Sent again until the call ends: a coroutine may have begun just then. But ever more rarely: in a deep recursion
            // the handler takes long, and the call must get on between two of them to end.
            unsafe { libc::pthread_kill(guard.thread, signal()) };
            (due, gap) = (elapsed + gap, (gap * 2).min(PATIENCE));
        }
    }
}
