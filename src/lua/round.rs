//! Several blocks called one after another in one protected call, so that what protecting costs is paid once. One that fails
//! ends the round; the caller begins another behind it. Knows nothing of what blocks are for.

use std::ffi::{c_int, c_void};

use mlua_sys as ffi;

use super::Block;
use super::guard::Guard;
use super::stack::{SPARE, Stack, Trouble};

/// Blocks called in one round at most: each needs a slot of the stack.
const LONGEST: usize = SPARE as usize / 2;

/// What came of the block that ended a round before all were called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    True,
    /// Of this type, not true or false.
    NotBoolean(c_int),
    /// The error is on the stack until it is taken.
    Trouble(Trouble),
}

/// How far a round came: outside of the protected call, so that it is known after an error.
struct Round<'a> {
    guard: &'a Guard,
    left: usize,
    end: Option<End>,
}

impl Stack {
    /// Evaluates conditions in order, until one isn't false: which, and what it is instead.
    #[inline]
    pub fn test_all(&self, blocks: &[Block]) -> Option<(usize, End)> {
        self.rounds(blocks, test_round)
    }

    /// Calls blocks in order, until one fails: which, and why.
    #[inline]
    pub fn run_all(&self, blocks: &[Block]) -> Option<(usize, Trouble)> {
        match self.rounds(blocks, run_round)? {
            (at, End::Trouble(trouble)) => Some((at, trouble)),
            _ => None,
        }
    }

    #[inline]
    fn rounds(&self, blocks: &[Block], calls: ffi::lua_CFunction) -> Option<(usize, End)> {
        if blocks.len() > LONGEST { self.many_rounds(blocks, calls) } else { self.round(blocks, calls) }
    }

    #[cold]
    fn many_rounds(&self, blocks: &[Block], calls: ffi::lua_CFunction) -> Option<(usize, End)> {
        let (first, rest) = blocks.split_at(LONGEST);
        let ended = self.round(first, calls);
        ended.or_else(|| self.rounds(rest, calls).map(|(at, end)| (LONGEST + at, end)))
    }

    fn round(&self, blocks: &[Block], calls: ffi::lua_CFunction) -> Option<(usize, End)> {
        let mut round = Round { guard: self.guard(), left: blocks.len(), end: None };
        let state = self.state();
        // SAFETY: so many slots are free.
        unsafe {
            ffi::lua_pushcclosure(state, calls, 0);
            ffi::lua_pushlightuserdata(state, (&raw mut round).cast::<c_void>());
            for block in blocks.iter().rev() {
                ffi::lua_pushvalue(state, block.0 as c_int);
            }
        }
        if let Err(trouble) = self.protected(1 + blocks.len() as c_int, 0) {
            round.end = Some(End::Trouble(trouble));
        }
        round.end.map(|end| (blocks.len() - round.left, end))
    }
}

/// Arguments: a round, and its functions, the first on top.
unsafe extern "C-unwind" fn test_round(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let round = &mut *ffi::lua_touserdata(state, 1).cast::<Round>();
        while round.left > 0 {
            ffi::lua_callk(state, 0, 1, 0, None);
            round.end = match ffi::lua_type(state, -1) {
                ffi::LUA_TBOOLEAN if ffi::lua_toboolean(state, -1) == 0 => None,
                ffi::LUA_TBOOLEAN => Some(End::True),
                other => Some(End::NotBoolean(other)),
            };
            if round.end.is_some() || !round.next() {
                break;
            }
            ffi::lua_settop(state, -2);
        }
        0
    }
}

/// As `test_round`; the functions' values are dropped.
unsafe extern "C-unwind" fn run_round(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let round = &mut *ffi::lua_touserdata(state, 1).cast::<Round>();
        while round.left > 0 {
            ffi::lua_callk(state, 0, 0, 0, None);
            if !round.next() {
                break;
            }
        }
        0
    }
}

impl Round<'_> {
    /// On to the next block, with time of its own; unless the one before ended while it was being stopped.
    #[inline]
    fn next(&mut self) -> bool {
        let goes_on = self.guard.next();
        self.left -= usize::from(goes_on);
        goes_on
    }
}
