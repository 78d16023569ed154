//! Coroutines and `xpcall`, such that a call that has to be stopped is stopped in them too. Knows nothing of why it has to be.

use std::ffi::c_int;

use mlua_sys as ffi;

use super::desk::desk;
use super::guard;
use super::sandbox::originals;

unsafe fn coroutine(state: *mut ffi::lua_State) -> *mut ffi::lua_State {
    unsafe {
        ffi::luaL_checktype(state, 1, ffi::LUA_TTHREAD);
        ffi::lua_tothread(state, 1)
    }
}

/// Resumes `coroutine` with the topmost `arguments`; how many results it left, or nothing, with the error in their place.
unsafe fn go_on(state: *mut ffi::lua_State, coroutine: *mut ffi::lua_State, arguments: c_int) -> Option<c_int> {
    unsafe {
        if ffi::lua_checkstack(coroutine, arguments) == 0 {
            ffi::lua_pushstring(state, c"too many arguments to resume".as_ptr());
            return None;
        }
        ffi::lua_xmove(state, coroutine, arguments);
        let mut results = 0;
        let status = desk(state).guard.within(coroutine, || ffi::lua_resume(coroutine, state, arguments, &mut results));
        if status != ffi::LUA_OK && status != ffi::LUA_YIELD {
            ffi::lua_xmove(coroutine, state, 1);
            return None;
        }
        if ffi::lua_checkstack(state, results + 1) == 0 {
            ffi::lua_pop(coroutine, results);
            ffi::lua_pushstring(state, c"too many results to resume".as_ptr());
            return None;
        }
        ffi::lua_xmove(coroutine, state, results);
        Some(results)
    }
}

pub(super) unsafe extern "C-unwind" fn resume(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let coroutine = coroutine(state);
        let results = go_on(state, coroutine, ffi::lua_gettop(state) - 1);
        ffi::lua_pushboolean(state, results.is_some().into());
        let moved = results.unwrap_or(1) + 1;
        ffi::lua_insert(state, -moved);
        moved
    }
}

pub(super) unsafe extern "C-unwind" fn wrap(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::luaL_checktype(state, 1, ffi::LUA_TFUNCTION);
        let coroutine = ffi::lua_newthread(state);
        ffi::lua_pushvalue(state, 1);
        ffi::lua_xmove(state, coroutine, 1);
        ffi::lua_pushcclosure(state, wrapped, 1);
        1
    }
}

unsafe extern "C-unwind" fn wrapped(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let coroutine = ffi::lua_tothread(state, ffi::lua_upvalueindex(1));
        match go_on(state, coroutine, ffi::lua_gettop(state)) {
            Some(results) => results,
            None => give_up(state, coroutine),
        }
    }
}

/// Raises the error a wrapped coroutine ended with, its variables closed before; not while the call is being stopped, as closing could loop.
unsafe fn give_up(state: *mut ffi::lua_State, coroutine: *mut ffi::lua_State) -> c_int {
    unsafe {
        let guard = &desk(state).guard;
        if guard.is_over() {
            return guard::raise(state);
        }
        let mut status = ffi::lua_status(coroutine);
        if status != ffi::LUA_OK && status != ffi::LUA_YIELD {
            status = guard.within(coroutine, || ffi::lua_closethread(coroutine, state));
            ffi::lua_xmove(coroutine, state, 1);
        }
        if status != ffi::LUA_ERRMEM && ffi::lua_type(state, -1) == ffi::LUA_TSTRING {
            ffi::luaL_where(state, 1);
            ffi::lua_insert(state, -2);
            ffi::lua_concat(state, 2);
        }
        ffi::lua_error(state)
    }
}

pub(super) unsafe extern "C-unwind" fn close(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let coroutine = coroutine(state);
        let guard = &desk(state).guard;
        if guard.is_over() {
            return guard::raise(state);
        }
        if is_active(state, coroutine) {
            return ffi::luaL_error(state, c"a coroutine that runs can't be closed".as_ptr());
        }
        let status = guard.within(coroutine, || ffi::lua_closethread(coroutine, state));
        ffi::lua_pushboolean(state, (status == ffi::LUA_OK).into());
        if status == ffi::LUA_OK {
            return 1;
        }
        ffi::lua_xmove(coroutine, state, 1);
        2
    }
}

/// Whether the coroutine runs, or waits for one that it resumed.
unsafe fn is_active(state: *mut ffi::lua_State, coroutine: *mut ffi::lua_State) -> bool {
    unsafe {
        let mut activation: ffi::lua_Debug = std::mem::zeroed();
        state == coroutine
            || ffi::lua_status(coroutine) == ffi::LUA_OK && ffi::lua_getstack(coroutine, 0, &mut activation) != 0
    }
}

/// `xpcall`, its handler left out while the call is being stopped: hooks are off in handlers of errors raised by hooks.
pub(super) unsafe extern "C-unwind" fn xpcall(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        ffi::luaL_checktype(state, 2, ffi::LUA_TFUNCTION);
        ffi::lua_pushvalue(state, 2);
        ffi::lua_pushcclosure(state, handle, 1);
        ffi::lua_replace(state, 2);
        originals().xpcall(state)
    }
}

unsafe extern "C-unwind" fn handle(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        if desk(state).guard.is_over() {
            return 1;
        }
        ffi::lua_settop(state, 1);
        ffi::lua_pushvalue(state, ffi::lua_upvalueindex(1));
        ffi::lua_insert(state, 1);
        ffi::lua_callk(state, 1, 1, 0, None);
        1
    }
}
