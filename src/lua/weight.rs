//! About how much memory a value holds, to name the variable that keeps too much. Knows nothing of variables.

use std::ffi::c_int;

use mlua_sys as ffi;

/// Levels of tables looked into, and entries looked at, in all.
const DEPTH: usize = 4;
const ENTRIES: usize = 1 << 22;
/// Bytes of a table's entry, about.
const ENTRY: usize = 32;

/// Bytes, about.
///
/// # Safety
/// `state` is a live state and `index` an absolute index. Raises no error, allocates nothing.
pub(super) unsafe fn weight(state: *mut ffi::lua_State, index: c_int) -> usize {
    let mut entries = ENTRIES;
    unsafe { weigh(state, index, DEPTH, &mut entries) }
}

unsafe fn weigh(state: *mut ffi::lua_State, index: c_int, depth: usize, entries: &mut usize) -> usize {
    unsafe {
        match ffi::lua_type(state, index) {
            ffi::LUA_TSTRING => ffi::lua_rawlen(state, index),
            ffi::LUA_TTABLE if depth > 0 && ffi::lua_checkstack(state, 4) != 0 => {
                weigh_table(state, index, depth, entries)
            }
            _ => 0,
        }
    }
}

unsafe fn weigh_table(state: *mut ffi::lua_State, index: c_int, depth: usize, entries: &mut usize) -> usize {
    let mut sum = 0;
    unsafe {
        ffi::lua_pushnil(state);
        while ffi::lua_next(state, index) != 0 {
            let value = ffi::lua_gettop(state);
            sum += ENTRY + weigh(state, value - 1, 0, entries) + weigh(state, value, depth - 1, entries);
            ffi::lua_pop(state, 1);
            *entries = entries.saturating_sub(1);
            if *entries == 0 {
                ffi::lua_pop(state, 1);
                break;
            }
        }
    }
    sum
}
