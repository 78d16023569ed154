//! `string.find`, `match`, `gmatch` and `gsub` by our own matcher. Knows nothing of how it matches.

use std::ffi::{CStr, c_char, c_int};
use std::mem::MaybeUninit;

use mlua_sys as ffi;

use super::desk::desk;
use super::guard;
use super::pattern::{Caught, Complaint, Matcher, has_specials};

/// The string argument `index`; it lives as long as it is on the stack.
unsafe fn argument<'a>(state: *mut ffi::lua_State, index: c_int) -> &'a [u8] {
    unsafe {
        let mut length = 0;
        let bytes = ffi::luaL_checklstring(state, index, &mut length);
        std::slice::from_raw_parts(bytes.cast(), length)
    }
}

/// Where to begin, from argument 3: counted from 1, from the end if negative. Beyond the end it is nothing.
unsafe fn start(state: *mut ffi::lua_State, length: usize) -> Option<usize> {
    let from = unsafe { ffi::luaL_optinteger(state, 3, 1) };
    let length = length as i64;
    let start = if from > 0 {
        from - 1
    } else if from == 0 || from < -length {
        0
    } else {
        length + from
    };
    (start <= length).then_some(start as usize)
}

/// Raises the error a complaint stands for.
unsafe fn complain(state: *mut ffi::lua_State, complaint: Complaint) -> ! {
    let message: &CStr = match complaint {
        Complaint::EndsWithEscape => c"malformed pattern (ends with '%%')",
        Complaint::MissingBracket => c"malformed pattern (missing ']')",
        Complaint::MissingBalance => c"malformed pattern (missing arguments to '%%b')",
        Complaint::MissingFrontierSet => c"missing '[' after '%%f' in pattern",
        Complaint::TooComplex => c"pattern too complex",
        Complaint::TooManyCaptures => c"too many captures",
        Complaint::NothingToClose => c"invalid pattern capture",
        Complaint::Unfinished => c"unfinished capture",
        Complaint::NoCapture(_) => c"invalid capture index %%%d",
        Complaint::Stopped => c"",
    };
    let index = if let Complaint::NoCapture(index) = complaint { index as c_int } else { 0 };
    unsafe {
        if complaint == Complaint::Stopped {
            guard::raise(state);
        } else {
            ffi::luaL_error(state, message.as_ptr(), index);
        }
    }
    unreachable!("both raise an error")
}

/// The value, or the error raised.
unsafe fn unless_wrong<T>(state: *mut ffi::lua_State, result: Result<T, Complaint>) -> T {
    match result {
        Ok(value) => value,
        Err(complaint) => unsafe { complain(state, complaint) },
    }
}

unsafe fn push_bytes(state: *mut ffi::lua_State, bytes: &[u8]) {
    unsafe { ffi::lua_pushlstring(state, bytes.as_ptr().cast(), bytes.len()) };
}

unsafe fn push_capture(state: *mut ffi::lua_State, matcher: &Matcher, index: usize, whole: (usize, usize)) {
    unsafe {
        match unless_wrong(state, matcher.capture(index, whole.0, whole.1)) {
            Caught::Text(from, to) => push_bytes(state, &matcher.subject[from..to]),
            Caught::Position(position) => ffi::lua_pushinteger(state, position as i64),
        }
    }
}

/// Pushes the first `count` captures.
unsafe fn push_captures(state: *mut ffi::lua_State, matcher: &Matcher, count: usize, whole: (usize, usize)) -> c_int {
    unsafe {
        ffi::luaL_checkstack(state, count as c_int, c"too many captures".as_ptr());
        for index in 0..count {
            push_capture(state, matcher, index, whole);
        }
    }
    count as c_int
}

/// Without the anchor, and whether there was one.
fn split_anchor(pattern: &[u8]) -> (&[u8], bool) {
    match pattern.strip_prefix(b"^") {
        Some(pattern) => (pattern, true),
        None => (pattern, false),
    }
}

/// The first match from `start` on.
fn first(matcher: &mut Matcher, start: usize, anchored: bool) -> Result<Option<(usize, usize)>, Complaint> {
    let last = if anchored { start } else { matcher.subject.len() };
    for at in start..=last {
        if let Some(end) = matcher.match_at(at)? {
            return Ok(Some((at, end)));
        }
    }
    Ok(None)
}

