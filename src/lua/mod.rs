//! Lua for blocks: variables that blocks share, blocks compiled once and called often, each call on its own, within limits of time and
//! memory, and nothing at hand that reaches outside. Knows nothing of machines, files or clocks.
//!
//! A variable is an upvalue that blocks share; a block is a function on Lua's stack. Both are what Lua itself is fastest at.

mod base;
mod blocks;
mod bounded;
mod bytecode;
mod calls;
mod coroutines;
mod desk;
mod facts;
mod failure;
mod fingerprint;
mod guard;
mod instruction;
mod known;
mod log;
mod message;
mod pattern;
mod precompiled;
mod registers;
mod round;
mod sandbox;
mod search;
mod source;
mod stack;
mod text;
mod value;
mod variables;
mod weight;

use std::rc::Rc;
use std::time::Duration;

pub use facts::{Checker, Facts, NameUse, SYSTEM, known_fields, known_names};
pub use failure::{Failure, FailureKind};
pub use guard::Emergency;
pub use log::{Level, LogLine};
pub use precompiled::Precompiled;
pub use registers::{FieldKind, FieldUse, Gives};
pub use sandbox::Finder;
pub use source::SyntaxError;
pub use value::device_mark;

use desk::Desk;
use fingerprint::Fingerprint;
use guard::{Guard, Watchdog};
use sandbox::Sandbox;
use stack::Stack;

/// What a block may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// How long one call of a block may take.
    pub time: Duration,
    /// Bytes all values together may take.
    pub memory: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { time: Duration::from_millis(250), memory: 64 << 20 }
    }
}

/// What a block may reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Nothing outside the program.
    Sandboxed,
    /// Files, processes and the interpreter's inside: `io`, `os` and `debug` as Lua has them, but for the time.
    System,
}

/// A variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Cell(u32);

/// A compiled block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Block(u32);

/// What a condition came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    True,
    False,
    /// Something else, of this type.
    NotBoolean(&'static str),
    Failed,
}

/// How an action went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ran {
    Done,
    Failed,
}

/// What a number came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Num {
    Number(f64),
    /// Something else, of this type.
    NotNumber(&'static str),
    Failed,
}

/// What is known of a slot of the stack.
enum Slot {
    Empty,
    Variable { seen: Fingerprint, name: Option<Box<str>> },
    Block { chunk: u32, writes: Box<[Cell]> },
}

/// One interpreter, owned by one thread.
pub struct Lua {
    // Dropped first: it must not signal once the interpreter is gone.
    watchdog: Watchdog,
    stack: Stack,
    slots: Vec<Slot>,
    failure: Option<Failure>,
    limits: Limits,
    desk: Rc<Desk>,
    sandbox: Sandbox,
}

impl Lua {
    /// An interpreter in which two runs with the same `seed` do the same.
    ///
    /// # Panics
    /// If there isn't the memory for it.
    pub fn new(limits: Limits, access: Access, seed: u64) -> Self {
        match Self::start(limits, access, seed) {
            Ok(lua) => lua,
            Err(error) => panic!("Lua doesn't start: {error}"),
        }
    }

    fn start(limits: Limits, access: Access, seed: u64) -> mlua::Result<Self> {
        let guard = Guard::new(limits.time);
        let desk = Rc::new(Desk::new(guard.clone()));
        let sandbox = Sandbox::new(access, &desk, seed)?;
        let stack = Stack::new(&sandbox.mlua, guard.clone())?;
        sandbox.mlua.set_memory_limit(limits.memory)?;
        let watchdog = Watchdog::new(guard, stack.state());
        Ok(Self { watchdog, stack, slots: Vec::new(), failure: None, limits, desk, sandbox })
    }

    /// Does what Lua itself needs memory for, whatever variables hold.
    fn unlimited<R>(&mut self, f: impl FnOnce(&mut Self) -> R) -> R {
        let limit = self.sandbox.mlua.set_memory_limit(0).unwrap_or(0);
        let result = f(self);
        // It fails only for an interpreter without limits, which this one isn't.
        let _ = self.sandbox.mlua.set_memory_limit(limit);
        result
    }

    fn note_slot(&mut self, at: u32, slot: Slot) {
        let at = at as usize;
        if self.slots.len() <= at {
            self.slots.resize_with(at + 1, || Slot::Empty);
        }
        self.slots[at] = slot;
    }

    /// Sets program time, in microseconds.
    #[inline]
    pub fn now(&mut self, us: u64) {
        self.desk.now.set(us);
    }

    /// Sets when the state was entered that `elapsed()` counts from, in microseconds.
    #[inline]
    pub fn since(&mut self, us: u64) {
        self.desk.since.set(us);
    }

    #[inline]
    pub fn has_logs(&self) -> bool {
        !self.desk.log.is_empty()
    }

    /// What blocks wrote since this was last called, in order; at most 1,000 lines.
    pub fn take_logs(&mut self) -> Vec<LogLine> {
        let desk = &self.desk;
        let line = |written: log::Written| LogLine {
            level: written.level,
            message: message::relocate(&written.message, desk),
            block: desk.block(written.spot),
            line: written.spot.map_or(0, |spot| spot.line),
        };
        desk.log.take().into_iter().map(line).collect()
    }

    /// How `require` finds the text of a module, by its name; or why it doesn't. A module is loaded once.
    pub fn library(&mut self, find: Finder) {
        let set = self.unlimited(|lua| lua.sandbox.set_finder(find));
        debug_assert!(set.is_ok(), "there is no memory limit");
    }

    /// Has a module's text read again when it is next required.
    pub fn forget(&mut self, module: &str) {
        let unset = self.unlimited(|lua| lua.sandbox.loaded.raw_set(module, mlua::Value::Nil));
        debug_assert!(unset.is_ok(), "there is no memory limit");
    }

    /// Adds a name to what every block sees, those compiled before as well.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn global(
        &mut self,
        name: &str,
        make: impl FnOnce(&mlua::Lua) -> mlua::Result<mlua::Value>,
    ) -> mlua::Result<()> {
        self.unlimited(|lua| {
            let value = make(&lua.sandbox.mlua)?;
            lua.desk.known.borrow_mut().insert(name.to_owned());
            lua.sandbox.environment.raw_set(name, value)
        })
    }

    pub fn mlua(&self) -> &mlua::Lua {
        &self.sandbox.mlua
    }

    /// Bytes in use by all values.
    pub fn memory(&self) -> usize {
        self.sandbox.mlua.used_memory()
    }

    /// What tells another thread that a block can't be stopped.
    pub fn emergency(&self) -> Emergency {
        self.watchdog.emergency()
    }
}
