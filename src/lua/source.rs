//! From a block's text to Lua's bytecode, and to a function on Lua's stack. Knows nothing of calls and values.

use std::ffi::{c_int, c_void};
use std::fmt::{self, Display};

use mlua_sys as ffi;

use super::bytecode::{self, Read};
use super::desk::UNNAMED;
use super::message;

/// Why a text is no block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Without position; lines mentioned within count from the block's first.
    pub message: String,
    /// 1-based in the block's text.
    pub line: u32,
    /// What to look for in that line.
    pub token: Option<String>,
}

impl SyntaxError {
    pub(super) fn new(line: u32, message: String) -> Self {
        let token = message::token(&message);
        Self { message, line, token }
    }

    /// The message for a block whose first line is line `first` (from 1) of its file.
    pub fn message_in(&self, first: u32) -> String {
        message::move_lines(&self.message, first.saturating_sub(1))
    }

    fn is_at_end(&self) -> bool {
        self.message.ends_with("near <eof>")
    }
}

impl Display for SyntaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.line, self.message)
    }
}

impl std::error::Error for SyntaxError {}

/// How a block's text is to be taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Form {
    Expression,
    #[default]
    Statements,
}

impl Form {
    fn begin(self) -> &'static str {
        match self {
            Form::Expression => "return ",
            Form::Statements => "",
        }
    }
}

/// The most locals a Lua function can have.
pub(super) const NAMES: usize = 200;

/// The form of a text and the free names in it. Leaves the stack as it was.
///
/// # Safety
/// `state` is a live state that isn't running, with four free slots, and no memory limit.
pub(super) unsafe fn analyse(state: *mut ffi::lua_State, code: &str) -> Result<(Form, Read), SyntaxError> {
    let code = &one_line_ends(code);
    unsafe {
        let form = match load_as(state, code, Form::Expression) {
            Ok(()) => Form::Expression,
            Err(expression) => match load_as(state, code, Form::Statements) {
                Ok(()) => Form::Statements,
                Err(statements) => return Err(better(expression, statements)),
            },
        };
        Ok((form, bytecode::read(&take_dump(state)).unwrap_or_default()))
    }
}

/// The function on top of the stack as bytecode; takes it off.
unsafe fn take_dump(state: *mut ffi::lua_State) -> Vec<u8> {
    let mut dump = Vec::new();
    unsafe {
        ffi::lua_dump(state, write, (&raw mut dump).cast(), 0);
        ffi::lua_pop(state, 1);
    }
    dump
}

/// Of the two reasons, that of the attempt that came further: a text like `a > ` was meant as an expression.
fn better(expression: SyntaxError, statements: SyntaxError) -> SyntaxError {
    let further = expression.line > statements.line;
    let to_its_end = expression.line == statements.line && expression.is_at_end() && !statements.is_at_end();
    // `x > 1 && ..`: an expression never is a statement, so that attempt failed at once.
    let no_statement = expression.line == statements.line
        && statements.message.starts_with("syntax error near")
        && expression.token != statements.token;
    if further || to_its_end || no_statement { expression } else { statements }
}

unsafe fn load_as(state: *mut ffi::lua_State, code: &str, form: Form) -> Result<(), SyntaxError> {
    unsafe { load(state, format!("{}{code}", form.begin()).as_bytes(), Written::Text) }
}

/// Lua takes `\n\r` for one line's end, editors for two.
fn one_line_ends(code: &str) -> String {
    code.replace("\r\n", "\n").replace('\r', "\n")
}

/// The bytecode of a block's function, as one of a text in which `names` are locals: its upvalues, to be joined with the
/// variables. Leaves the stack as it was.
///
/// # Safety
/// As for `analyse`.
pub(super) unsafe fn build(
    state: *mut ffi::lua_State,
    code: &str,
    form: Form,
    names: &[&str],
) -> Result<Vec<u8>, SyntaxError> {
    let locals = if names.is_empty() { String::new() } else { format!("local {} ", names.join(",")) };
    let text = format!("{locals}return function() {}{}\nend", form.begin(), one_line_ends(code));
    unsafe {
        load(state, text.as_bytes(), Written::Text)?;
        match ffi::lua_pcallk(state, 0, 1, 0, 0, None) {
            ffi::LUA_OK => Ok(take_dump(state)),
            _ => Err(take_error(state)),
        }
    }
}

/// Pushes the function of a block's bytecode; each of its upvalues is one of its own.
///
/// # Safety
/// As for `analyse`; the bytecode was made by `build`, and is whole.
pub(super) unsafe fn load_built(state: *mut ffi::lua_State, bytecode: &[u8]) -> Result<(), SyntaxError> {
    unsafe { load(state, bytecode, Written::Bytecode) }
}

#[derive(Clone, Copy)]
enum Written {
    Text,
    Bytecode,
}

unsafe fn load(state: *mut ffi::lua_State, chunk: &[u8], written: Written) -> Result<(), SyntaxError> {
    let mode = match written {
        Written::Text => c"t",
        Written::Bytecode => c"b",
    };
    unsafe {
        match ffi::luaL_loadbufferx(state, chunk.as_ptr().cast(), chunk.len(), UNNAMED.as_ptr(), mode.as_ptr()) {
            ffi::LUA_OK => Ok(()),
            _ => Err(take_error(state)),
        }
    }
}

unsafe fn take_error(state: *mut ffi::lua_State) -> SyntaxError {
    let text = unsafe {
        let mut length = 0;
        let bytes = ffi::lua_tolstring(state, -1, &mut length);
        let bytes: &[u8] = if bytes.is_null() { b"" } else { std::slice::from_raw_parts(bytes.cast(), length) };
        String::from_utf8_lossy(bytes).into_owned()
    };
    unsafe { ffi::lua_pop(state, 1) };
    let (spot, message) = message::split_position(&text);
    SyntaxError::new(spot.map_or(1, |spot| spot.line), message.to_owned())
}

unsafe extern "C-unwind" fn write(
    _: *mut ffi::lua_State,
    bytes: *const c_void,
    length: usize,
    dump: *mut c_void,
) -> c_int {
    unsafe { (*dump.cast::<Vec<u8>>()).extend_from_slice(std::slice::from_raw_parts(bytes.cast(), length)) };
    0
}
