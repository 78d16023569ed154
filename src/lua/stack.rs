//! The crossing into C: functions kept on Lua's stack, called, and their upvalues. Knows nothing of what they are.
//!
//! Lua raises errors by a jump past all frames up to the protected call. Hence the rules everywhere in this folder: what is called outside a
//! protected call can't raise an error (it doesn't allocate in Lua, calls no metamethod), or `protected` does it; and a function
//! that Lua calls owns nothing that needs a destructor at any point where an error can be raised.
//!
//! The stack holds one value in each slot and nothing above but what a call needs; every method leaves it like that.

use std::ffi::{CStr, c_int, c_void};
use std::sync::Arc;

use mlua_sys as ffi;
use serde_json::Value;

use super::desk::{desk, spot};
use super::fingerprint::Fingerprint;
use super::guard::Guard;
use super::value::{self, Bounds};

/// The slot of the function that sees errors where they are raised.
const HANDLER: c_int = 1;
/// The slot of the function that makes variables.
const MAKER: c_int = 2;
/// Free stack slots at any time, for calls into Lua's interface.
pub(super) const SPARE: c_int = 64;

/// Makes functions that share nothing; the one upvalue of each is a variable.
const MAKE: &str = "return function() local v return function() return v end end";

/// Why a call failed; the error is on the stack until it is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trouble {
    Error,
    OverTime,
    OverMemory,
}

pub(super) struct Stack {
    state: *mut ffi::lua_State,
    guard: Arc<Guard>,
    top: c_int,
    free: Vec<u32>,
}

impl Stack {
    pub fn new(mlua: &mlua::Lua, guard: Arc<Guard>) -> mlua::Result<Self> {
        let maker: mlua::Function = mlua.load(MAKE).eval()?;
        let state = mlua.exec_raw_lua(|raw| raw.state());
        let mut stack = Self { state, guard, top: MAKER, free: Vec::new() };
        mlua.set_named_registry_value("lrp maker", maker)?;
        // SAFETY: the state is live, nothing runs, and no memory limit is set yet.
        unsafe {
            ffi::lua_settop(state, 0);
            ffi::lua_pushcclosure(state, on_error, 0);
            ffi::lua_getfield(state, ffi::LUA_REGISTRYINDEX, c"lrp maker".as_ptr());
        }
        stack.grow();
        Ok(stack)
    }

    pub fn state(&self) -> *mut ffi::lua_State {
        self.state
    }

    pub fn guard(&self) -> &Guard {
        &self.guard
    }

    fn grow(&mut self) {
        // SAFETY: doesn't raise an error.
        let there = unsafe { ffi::lua_checkstack(self.state, SPARE) };
        assert!(there != 0, "the program has more than 900,000 variables and blocks");
    }

    /// Puts the value on top of the stack into a slot.
    pub fn keep(&mut self) -> u32 {
        if let Some(slot) = self.free.pop() {
            // SAFETY: the slot is below the top.
            unsafe { ffi::lua_replace(self.state, slot as c_int) };
            return slot;
        }
        self.top += 1;
        self.grow();
        self.top as u32
    }

    /// Empties a slot, to be used again.
    pub fn release(&mut self, slot: u32) {
        // SAFETY: the slot is below the top.
        unsafe {
            ffi::lua_pushnil(self.state);
            ffi::lua_replace(self.state, slot as c_int);
        }
        self.free.push(slot);
    }

    /// A slot with a new variable, nil; there must be no memory limit.
    pub fn make_cell(&mut self) -> u32 {
        // SAFETY: the maker only makes a closure.
        let status = unsafe {
            ffi::lua_pushvalue(self.state, MAKER);
            ffi::lua_pcallk(self.state, 0, 1, 0, 0, None)
        };
        assert_eq!(status, ffi::LUA_OK, "out of memory");
        self.keep()
    }

    /// Calls the function in a slot; its `results` are on the stack until dropped.
    #[inline]
    pub fn call(&self, slot: u32, results: c_int) -> Result<(), Trouble> {
        // SAFETY: SPARE slots are free.
        unsafe { ffi::lua_pushvalue(self.state, slot as c_int) };
        self.protected(0, results)
    }

    /// Calls the function below its `arguments`, all on top of the stack.
    #[inline]
    pub fn protected(&self, arguments: c_int, results: c_int) -> Result<(), Trouble> {
        self.guard.enter();
        // SAFETY: the call is protected.
        let status = unsafe { ffi::lua_pcallk(self.state, arguments, results, HANDLER, 0, None) };
        match (self.guard.leave(), status) {
            (false, ffi::LUA_OK) => Ok(()),
            (true, ffi::LUA_OK) => Err(self.stopped_too_late()),
            (true, _) => Err(Trouble::OverTime),
            (false, ffi::LUA_ERRMEM) => Err(Trouble::OverMemory),
            (false, _) => Err(Trouble::Error),
        }
    }

    /// A call can end by itself while it is being stopped: its results count as its error.
    #[cold]
    fn stopped_too_late(&self) -> Trouble {
        // SAFETY: SPARE slots are free.
        unsafe {
            ffi::lua_settop(self.state, self.top);
            ffi::lua_pushnil(self.state);
        }
        Trouble::OverTime
    }

    /// Takes the results of a call off the stack again.
    #[inline]
    pub fn drop_results(&self) {
        // SAFETY: the slots stay.
        unsafe { ffi::lua_settop(self.state, self.top) };
    }

    /// The type of the only result.
    #[inline]
    pub fn result_type(&self) -> c_int {
        // SAFETY: there is a result.
        unsafe { ffi::lua_type(self.state, -1) }
    }

