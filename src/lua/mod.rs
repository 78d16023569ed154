//! Lua for blocks: variables that blocks share, blocks compiled once and called often, each call on its own, within limits of time and
//! memory, and nothing at hand that reaches outside. Knows nothing of machines, files or clocks.
//!
//! A variable is an upvalue that blocks share; a block is a function on Lua's stack. Both are what Lua itself is fastest at.

mod bounded;
mod bytecode;
mod coroutines;
mod desk;
mod facts;
mod failure;
mod fingerprint;
mod guard;
mod log;
mod message;
mod nearest;
mod sandbox;
mod source;
mod stack;
mod text;
mod value;
mod weight;

use std::rc::Rc;
use std::time::Duration;

use serde_json::Value;

pub use facts::{Checker, Facts, NameUse, known_fields, known_names};
pub use failure::{Failure, FailureKind};
pub use guard::Emergency;
pub use log::{Level, LogLine};
pub use source::SyntaxError;

use desk::{Chunk, Desk, Spot};
use fingerprint::Fingerprint;
use guard::{Guard, Watchdog};
use sandbox::Sandbox;
use stack::{Stack, Trouble};
use value::Bounds;

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
        Self {
            time: Duration::from_millis(250),
            memory: 64 << 20,
        }
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
    Variable {
        seen: Fingerprint,
        name: Option<Box<str>>,
    },
    Block {
        chunk: u32,
        writes: Box<[Cell]>,
    },
}

/// One interpreter, owned by one thread.
pub struct Lua {
    // Dropped first: it must not signal once the interpreter is gone.
    watchdog: Watchdog,
    stack: Stack,
    slots: Vec<Slot>,
    chunks: u32,
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
        Ok(Self {
            watchdog,
            stack,
            slots: Vec::new(),
            chunks: 0,
            failure: None,
            limits,
            desk,
            sandbox,
        })
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

    /// A new variable, nil.
    pub fn cell(&mut self) -> Cell {
        let slot = self.unlimited(|lua| lua.stack.make_cell());
        self.note_slot(
            slot,
            Slot::Variable {
                seen: Fingerprint::NIL,
                name: None,
            },
        );
        Cell(slot)
    }

    /// Gives a variable up; its number may be used again. Blocks that use it keep it until they are freed.
    pub fn free_cell(&mut self, cell: Cell) {
        self.note_slot(cell.0, Slot::Empty);
        self.stack.release(cell.0);
    }

    /// A variable's value, for display.
    ///
    /// Integers and floats as such, nan and infinities as strings; functions, threads and userdata as `{"lua":"function"}`; a table with the keys 1..n as
    /// an array, others as an object, keys sorted; to four levels and about 1 KB, `"cut"` says how many entries were left out.
    pub fn get(&self, cell: Cell) -> Value {
        self.stack.value(cell.0)
    }

    /// Gives a variable a value.
    pub fn set(&mut self, cell: Cell, value: &Value) {
        self.unlimited(|lua| lua.stack.set(cell.0, value));
    }

    /// Makes a variable nil.
    pub fn clear(&mut self, cell: Cell) {
        self.stack.set(cell.0, &Value::Null);
    }

    /// Whether a variable has changed since this or [`note`](Self::note) was last called for it; at first, since it was nil. A table's order
    /// doesn't count, nor what is more than four levels deep.
    #[inline]
    pub fn changed(&mut self, cell: Cell) -> bool {
        let now = self.stack.fingerprint(cell.0);
        match &mut self.slots[cell.0 as usize] {
            Slot::Variable { seen, .. } => std::mem::replace(seen, now) != now,
            _ => false,
        }
    }

    /// Takes a variable's value as seen.
    pub fn note(&mut self, cell: Cell) {
        self.changed(cell);
    }

    /// Makes a block of a text: an expression, or statements. `scope`: the variables it can use, inner last.
    ///
    /// # Errors
    /// The text is neither, or assigns something built in, or uses more than 200 variables.
    pub fn compile(&mut self, code: &str, scope: &[(&str, Cell)]) -> Result<Block, SyntaxError> {
        self.unlimited(|lua| lua.compile_unlimited(code, scope))
    }

