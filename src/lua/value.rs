//! Lua values as JSON and back. Knows nothing of variables and blocks.
//!
//! Integers and floats as such, nan and infinities as `"nan"`, `"inf"`, `"-inf"`; functions, threads and userdata as `{"lua":"function"}`;
//! a table with the keys 1..n as an array, any other as an object, its keys sorted. What lies deeper than [`DEPTH`] or
//! beyond about [`BYTES`] is left out; `"cut"` says how many entries.

use std::cmp::Ordering;
use std::ffi::{c_int, c_void};

use mlua_sys as ffi;
use serde_json::{Map, Number, Value, json};

/// Levels of tables shown.
pub(super) const DEPTH: usize = 4;
/// About how many bytes of a value are shown.
pub(super) const BYTES: usize = 1024;
/// Entries counted at most, in all tables together; a cycle can show a large table many times.
const COUNTED: usize = 1 << 20;

/// What of a value is taken over.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    pub depth: usize,
    pub bytes: usize,
}

/// Where a metatable has the name of what its table stands for, a part of a robot.
pub fn device_mark() -> *const c_void {
    static MARK: u8 = 0;
    (&raw const MARK).cast()
}

struct Reader {
    state: *mut ffi::lua_State,
    bytes: usize,
    counted: usize,
}

/// The value at `index`.
///
/// # Safety
/// `state` is a live state and `index` a valid index. Raises no error, allocates nothing in Lua.
pub(super) unsafe fn read(state: *mut ffi::lua_State, index: c_int) -> Value {
    unsafe { read_within(state, index, Bounds { depth: DEPTH, bytes: BYTES }) }
}

/// The same with other bounds.
///
/// # Safety
/// As for `read`.
pub(super) unsafe fn read_within(state: *mut ffi::lua_State, index: c_int, bounds: Bounds) -> Value {
    let mut reader = Reader { state, bytes: bounds.bytes, counted: COUNTED };
    unsafe { reader.value(ffi::lua_absindex(state, index), bounds.depth) }
}

impl Reader {
    unsafe fn value(&mut self, index: c_int, depth: usize) -> Value {
        let state = self.state;
        self.spend(4);
        unsafe {
            match ffi::lua_type(state, index) {
                ffi::LUA_TNIL => Value::Null,
                ffi::LUA_TBOOLEAN => Value::Bool(ffi::lua_toboolean(state, index) != 0),
                ffi::LUA_TNUMBER if ffi::lua_isinteger(state, index) != 0 => ffi::lua_tointeger(state, index).into(),
                ffi::LUA_TNUMBER => float(ffi::lua_tonumber(state, index)),
                ffi::LUA_TSTRING => Value::String(self.string(index)),
                ffi::LUA_TTABLE => match self.device(index) {
                    Some(name) => json!({ "lua": name }),
                    None => self.table(index, depth),
                },
                _ => json!({ "lua": "function" }),
            }
        }
    }

    fn spend(&mut self, bytes: usize) {
        self.bytes = self.bytes.saturating_sub(bytes);
    }

    /// The string at `index`, its end cut off where it is too long.
    unsafe fn string(&mut self, index: c_int) -> String {
        let bytes = unsafe { bytes_at(self.state, index) };
        let kept = &bytes[..bytes.len().min(self.bytes)];
        self.spend(kept.len());
        let mut text = String::from_utf8_lossy(kept).into_owned();
        if kept.len() < bytes.len() {
            text.push('…');
        }
        text
    }

    /// What a table stands for that is a part of a robot: `robot.motorA`.
    unsafe fn device(&mut self, index: c_int) -> Option<String> {
        unsafe {
            if ffi::lua_checkstack(self.state, 3) == 0 || ffi::lua_getmetatable(self.state, index) == 0 {
                return None;
            }
            ffi::lua_rawgetp(self.state, -1, device_mark());
            let name = (ffi::lua_type(self.state, -1) == ffi::LUA_TSTRING).then(|| self.string(-1));
            ffi::lua_pop(self.state, 2);
            name
        }
    }

