//! Library functions that loop in C, where no hook stops them: bounded, or made to call Lua. Knows nothing of limits in time.

use std::ffi::c_int;

use mlua_sys as ffi;

use super::sandbox::originals;

/// Elements that a table without so many may still pretend to have in one call: about 50 ms.
const PRETENDED: i64 = 1 << 20;
/// Elements from which on a sort compares in Lua.
const SORTED_IN_C: i64 = 1 << 14;

/// The addresses of these are the keys of functions of the prelude in Lua's registry.
pub(super) static LESS: u8 = 0;
pub(super) static COMPARE: u8 = 0;

/// Raises an error unless the table at `index` has `count` elements, or that is few.
unsafe fn bound(state: *mut ffi::lua_State, index: c_int, count: i64) {
    unsafe {
        if count > PRETENDED && count > ffi::lua_rawlen(state, index) as i64 {
            ffi::luaL_error(state, c"too many elements".as_ptr());
        }
    }
}

/// The length of the argument, if it is a table that could pretend one.
unsafe fn pretended_length(state: *mut ffi::lua_State) -> Option<i64> {
    unsafe {
        if ffi::lua_type(state, 1) != ffi::LUA_TTABLE
            || ffi::luaL_getmetafield(state, 1, c"__len".as_ptr()) == ffi::LUA_TNIL
        {
            return None;
        }
        ffi::lua_pop(state, 1);
        Some(ffi::luaL_len(state, 1))
    }
}

pub(super) unsafe extern "C-unwind" fn insert(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        if ffi::lua_gettop(state) == 3
            && let Some(length) = pretended_length(state)
        {
            bound(state, 1, length.saturating_sub(ffi::lua_tointeger(state, 2)));
        }
        originals().insert(state)
    }
}

pub(super) unsafe extern "C-unwind" fn remove(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        if ffi::lua_gettop(state) > 1
            && let Some(length) = pretended_length(state)
        {
            bound(state, 1, length.saturating_sub(ffi::lua_tointeger(state, 2)));
        }
        originals().remove(state)
    }
}

/// `table.move`.
pub(super) unsafe extern "C-unwind" fn shift(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (first, last) = (ffi::luaL_checkinteger(state, 2), ffi::luaL_checkinteger(state, 3));
        ffi::luaL_checktype(state, 1, ffi::LUA_TTABLE);
        bound(state, 1, last.saturating_sub(first));
        originals().shift(state)
    }
}

pub(super) unsafe extern "C-unwind" fn concat(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::luaL_checktype(state, 1, ffi::LUA_TTABLE);
        let first = ffi::luaL_optinteger(state, 3, 1);
        let last = if ffi::lua_type(state, 4) <= ffi::LUA_TNIL {
            ffi::luaL_len(state, 1)
        } else {
            ffi::luaL_checkinteger(state, 4)
        };
        bound(state, 1, last.saturating_sub(first));
        originals().concat(state)
    }
}

/// Long tables are compared by a function in Lua, and functions in C called by one.
pub(super) unsafe extern "C-unwind" fn sort(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::luaL_checktype(state, 1, ffi::LUA_TTABLE);
        if ffi::lua_iscfunction(state, 2) != 0 {
            ffi::lua_rawgetp(state, ffi::LUA_REGISTRYINDEX, (&raw const COMPARE).cast());
            ffi::lua_pushvalue(state, 2);
            ffi::lua_callk(state, 1, 1, 0, None);
            ffi::lua_replace(state, 2);
        } else if ffi::lua_type(state, 2) <= ffi::LUA_TNIL && ffi::luaL_len(state, 1) > SORTED_IN_C {
            ffi::lua_settop(state, 1);
            ffi::lua_rawgetp(state, ffi::LUA_REGISTRYINDEX, (&raw const LESS).cast());
        }
        originals().sort(state)
    }
}

/// Nothing, however often, would take Lua as long as something.
pub(super) unsafe extern "C-unwind" fn rep(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (mut length, mut between) = (0, 0);
        ffi::luaL_checklstring(state, 1, &mut length);
        ffi::luaL_checkinteger(state, 2);
        ffi::luaL_optlstring(state, 3, c"".as_ptr(), &mut between);
        if length + between == 0 {
            ffi::lua_pushstring(state, c"".as_ptr());
            return 1;
        }
        originals().rep(state)
    }
}