    fn compile_unlimited(
        &mut self,
        code: &str,
        scope: &[(&str, Cell)],
    ) -> Result<Block, SyntaxError> {
        // SAFETY: nothing runs, and there is no memory limit.
        let (form, uses) = unsafe { source::analyse(self.stack.state(), code)? };
        let bound = self.bind(&uses, scope)?;
        let names: Vec<_> = bound.iter().map(|&(name, _)| name).collect();
        self.chunks += 1;
        let chunk = self.chunks;
        // SAFETY: as before.
        unsafe { source::build(self.stack.state(), code, form, &names, chunk)? };
        self.stack.join(|name| {
            bound
                .iter()
                .find(|(found, _)| *found == name)
                .map(|(_, cell)| cell.0)
        });
        let block = Block(self.stack.keep());
        let is_written = |name: &str| {
            uses.iter()
                .any(|found| found.kind == bytecode::Kind::Write && found.name == name)
        };
        let writes = bound
            .iter()
            .filter(|(name, _)| is_written(name))
            .map(|&(_, cell)| cell)
            .collect();
        self.note_slot(block.0, Slot::Block { chunk, writes });
        let scope = scope.iter().map(|&(name, _)| name.into()).collect();
        self.desk.chunks.borrow_mut().insert(
            chunk,
            Chunk {
                block: Some(block),
                place: None,
                scope,
            },
        );
        Ok(block)
    }