    unsafe fn table(&mut self, index: c_int, depth: usize) -> Value {
        if unsafe { ffi::lua_checkstack(self.state, 4) } == 0 {
            return json!({ "cut": 1 });
        }
        let (keys, count) = unsafe { self.keys(index) };
        if count > 0 && (depth == 0 || self.bytes == 0) {
            return json!({ "cut": count });
        }
        match unsafe { self.is_array(index, count) } {
            true => unsafe { self.array(index, count, depth - 1) },
            false => unsafe { self.object(index, keys, count, depth.saturating_sub(1)) },
        }
    }

    /// The keys that come first in order, and how many there are in all.
    unsafe fn keys(&mut self, index: c_int) -> (Vec<Key>, usize) {
        let wanted = self.bytes / 8 + 1;
        let (mut keys, mut count) = (Vec::new(), 0);
        unsafe {
            ffi::lua_pushnil(self.state);
            while ffi::lua_next(self.state, index) != 0 {
                ffi::lua_pop(self.state, 1);
                count += 1;
                keys.push(Key::read(self.state));
                if keys.len() >= 2 * wanted {
                    keys.sort();
                    keys.truncate(wanted);
                }
                self.counted = self.counted.saturating_sub(1);
                if self.counted == 0 {
                    ffi::lua_pop(self.state, 1);
                    break;
                }
            }
        }
        keys.sort();
        (keys, count)
    }

    /// Whether the keys are 1..count; an empty table is an object.
    unsafe fn is_array(&self, index: c_int, count: usize) -> bool {
        count > 0 && unsafe { ffi::lua_rawlen(self.state, index) } == count && unsafe { self.has(index, count) }
    }

    /// With a border at `count` and `count` entries, one missing in between means one somewhere else.
    unsafe fn has(&self, index: c_int, count: usize) -> bool {
        (1..=count.min(BYTES)).all(|key| unsafe {
            let kind = ffi::lua_rawgeti(self.state, index, key as i64);
            ffi::lua_pop(self.state, 1);
            kind != ffi::LUA_TNIL
        })
    }

    unsafe fn array(&mut self, index: c_int, count: usize, depth: usize) -> Value {
        let mut values = Vec::new();
        for key in 1..=count {
            if self.bytes == 0 {
                values.push(json!({ "cut": count - key + 1 }));
                break;
            }
            unsafe {
                ffi::lua_rawgeti(self.state, index, key as i64);
                values.push(self.value(ffi::lua_gettop(self.state), depth));
                ffi::lua_pop(self.state, 1);
            }
        }
        Value::Array(values)
    }

    unsafe fn object(&mut self, index: c_int, keys: Vec<Key>, count: usize, depth: usize) -> Value {
        let state = self.state;
        let top = unsafe { ffi::lua_gettop(state) };
        let mut fields = Map::new();
        for (shown, (key, kept)) in unsafe { self.keep(index, &keys) }.into_iter().enumerate() {
            if self.bytes == 0 {
                fields.insert("cut".to_owned(), (count - shown).into());
                break;
            }
            let name = key.name();
            self.spend(name.len());
            unsafe {
                ffi::lua_pushvalue(state, kept);
                ffi::lua_rawget(state, index);
                fields.insert(name, self.value(ffi::lua_gettop(state), depth));
                ffi::lua_pop(state, 1);
            }
        }
        unsafe { ffi::lua_settop(state, top) };
        Value::Object(fields)
    }

    /// Leaves those of the table's keys that are in `keys`, a sorted list, on the stack, and says where. Pushing them later would allocate.
    unsafe fn keep(&self, index: c_int, keys: &[Key]) -> Vec<(Key, c_int)> {
        let state = self.state;
        let mut kept = Vec::new();
        unsafe {
            if ffi::lua_checkstack(state, keys.len() as c_int + 4) == 0 {
                return kept;
            }
            ffi::lua_pushnil(state);
            while kept.len() < keys.len() && ffi::lua_next(state, index) != 0 {
                ffi::lua_pop(state, 1);
                let key = Key::read(state);
                if keys.binary_search(&key).is_ok() {
                    kept.push((key, ffi::lua_gettop(state)));
                    ffi::lua_pushvalue(state, -1);
                }
            }
        }
        kept.sort();
        kept
    }
}