    #[inline]
    pub fn result_bool(&self) -> bool {
        // SAFETY: there is a result.
        unsafe { ffi::lua_toboolean(self.state, -1) != 0 }
    }

    #[inline]
    pub fn result_number(&self) -> f64 {
        // SAFETY: there is a result, a number.
        unsafe { ffi::lua_tonumber(self.state, -1) }
    }

    pub fn result(&self, bounds: Bounds) -> Value {
        // SAFETY: there is a result.
        unsafe { value::read_within(self.state, -1, bounds) }
    }

    /// Makes the only result the value of a variable.
    #[inline]
    pub fn result_into(&self, cell: u32) {
        // SAFETY: there is a result; the slot holds a variable.
        unsafe { ffi::lua_setupvalue(self.state, cell as c_int, 1) };
    }

    /// Lets `f` look at a variable's value, on top of the stack.
    #[inline]
    fn with<R>(&self, cell: u32, f: impl FnOnce(*mut ffi::lua_State) -> R) -> R {
        // SAFETY: the slot holds a variable; the value is popped again.
        unsafe {
            ffi::lua_getupvalue(self.state, cell as c_int, 1);
            let result = f(self.state);
            ffi::lua_settop(self.state, self.top);
            result
        }
    }

    pub fn value(&self, cell: u32) -> Value {
        // SAFETY: the value is on top.
        self.with(cell, |state| unsafe { value::read(state, -1) })
    }

    #[inline]
    pub fn number(&self, cell: u32) -> Option<f64> {
        // SAFETY: the value is on top.
        self.with(cell, |state| unsafe {
            (ffi::lua_type(state, -1) == ffi::LUA_TNUMBER).then(|| ffi::lua_tonumber(state, -1))
        })
    }

    #[inline]
    pub fn is_shared(&self, cell: u32) -> bool {
        // SAFETY: the value is on top.
        self.with(cell, |state| unsafe { ffi::lua_type(state, -1) >= ffi::LUA_TTABLE })
    }

    #[inline]
    pub fn fingerprint(&self, cell: u32) -> Fingerprint {
        // SAFETY: the value is on top.
        self.with(cell, |state| unsafe { Fingerprint::of(state, -1) })
    }

    /// About how many bytes a variable's value takes.
    pub fn weight(&self, cell: u32) -> usize {
        // SAFETY: the value is on top.
        self.with(cell, |state| unsafe { super::weight::weight(state, ffi::lua_gettop(state)) })
    }

    /// Gives a variable a value; there must be no memory limit.
    pub fn set(&self, cell: u32, value: &Value) {
        // SAFETY: the value outlives the call.
        unsafe {
            ffi::lua_pushcclosure(self.state, set_protected, 0);
            ffi::lua_pushvalue(self.state, cell as c_int);
            ffi::lua_pushlightuserdata(self.state, std::ptr::from_ref(value) as *mut c_void);
            ffi::lua_pcallk(self.state, 2, 0, 0, 0, None);
            ffi::lua_settop(self.state, self.top);
        }
    }

    /// Makes the upvalues of the function on top of the stack variables: `cell` says which, by the upvalue's name. The
    /// one that is none is its environment.
    pub fn join(&self, cell: impl Fn(&str) -> Option<u32>) {
        for upvalue in 1.. {
            // SAFETY: the function is on top; the slots hold variables.
            unsafe {
                let name = ffi::lua_getupvalue(self.state, -1, upvalue);
                if name.is_null() {
                    return;
                }
                ffi::lua_pop(self.state, 1);
                if let Some(cell) = CStr::from_ptr(name).to_str().ok().and_then(&cell) {
                    ffi::lua_upvaluejoin(self.state, -1, upvalue, cell as c_int, 1);
                } else {
                    ffi::lua_pushglobaltable(self.state);
                    ffi::lua_setupvalue(self.state, -2, upvalue);
                }
            }
        }
    }

    /// The error of a failed call, as text; takes it off the stack. There must be no memory limit.
    pub fn take_error(&self) -> String {
        // SAFETY: the error is on top; the text is made in a protected call, and its bytes copied while it is on the stack.
        unsafe {
            ffi::lua_pushcclosure(self.state, show_protected, 0);
            ffi::lua_insert(self.state, -2);
            ffi::lua_pcallk(self.state, 1, 1, 0, 0, None);
            let mut length = 0;
            let bytes = ffi::lua_tolstring(self.state, -1, &mut length);
            let bytes: &[u8] =
                if bytes.is_null() { b"unknown error" } else { std::slice::from_raw_parts(bytes.cast(), length) };
            let text = String::from_utf8_lossy(bytes).into_owned();
            ffi::lua_settop(self.state, self.top);
            text
        }
    }
}

/// Notes where the error was raised, and leaves it as it is.
unsafe extern "C-unwind" fn on_error(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let desk = desk(state);
        if desk.fault.get().is_none() {
            desk.fault.set(spot(state));
        }
        1
    }
}

/// Arguments: a variable, and a pointer to its new value.
unsafe extern "C-unwind" fn set_protected(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let value: *const Value = ffi::lua_touserdata(state, 2).cast_const().cast();
        value::push(state, &*value);
        ffi::lua_setupvalue(state, 1, 1);
        0
    }
}

/// Argument: an error. A metamethod of the user's could run for ever here, so none is called but Rust's.
unsafe extern "C-unwind" fn show_protected(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        super::text::push_error(state, 1);
        1
    }
}