    /// The variables among the free names of a text, each once.
    fn bind<'a>(
        &mut self,
        uses: &[bytecode::Use],
        scope: &[(&'a str, Cell)],
    ) -> Result<Vec<(&'a str, Cell)>, SyntaxError> {
        let mut bound: Vec<(&str, Cell)> = Vec::new();
        for found in uses {
            let Some(&(name, cell)) = scope.iter().rev().find(|(name, _)| *name == found.name)
            else {
                self.check_builtin(found)?;
                continue;
            };
            if bound.iter().any(|(other, _)| *other == name) {
                continue;
            }
            bound.push((name, cell));
            if bound.len() > source::NAMES {
                let message = format!(
                    "more than {} variables in one block: move some into a table",
                    source::NAMES
                );
                return Err(SyntaxError {
                    message,
                    line: found.line,
                    token: Some(name.to_owned()),
                });
            }
            if let Slot::Variable { name: known, .. } = &mut self.slots[cell.0 as usize] {
                known.get_or_insert_with(|| name.into());
            }
        }
        Ok(bound)
    }

    /// What is built in is there for all blocks, so none may replace it.
    fn check_builtin(&self, found: &bytecode::Use) -> Result<(), SyntaxError> {
        let builtin =
            found.kind == bytecode::Kind::Write && self.desk.known.borrow().contains(&found.name);
        if !builtin {
            return Ok(());
        }
        let message = format!(
            "'{}' is built in and can't be assigned to; use another name",
            found.name
        );
        Err(SyntaxError {
            message,
            line: found.line,
            token: Some(found.name.clone()),
        })
    }

    /// Gives a block up; its number may be used again.
    pub fn free_block(&mut self, block: Block) {
        if let Some(chunk) = self.chunk(block)
            && let Some(chunk) = self.desk.chunks.borrow_mut().get_mut(&chunk)
        {
            chunk.block = None;
        }
        self.note_slot(block.0, Slot::Empty);
        self.stack.release(block.0);
    }

    fn chunk(&self, block: Block) -> Option<u32> {
        match self.slots.get(block.0 as usize)? {
            Slot::Block { chunk, .. } => Some(*chunk),
            _ => None,
        }
    }

    /// Where a block is: its first line is line `first_line` (from 1) of `file`. To be called again when an edit moved it.
    pub fn set_place(&mut self, block: Block, file: &str, first_line: u32) {
        if let Some(chunk) = self.chunk(block)
            && let Some(chunk) = self.desk.chunks.borrow_mut().get_mut(&chunk)
        {
            chunk.place = Some((file.into(), first_line));
        }
    }

    /// A text made by a block, with the positions in it as users know them: `x.lrp:14:`. For what leaves Lua by a way of its own.
    pub fn relocate(&self, text: &str) -> String {
        message::relocate(text, &self.desk)
    }

    /// Evaluates a condition.
    #[inline]
    pub fn test(&mut self, block: Block) -> Test {
        if let Err(trouble) = self.stack.call(block.0, 1) {
            self.fail(block, trouble);
            return Test::Failed;
        }
        let result = match self.stack.result_type() {
            mlua_sys::LUA_TBOOLEAN if self.stack.result_bool() => Test::True,
            mlua_sys::LUA_TBOOLEAN => Test::False,
            other => Test::NotBoolean(text::type_name(other)),
        };
        self.stack.drop_results();
        result
    }

    /// Runs an action; its value is dropped.
    #[inline]
    pub fn run(&mut self, block: Block) -> Ran {
        match self.stack.call(block.0, 0) {
            Ok(()) => Ran::Done,
            Err(trouble) => {
                self.fail(block, trouble);
                Ran::Failed
            }
        }
    }

    /// Evaluates a number.
    #[inline]
    pub fn number(&mut self, block: Block) -> Num {
        if let Err(trouble) = self.stack.call(block.0, 1) {
            self.fail(block, trouble);
            return Num::Failed;
        }
        let result = match self.stack.result_type() {
            mlua_sys::LUA_TNUMBER => Num::Number(self.stack.result_number()),
            other => Num::NotNumber(text::type_name(other)),
        };
        self.stack.drop_results();
        result
    }

    /// A variable's value, if it is a number.
    #[inline]
    pub fn number_in(&self, cell: Cell) -> Option<f64> {
        self.stack.number(cell.0)
    }

    /// Evaluates a block into a variable, which stays as it was if that fails.
    pub fn init(&mut self, block: Block, cell: Cell) -> Ran {
        match self.stack.call(block.0, 1) {
            Ok(()) => {
                self.stack.result_into(cell.0);
                Ran::Done
            }
            Err(trouble) => {
                self.fail(block, trouble);
                Ran::Failed
            }
        }
    }

    /// Evaluates a block, for display; the value is as [`get`](Self::get) has it.
    ///
    /// # Errors
    /// The call failed.
    pub fn eval(&mut self, block: Block) -> Result<Value, Failure> {
        self.eval_within(
            block,
            Bounds {
                depth: value::DEPTH,
                bytes: value::BYTES,
            },
        )
    }

    fn eval_within(&mut self, block: Block, bounds: Bounds) -> Result<Value, Failure> {
        if let Err(trouble) = self.stack.call(block.0, 1) {
            self.fail(block, trouble);
            return Err(self.take_failure());
        }
        let value = self.stack.result(bounds);
        self.stack.drop_results();
        Ok(value)
    }

    #[cold]
    fn fail(&mut self, block: Block, trouble: Trouble) {
        let raised = self.desk.fault.take();
        let text = self.unlimited(|lua| lua.stack.take_error());
        let (said, text) = message::split_position(&text);
        let (kind, message) = match trouble {
            Trouble::Error => (FailureKind::Runtime, message::relocate(text, &self.desk)),
            Trouble::OverTime => (FailureKind::OverTime, self.over_time()),
            Trouble::OverMemory => (FailureKind::OverMemory, self.relieve()),
        };
        let called = self.chunk(block).map(|chunk| Spot { chunk, line: 1 });
        let spot = said.or(raised).or(called);
        let token = message::token(&message).filter(|_| kind == FailureKind::Runtime);
        self.failure = Some(Failure {
            kind,
            message,
            block: self.desk.block(spot),
            line: spot.map_or(1, |spot| spot.line),
            token,
        });
    }

    fn over_time(&self) -> String {
        format!(
            "stopped, as it ran for more than {} ms",
            self.limits.time.as_millis()
        )
    }

    /// Frees what a call left behind. Where variables keep so much that little else could run, the limit is lifted.
    fn relieve(&mut self) -> String {
        // An error would come from a finalizer, and blocks can't have any.
        let _ = self.sandbox.mlua.gc_collect();
        let kept = self.memory();
        let mut message = format!(
            "stopped, as more than {} of memory were in use",
            mebibytes(self.limits.memory)
        );
        let mut limit = self.limits.memory;
        if kept > limit / 2 {
            limit += kept;
            message += &format!("; variables keep {} of them", mebibytes(kept));
            if let Some(name) = self.heaviest() {
                message += &format!(", most of it '{name}'");
            }
        }
        let _ = self.sandbox.mlua.set_memory_limit(limit);
        message
    }

    /// The name of the variable that keeps the most.
    fn heaviest(&self) -> Option<&str> {
        let weight = |(slot, name)| (self.stack.weight(slot as u32), name);
        let named = self
            .slots
            .iter()
            .enumerate()
            .filter_map(|(slot, kind)| match kind {
                Slot::Variable {
                    name: Some(name), ..
                } => Some((slot, &**name)),
                _ => None,
            });
        named
            .map(weight)
            .max_by_key(|(weight, _)| *weight)
            .map(|(_, name)| name)
    }

    /// Why the last call failed.
    ///
    /// # Panics
    /// If no call has failed since this was last called.
    pub fn take_failure(&mut self) -> Failure {
        match self.failure.take() {
            Some(failure) => failure,
            None => panic!("no call has failed"),
        }
    }

    /// The variables a block can assign. What it does to a table in a variable isn't among that.
    pub fn writes(&self, block: Block) -> &[Cell] {
        match self.slots.get(block.0 as usize) {
            Some(Slot::Block { writes, .. }) => writes,
            _ => &[],
        }
    }

    /// Sets program time, in milliseconds.
    #[inline]
    pub fn now(&mut self, ms: f64) {
        self.desk.now.set(ms);
    }

    /// Sets when the state was entered that `elapsed()` counts from, in milliseconds.
    #[inline]
    pub fn since(&mut self, ms: f64) {
        self.desk.since.set(ms);
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
    pub fn library(&mut self, find: Box<dyn Fn(&str) -> Result<String, String>>) {
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

fn mebibytes(bytes: usize) -> String {
    format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20))
}
