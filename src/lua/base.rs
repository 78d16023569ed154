//! Base functions that differ from Lua's, and what is said of unknown names. Knows nothing of what else is at hand.

use std::ffi::c_int;

use mlua_sys as ffi;

use super::desk::{desk, spot};
use super::sandbox::originals;
use super::text;

pub(super) unsafe extern "C-unwind" fn now(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::lua_pushnumber(state, desk(state).now_ms());
        1
    }
}

pub(super) unsafe extern "C-unwind" fn elapsed(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::lua_pushnumber(state, desk(state).elapsed_ms());
        1
    }
}

/// Of text only: bytecode can be made to do anything.
pub(super) unsafe extern "C-unwind" fn load(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::luaL_checkany(state, 1);
        if ffi::lua_gettop(state) < 3 {
            ffi::lua_settop(state, 3);
        }
        ffi::lua_pushstring(state, c"t".as_ptr());
        ffi::lua_replace(state, 3);
        originals().load(state)
    }
}

/// Without `__gc`: finalizers run when they like, and can't be stopped.
pub(super) unsafe extern "C-unwind" fn setmetatable(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        if ffi::lua_type(state, 2) == ffi::LUA_TTABLE {
            ffi::lua_pushstring(state, c"__gc".as_ptr());
            if ffi::lua_rawget(state, 2) != ffi::LUA_TNIL {
                return ffi::luaL_error(
                    state,
                    c"a metatable can't have '__gc' here; '__close' and '<close>' are at hand".as_ptr(),
                );
            }
            ffi::lua_pop(state, 1);
        }
        originals().setmetatable(state)
    }
}

pub(super) unsafe extern "C-unwind" fn rawset(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::lua_rawgeti(state, ffi::LUA_REGISTRYINDEX, ffi::LUA_RIDX_GLOBALS);
        if ffi::lua_rawequal(state, 1, -1) != 0 {
            return ffi::luaL_error(state, c"there are no globals; declare a variable or use 'local'".as_ptr());
        }
        ffi::lua_pop(state, 1);
        // Libraries and robots.
        if ffi::luaL_getmetafield(state, 1, c"__metatable".as_ptr()) != ffi::LUA_TNIL {
            return ffi::luaL_error(state, c"this table stays as it is".as_ptr());
        }
        originals().rawset(state)
    }
}

pub(super) unsafe extern "C-unwind" fn read_unknown(state: *mut ffi::lua_State) -> c_int {
    unsafe { complain(state, "there is no variable or function '", "'") }
}

pub(super) unsafe extern "C-unwind" fn write_unknown(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        complain(
            state,
            "there is no variable '",
            "' to assign to; declare it, or say 'local' for one of this block only",
        )
    }
}

/// Raises the error for the name that is the second argument.
unsafe fn complain(state: *mut ffi::lua_State, before: &str, after: &str) -> c_int {
    unsafe {
        let mut buffer = [0_u8; 512];
        let length = describe(state, before, after, &mut buffer);
        ffi::luaL_where(state, 1);
        ffi::lua_pushlstring(state, buffer.as_ptr().cast(), length);
        ffi::lua_concat(state, 2);
        ffi::lua_error(state)
    }
}

/// Everything Rust owns is gone again when this returns, as what follows leaves by a jump.
unsafe fn describe(state: *mut ffi::lua_State, before: &str, after: &str, buffer: &mut [u8; 512]) -> usize {
    let name = unsafe {
        let mut length = 0;
        match ffi::lua_type(state, 2) {
            ffi::LUA_TSTRING => {
                let bytes = ffi::lua_tolstring(state, 2, &mut length);
                String::from_utf8_lossy(std::slice::from_raw_parts(bytes.cast(), length)).into_owned()
            }
            kind => text::type_name(kind).to_owned(),
        }
    };
    let hint = unsafe { desk(state).suggest(&name, spot(state)) };
    let hint = hint.map_or(String::new(), |hint| format!("; did you mean '{hint}'?"));
    let message = format!("{before}{name}{after}{hint}");
    let length = text::cut(&message, buffer.len());
    buffer[..length].copy_from_slice(&message.as_bytes()[..length]);
    length
}
