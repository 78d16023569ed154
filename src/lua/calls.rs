//! Calls of blocks, and what is said of those that fail. Knows nothing of what calls them.

use serde_json::Value;

use super::desk::Spot;
use super::round::End;
use super::stack::Trouble;
use super::value::{self, Bounds};
use super::{Block, Cell, Failure, FailureKind, Lua, Num, Ran, Slot, Test, message, text};

impl Lua {
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

    /// Evaluates conditions in order, each with the time of a call, until one isn't false: which, and what it came to.
    #[inline]
    pub fn test_all(&mut self, blocks: &[Block]) -> Option<(usize, Test)> {
        if let [block] = blocks {
            return Some((0, self.test(*block))).filter(|(_, test)| *test != Test::False);
        }
        let (at, end) = self.stack.test_all(blocks)?;
        let test = match end {
            End::True => Test::True,
            End::NotBoolean(kind) => Test::NotBoolean(text::type_name(kind)),
            End::Trouble(trouble) => {
                self.fail(blocks[at], trouble);
                Test::Failed
            }
        };
        Some((at, test))
    }

    /// Runs actions in order, each with the time of a call, until one fails: which.
    #[inline]
    pub fn run_all(&mut self, blocks: &[Block]) -> Option<usize> {
        if let [block] = blocks {
            return Some(0).filter(|_| self.run(*block) == Ran::Failed);
        }
        let (at, trouble) = self.stack.run_all(blocks)?;
        self.fail(blocks[at], trouble);
        Some(at)
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

    /// Whether the variable's value can be changed through another one that holds it too: a table or a function.
    #[inline]
    pub fn is_shared(&self, cell: Cell) -> bool {
        self.stack.is_shared(cell.0)
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
        self.eval_within(block, Bounds { depth: value::DEPTH, bytes: value::BYTES })
    }

    pub(super) fn eval_within(&mut self, block: Block, bounds: Bounds) -> Result<Value, Failure> {
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
        format!("stopped, as it ran for more than {} ms", self.limits.time.as_millis())
    }

    /// Frees what a call left behind. Where variables keep so much that little else could run, the limit is lifted.
    fn relieve(&mut self) -> String {
        // An error would come from a finalizer, and blocks can't have any.
        let _ = self.sandbox.mlua.gc_collect();
        let kept = self.memory();
        let mut message = format!("stopped, as more than {} of memory were in use", mebibytes(self.limits.memory));
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
        let named = self.slots.iter().enumerate().filter_map(|(slot, kind)| match kind {
            Slot::Variable { name: Some(name), .. } => Some((slot, &**name)),
            _ => None,
        });
        named.map(weight).max_by_key(|(weight, _)| *weight).map(|(_, name)| name)
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
}

fn mebibytes(bytes: usize) -> String {
    format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20))
}