pub(super) unsafe extern "C-unwind" fn find(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (subject, pattern) = (argument(state, 1), argument(state, 2));
        let Some(start) = start(state, subject.len()) else {
            return push_nothing(state);
        };
        let guard = &desk(state).guard;
        let stop = || guard.is_over();
        if ffi::lua_toboolean(state, 4) != 0 || !has_specials(pattern) {
            let found = Matcher::new(subject, pattern, &stop).find_plain(pattern, start);
            return match unless_wrong(state, found) {
                Some(at) => push_range(state, at, at + pattern.len()),
                None => push_nothing(state),
            };
        }
        let (pattern, anchored) = split_anchor(pattern);
        let mut matcher = Matcher::new(subject, pattern, &stop);
        let Some(whole) = unless_wrong(state, first(&mut matcher, start, anchored)) else {
            return push_nothing(state);
        };
        let count = if matcher.has_captures() { matcher.values() } else { 0 };
        push_range(state, whole.0, whole.1) + push_captures(state, &matcher, count, whole)
    }
}

unsafe fn push_range(state: *mut ffi::lua_State, from: usize, to: usize) -> c_int {
    unsafe {
        ffi::lua_pushinteger(state, from as i64 + 1);
        ffi::lua_pushinteger(state, to as i64);
    }
    2
}

unsafe fn push_nothing(state: *mut ffi::lua_State) -> c_int {
    unsafe { ffi::lua_pushnil(state) };
    1
}

/// `string.match`.
pub(super) unsafe extern "C-unwind" fn matched(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (subject, pattern) = (argument(state, 1), argument(state, 2));
        let Some(start) = start(state, subject.len()) else {
            return push_nothing(state);
        };
        let guard = &desk(state).guard;
        let stop = || guard.is_over();
        let (pattern, anchored) = split_anchor(pattern);
        let mut matcher = Matcher::new(subject, pattern, &stop);
        match unless_wrong(state, first(&mut matcher, start, anchored)) {
            Some(whole) => push_captures(state, &matcher, matcher.values(), whole),
            None => push_nothing(state),
        }
    }
}

/// Its iterator keeps the subject, the pattern, where to go on, and where the last match ended.
pub(super) unsafe extern "C-unwind" fn gmatch(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (subject, _) = (argument(state, 1), argument(state, 2));
        let start = start(state, subject.len()).unwrap_or(subject.len() + 1);
        ffi::lua_settop(state, 2);
        ffi::lua_pushinteger(state, start as i64);
        ffi::lua_pushinteger(state, -1);
        ffi::lua_pushcclosure(state, gmatch_next, 4);
        1
    }
}

unsafe extern "C-unwind" fn gmatch_next(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (subject, pattern) = (argument(state, ffi::lua_upvalueindex(1)), argument(state, ffi::lua_upvalueindex(2)));
        let start = ffi::lua_tointeger(state, ffi::lua_upvalueindex(3)) as usize;
        let last = ffi::lua_tointeger(state, ffi::lua_upvalueindex(4));
        let guard = &desk(state).guard;
        let stop = || guard.is_over();
        let mut matcher = Matcher::new(subject, pattern, &stop);
        for at in start..=subject.len() {
            let Some(end) = unless_wrong(state, matcher.match_at(at)) else {
                continue;
            };
            if end as i64 == last {
                continue;
            }
            for upvalue in [3, 4] {
                ffi::lua_pushinteger(state, end as i64);
                ffi::lua_replace(state, ffi::lua_upvalueindex(upvalue));
            }
            return push_captures(state, &matcher, matcher.values(), (at, end));
        }
        0
    }
}

/// The text being made; it may keep a value on top of the stack.
struct Buffer(MaybeUninit<ffi::luaL_Buffer>);

impl Buffer {
    unsafe fn add(&mut self, bytes: &[u8]) {
        unsafe { ffi::luaL_addlstring(self.0.as_mut_ptr(), bytes.as_ptr().cast::<c_char>(), bytes.len()) };
    }

