//! A number that differs when a value differs, to see changes. Knows nothing of variables.

use std::ffi::c_int;

use mlua_sys as ffi;

/// What a value was when it was last looked at. Two that differ have the same fingerprint once in 2^64.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fingerprint(u64);

/// Levels of tables looked into.
const DEPTH: usize = 4;
/// Table entries looked at, in all; tables larger than that are looked at in part.
const ENTRIES: usize = 1 << 16;

impl Fingerprint {
    pub const NIL: Self = Self(0);

    /// That of the value at `index`. Raises no error, allocates nothing.
    ///
    /// # Safety
    /// `state` is a live state and `index` a valid index.
    pub unsafe fn of(state: *mut ffi::lua_State, index: c_int) -> Self {
        let mut entries = ENTRIES;
        Self(unsafe { hash(state, ffi::lua_absindex(state, index), DEPTH, &mut entries) })
    }
}

unsafe fn hash(state: *mut ffi::lua_State, index: c_int, depth: usize, entries: &mut usize) -> u64 {
    unsafe {
        match ffi::lua_type(state, index) {
            ffi::LUA_TNIL => 0,
            ffi::LUA_TBOOLEAN => mix(1, ffi::lua_toboolean(state, index) as u64),
            ffi::LUA_TNUMBER if ffi::lua_isinteger(state, index) != 0 => {
                mix(2, ffi::lua_tointeger(state, index) as u64)
            }
            ffi::LUA_TNUMBER => mix(3, ffi::lua_tonumber(state, index).to_bits()),
            ffi::LUA_TSTRING => string(state, index),
            ffi::LUA_TTABLE => table(state, index, depth, entries),
            kind => mix(kind as u64 + 8, ffi::lua_topointer(state, index) as u64),
        }
    }
}

unsafe fn string(state: *mut ffi::lua_State, index: c_int) -> u64 {
    let mut length = 0;
    let bytes: &[u8] = unsafe {
        let bytes = ffi::lua_tolstring(state, index, &mut length);
        std::slice::from_raw_parts(bytes.cast(), length)
    };
    let (words, rest) = bytes.as_chunks::<8>();
    let start = mix(4, length as u64);
    let hash = words.iter().fold(start, |hash, word| mix(hash, u64::from_le_bytes(*word)));
    rest.iter().fold(hash, |hash, byte| mix(hash, u64::from(*byte)))
}

/// The sum over the entries, so that their order doesn't count.
unsafe fn table(state: *mut ffi::lua_State, index: c_int, depth: usize, entries: &mut usize) -> u64 {
    let mut sum = 5;
    if depth == 0 || unsafe { ffi::lua_checkstack(state, 4) } == 0 {
        return sum;
    }
    unsafe {
        ffi::lua_pushnil(state);
        while ffi::lua_next(state, index) != 0 {
            let value = ffi::lua_gettop(state);
            let key = hash(state, value - 1, 0, entries);
            sum = u64::wrapping_add(sum, mix(key, hash(state, value, depth - 1, entries)));
            ffi::lua_pop(state, 1);
            *entries = entries.saturating_sub(1);
            if *entries == 0 {
                ffi::lua_pop(state, 1);
                break;
            }
        }
    }
    mix(6, sum)
}

/// Spreads each bit of both over the result.
fn mix(a: u64, b: u64) -> u64 {
    let mut word = (a ^ b.wrapping_mul(0x9E37_79B9_7F4A_7C15)).wrapping_add(0xD1B5_4A32_D192_ED03);
    word = (word ^ (word >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    word = (word ^ (word >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    word ^ (word >> 32)
}
