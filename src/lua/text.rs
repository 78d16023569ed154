//! Values as text, the same in every run: no addresses. Knows nothing of who reads it.

use std::ffi::{CStr, c_int};

use mlua_sys as ffi;

use super::value;

/// Lua's `tostring`: a table is `table`, where Lua would add its address.
pub(super) unsafe extern "C-unwind" fn tostring(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::luaL_checkany(state, 1);
        push_text(state, 1);
        1
    }
}

/// Pushes the value at `index` as text.
///
/// # Safety
/// Called from C that Lua called; can raise an error.
pub(super) unsafe fn push_text(state: *mut ffi::lua_State, index: c_int) {
    unsafe {
        if has_own_text(state, index) {
            ffi::luaL_tolstring(state, index, std::ptr::null_mut());
            if ffi::lua_type(state, index) == ffi::LUA_TUSERDATA {
                drop_traceback(state);
            }
        } else if ffi::luaL_getmetafield(state, index, c"__name".as_ptr()) != ffi::LUA_TSTRING {
            ffi::lua_pushstring(state, ffi::luaL_typename(state, index));
        }
    }
}

/// The same, but a table without a text of its own shows what is in it.
///
/// # Safety
/// As for `push_text`.
pub(super) unsafe fn push_shown(state: *mut ffi::lua_State, index: c_int) {
    unsafe {
        if ffi::lua_type(state, index) != ffi::LUA_TTABLE || has_own_text(state, index) {
            return push_text(state, index);
        }
        push_json(state, index);
    }
}

/// Pushes what an error says; calls no metamethods but those of errors from Rust.
///
/// # Safety
/// As for `push_text`.
pub(super) unsafe fn push_error(state: *mut ffi::lua_State, index: c_int) {
    unsafe {
        match ffi::lua_type(state, index) {
            ffi::LUA_TTABLE => push_json(state, index),
            ffi::LUA_TFUNCTION | ffi::LUA_TTHREAD => {
                ffi::lua_pushstring(state, ffi::luaL_typename(state, index));
            }
            _ => push_text(state, index),
        }
    }
}

unsafe fn push_json(state: *mut ffi::lua_State, index: c_int) {
    // The text is cut to a buffer of fixed size: an error raised by the push must not skip a destructor.
    let mut buffer = [0; 2 * value::BYTES];
    let length = {
        let text = unsafe { value::read(state, index) }.to_string();
        let length = cut(&text, buffer.len());
        buffer[..length].copy_from_slice(&text.as_bytes()[..length]);
        length
    };
    unsafe { ffi::lua_pushlstring(state, buffer.as_ptr().cast(), length) };
}

/// Whether Lua's own text of the value holds no address.
unsafe fn has_own_text(state: *mut ffi::lua_State, index: c_int) -> bool {
    unsafe {
        match ffi::lua_type(state, index) {
            ffi::LUA_TNIL | ffi::LUA_TBOOLEAN | ffi::LUA_TNUMBER | ffi::LUA_TSTRING => true,
            _ => {
                let found = ffi::luaL_getmetafield(state, index, c"__tostring".as_ptr()) != ffi::LUA_TNIL;
                ffi::lua_pop(state, found.into());
                found
            }
        }
    }
}

/// How errors from Rust begin.
const KIND: &[u8] = b"runtime error: ";

/// Errors from Rust carry their kind and a traceback, which are nothing for users.
unsafe fn drop_traceback(state: *mut ffi::lua_State) {
    unsafe {
        let mut length = 0;
        let bytes: *const u8 = ffi::lua_tolstring(state, -1, &mut length).cast();
        let text = std::slice::from_raw_parts(bytes, length);
        let end = b"\nstack traceback:";
        let end = text.windows(end.len()).position(|window| window == end).unwrap_or(length);
        let begin = if text.starts_with(KIND) { KIND.len() } else { 0 };
        ffi::lua_pushlstring(state, bytes.add(begin).cast(), end - begin);
        ffi::lua_replace(state, -2);
    }
}

/// `string.format`, which would show addresses by `%s` and `%p`.
pub(super) unsafe extern "C-unwind" fn format(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let mut length = 0;
        let bytes = ffi::luaL_checklstring(state, 1, &mut length);
        let form = std::slice::from_raw_parts(bytes.cast::<u8>(), length);
        let (mut at, mut argument) = (0, 1);
        while let Some(conversion) = next_conversion(form, &mut at) {
            argument += 1;
            if conversion == b'p' {
                return ffi::luaL_error(state, c"'%%p' shows an address, which differs in every run".as_ptr());
            }
            if conversion == b's' && argument <= ffi::lua_gettop(state) {
                push_text(state, argument);
                ffi::lua_replace(state, argument);
            }
        }
        super::sandbox::originals().format(state)
    }
}

/// The letter of the next conversion from `at` on, `%%` left out.
fn next_conversion(form: &[u8], at: &mut usize) -> Option<u8> {
    while let Some(&byte) = form.get(*at) {
        *at += 1;
        if byte != b'%' {
            continue;
        }
        while form.get(*at).is_some_and(|byte| b"-+ #0123456789.".contains(byte)) {
            *at += 1;
        }
        let letter = *form.get(*at)?;
        *at += 1;
        if letter != b'%' {
            return Some(letter);
        }
    }
    None
}

/// How many bytes of a text fit, whole characters only.
pub(super) fn cut(text: &str, bytes: usize) -> usize {
    (0..=bytes.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// The name of a type, as Lua has it.
pub(super) fn type_name(kind: c_int) -> &'static str {
    // SAFETY: lua_typename doesn't look at the state and returns a static string for each type.
    let name = unsafe { CStr::from_ptr(ffi::lua_typename(std::ptr::null_mut(), kind)) };
    name.to_str().unwrap_or("value")
}