/// The bytes of the string at `index`, as long as it stays there.
unsafe fn bytes_at<'a>(state: *mut ffi::lua_State, index: c_int) -> &'a [u8] {
    let mut length = 0;
    unsafe {
        let bytes = ffi::lua_tolstring(state, index, &mut length);
        std::slice::from_raw_parts(bytes.cast(), length)
    }
}

fn float(number: f64) -> Value {
    match Number::from_f64(number) {
        Some(number) => Value::Number(number),
        None if number.is_nan() => "nan".into(),
        None if number > 0.0 => "inf".into(),
        None => "-inf".into(),
    }
}

/// A table's key: a copy, as Lua's own would have to stay on its stack.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Integer(i64),
    /// Never nan.
    Float(Ordered),
    Text(Box<[u8]>),
    Bool(bool),
    Other(&'static str),
}

#[derive(Clone, Copy)]
struct Ordered(f64);

impl PartialEq for Ordered {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Key {
    /// The key on top of the stack, which stays there.
    unsafe fn read(state: *mut ffi::lua_State) -> Self {
        unsafe {
            match ffi::lua_type(state, -1) {
                ffi::LUA_TNUMBER if ffi::lua_isinteger(state, -1) != 0 => Key::Integer(ffi::lua_tointeger(state, -1)),
                ffi::LUA_TNUMBER => Key::Float(Ordered(ffi::lua_tonumber(state, -1))),
                ffi::LUA_TSTRING => Key::Text(bytes_at(state, -1).into()),
                ffi::LUA_TBOOLEAN => Key::Bool(ffi::lua_toboolean(state, -1) != 0),
                kind => Key::Other(super::text::type_name(kind)),
            }
        }
    }

    fn name(&self) -> String {
        match self {
            Key::Integer(key) => key.to_string(),
            Key::Float(Ordered(key)) => key.to_string(),
            Key::Text(key) => String::from_utf8_lossy(key).into_owned(),
            Key::Bool(key) => key.to_string(),
            Key::Other(kind) => (*kind).to_owned(),
        }
    }
}

/// Pushes a JSON value as Lua's: null as nil, numbers as integers where they are.
///
/// # Safety
/// Called from C that Lua called; can raise an error, and owns nothing that needs a destructor.
pub(super) unsafe fn push(state: *mut ffi::lua_State, value: &Value) {
    unsafe {
        ffi::luaL_checkstack(state, 4, c"the value is nested too deeply".as_ptr());
        match value {
            Value::Null => ffi::lua_pushnil(state),
            Value::Bool(flag) => ffi::lua_pushboolean(state, (*flag).into()),
            Value::Number(number) => match number.as_i64() {
                Some(integer) => ffi::lua_pushinteger(state, integer),
                None => ffi::lua_pushnumber(state, number.as_f64().unwrap_or(f64::NAN)),
            },
            Value::String(text) => {
                ffi::lua_pushlstring(state, text.as_ptr().cast(), text.len());
            }
            Value::Array(values) => {
                ffi::lua_createtable(state, values.len() as c_int, 0);
                for (place, value) in (1..).zip(values) {
                    push(state, value);
                    ffi::lua_rawseti(state, -2, place);
                }
            }
            Value::Object(fields) => {
                ffi::lua_createtable(state, 0, fields.len() as c_int);
                for (name, value) in fields {
                    ffi::lua_pushlstring(state, name.as_ptr().cast(), name.len());
                    push(state, value);
                    ffi::lua_rawset(state, -3);
                }
            }
        }
    }
}