    /// Adds the value on top of the stack.
    unsafe fn add_value(&mut self) {
        unsafe { ffi::luaL_addvalue(self.0.as_mut_ptr()) };
    }
}

pub(super) unsafe extern "C-unwind" fn gsub(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let (subject, pattern) = (argument(state, 1), argument(state, 2));
        let kind = ffi::lua_type(state, 3);
        let most = ffi::luaL_optinteger(state, 4, subject.len() as i64 + 1);
        if !matches!(kind, ffi::LUA_TNUMBER | ffi::LUA_TSTRING | ffi::LUA_TFUNCTION | ffi::LUA_TTABLE) {
            return wrong_replacement(state);
        }
        let guard = &desk(state).guard;
        let stop = || guard.is_over();
        let (pattern, anchored) = split_anchor(pattern);
        let mut matcher = Matcher::new(subject, pattern, &stop);
        let mut buffer = Buffer(MaybeUninit::uninit());
        ffi::luaL_buffinit(state, buffer.0.as_mut_ptr());
        let (mut at, mut last, mut count) = (0, None, 0);
        while count < most {
            match unless_wrong(state, matcher.match_at(at)) {
                Some(end) if last != Some(end) => {
                    count += 1;
                    replace(state, &mut buffer, &matcher, (at, end));
                    (at, last) = (end, Some(end));
                }
                _ if at < subject.len() => {
                    buffer.add(&subject[at..=at]);
                    at += 1;
                }
                _ => break,
            }
            if anchored {
                break;
            }
        }
        buffer.add(&subject[at..]);
        ffi::luaL_pushresult(buffer.0.as_mut_ptr());
        ffi::lua_pushinteger(state, count);
        2
    }
}

unsafe fn wrong_replacement(state: *mut ffi::lua_State) -> c_int {
    unsafe {
        let found = ffi::luaL_typename(state, 3);
        let message = ffi::lua_pushfstring(state, c"string/function/table expected, got %s".as_ptr(), found);
        ffi::luaL_argerror(state, 3, message)
    }
}

/// Adds what argument 3 makes of a match.
unsafe fn replace(state: *mut ffi::lua_State, buffer: &mut Buffer, matcher: &Matcher, whole: (usize, usize)) {
    unsafe {
        match ffi::lua_type(state, 3) {
            ffi::LUA_TFUNCTION => {
                ffi::lua_pushvalue(state, 3);
                let count = push_captures(state, matcher, matcher.values(), whole);
                ffi::lua_callk(state, count, 1, 0, None);
            }
            ffi::LUA_TTABLE => {
                push_capture(state, matcher, 0, whole);
                ffi::lua_gettable(state, 3);
            }
            _ => return add_form(state, buffer, matcher, whole),
        }
        if ffi::lua_toboolean(state, -1) == 0 {
            ffi::lua_pop(state, 1);
            buffer.add(&matcher.subject[whole.0..whole.1]);
        } else if ffi::lua_isstring(state, -1) == 0 {
            ffi::luaL_error(state, c"invalid replacement value (a %s)".as_ptr(), ffi::luaL_typename(state, -1));
        } else {
            buffer.add_value();
        }
    }
}

/// Adds a replacement text, `%1` in it replaced.
unsafe fn add_form(state: *mut ffi::lua_State, buffer: &mut Buffer, matcher: &Matcher, whole: (usize, usize)) {
    unsafe {
        let mut rest = argument(state, 3);
        while let Some(at) = rest.iter().position(|byte| *byte == b'%') {
            buffer.add(&rest[..at]);
            match rest.get(at + 1) {
                Some(b'%') => buffer.add(b"%"),
                Some(b'0') => buffer.add(&matcher.subject[whole.0..whole.1]),
                Some(digit) if digit.is_ascii_digit() => {
                    push_capture(state, matcher, usize::from(digit - b'1'), whole);
                    buffer.add_value();
                }
                _ => {
                    ffi::luaL_error(state, c"invalid use of '%%' in replacement string".as_ptr());
                }
            }
            rest = &rest[at + 2..];
        }
        buffer.add(rest);
    }
}
