//! `print` and `log`: lines kept until the engine takes them. Knows nothing of files.

use std::cell::{Cell, RefCell};
use std::ffi::c_int;

use mlua_sys as ffi;

use super::desk::{Spot, desk, spot};
use super::text;

/// How much a line of the log matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    Debug,
    Info,
    Warn,
    Error,
}

/// A line a block wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogLine {
    pub level: Level,
    pub message: String,
    /// The block that wrote it, unless it is gone.
    pub block: Option<super::Block>,
    /// 1-based in the block's text; 0 where that is unknown.
    pub line: u32,
}

/// Lines kept at most between two looks: a loop that prints must not fill the memory.
const LINES: usize = 1_000;
/// Bytes kept of a line.
const LENGTH: usize = 8 * 1024;

#[derive(Default)]
pub(super) struct Log {
    lines: RefCell<Vec<Written>>,
    left_out: Cell<u64>,
}

pub(super) struct Written {
    pub level: Level,
    pub message: String,
    pub spot: Option<Spot>,
}

impl Log {
    pub fn is_empty(&self) -> bool {
        self.lines.borrow().is_empty()
    }

    /// The lines written since the last time; where too many were, the last one says so.
    pub fn take(&self) -> Vec<Written> {
        let mut lines = self.lines.take();
        let left_out = self.left_out.take();
        if left_out > 0 {
            lines.push(Written {
                level: Level::Warn,
                message: format!("{left_out} more lines were left out"),
                spot: None,
            });
        }
        lines
    }

    fn write(&self, level: Level, bytes: &[u8], spot: Option<Spot>) {
        let mut lines = self.lines.borrow_mut();
        if lines.len() >= LINES {
            self.left_out.set(self.left_out.get() + 1);
            return;
        }
        let cut = &bytes[..bytes.len().min(LENGTH)];
        let mut message = String::from_utf8_lossy(cut).into_owned();
        if cut.len() < bytes.len() {
            message.push('…');
        }
        lines.push(Written { level, message, spot });
    }
}

pub(super) unsafe extern "C-unwind" fn debug(state: *mut ffi::lua_State) -> c_int {
    unsafe { write(state, Level::Debug) }
}

pub(super) unsafe extern "C-unwind" fn info(state: *mut ffi::lua_State) -> c_int {
    unsafe { write(state, Level::Info) }
}

pub(super) unsafe extern "C-unwind" fn warn(state: *mut ffi::lua_State) -> c_int {
    unsafe { write(state, Level::Warn) }
}

pub(super) unsafe extern "C-unwind" fn error(state: *mut ffi::lua_State) -> c_int {
    unsafe { write(state, Level::Error) }
}

/// Writes the arguments, tabs between them. All that can raise an error comes before Rust owns anything.
unsafe fn write(state: *mut ffi::lua_State, level: Level) -> c_int {
    unsafe {
        let count = ffi::lua_gettop(state);
        ffi::luaL_checkstack(state, 2 * count + 2, c"too many values to print".as_ptr());
        for argument in 1..=count {
            if argument > 1 {
                ffi::lua_pushstring(state, c"\t".as_ptr());
            }
            text::push_shown(state, argument);
        }
        ffi::lua_concat(state, (2 * count - 1).max(0));
        let mut length = 0;
        let bytes = ffi::lua_tolstring(state, -1, &mut length);
        desk(state).log.write(level, std::slice::from_raw_parts(bytes.cast(), length), spot(state));
        0
    }
}
