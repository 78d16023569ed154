//! What a running block can reach of its interpreter: program time, the log, where blocks stand in their files. Knows nothing of how blocks are called.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::ffi::{CStr, c_void};
use std::sync::Arc;

use mlua_sys as ffi;

use super::Block;
use super::guard::Guard;
use super::log::Log;
use crate::syntax::nearest::nearest;

/// A line of a chunk: a block's text, told from others by a number that is never used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot {
    pub chunk: u32,
    pub line: u32,
}

/// What is known of a compiled text. It outlives the block, as functions made by it may.
#[derive(Default)]
pub(super) struct Chunk {
    pub block: Option<Block>,
    pub place: Option<(Arc<str>, u32)>,
    pub scope: Arc<[Box<str>]>,
}

pub(super) struct Desk {
    pub guard: Arc<Guard>,
    /// Microseconds: only blocks that ask pay for milliseconds.
    pub now: Cell<u64>,
    pub since: Cell<u64>,
    pub log: Log,
    /// By their numbers; the first stands for texts that are only looked at.
    pub chunks: RefCell<Vec<Chunk>>,
    /// Where the error being raised was raised.
    pub fault: Cell<Option<Spot>>,
    /// The names every block has at hand.
    pub known: RefCell<BTreeSet<String>>,
}

/// Its address is the desk's key in Lua's registry.
static KEY: u8 = 0;

/// Begins the names of chunks, so that positions in messages can be told from the user's text.
pub(super) const MARK: char = '\u{1}';

/// A chunk that has no number yet.
pub(super) const UNNAMED: &CStr = c"=\x010";

/// The name under which Lua knows the text of chunk `id`.
pub(super) fn chunk_name(id: u32) -> String {
    format!("={MARK}{id}")
}

impl Desk {
    pub fn new(guard: Arc<Guard>) -> Self {
        Self {
            guard,
            now: Cell::new(0),
            since: Cell::new(0),
            log: Log::default(),
            chunks: RefCell::new(vec![Chunk::default()]),
            fault: Cell::new(None),
            known: RefCell::default(),
        }
    }

    /// Where line `line` of chunk `id` is in its file.
    pub fn place(&self, id: u32, line: u32) -> Option<(String, u32)> {
        let chunks = self.chunks.borrow();
        let (file, first) = chunks.get(id as usize)?.place.as_ref()?;
        Some((file.to_string(), first + line.saturating_sub(1)))
    }

    /// Program time in milliseconds.
    pub fn now_ms(&self) -> f64 {
        milliseconds(self.now.get())
    }

    /// Milliseconds since the state was entered.
    pub fn elapsed_ms(&self) -> f64 {
        milliseconds(self.now.get()) - milliseconds(self.since.get())
    }

    pub fn block(&self, spot: Option<Spot>) -> Option<Block> {
        self.chunks.borrow().get(spot?.chunk as usize)?.block
    }

    /// The name nearest to `name` of those that code of chunk `spot` can use.
    pub fn suggest(&self, name: &str, spot: Option<Spot>) -> Option<String> {
        let (chunks, known) = (self.chunks.borrow(), self.known.borrow());
        let scope = spot.and_then(|spot| chunks.get(spot.chunk as usize)).map(|chunk| &*chunk.scope);
        let scope = scope.unwrap_or_default().iter().map(|name| &**name);
        nearest(name, scope.chain(known.iter().map(String::as_str))).map(str::to_owned)
    }
}

fn milliseconds(us: u64) -> f64 {
    us as f64 / 1000.0
}

/// Puts `desk` where C functions find it.
///
/// # Safety
/// `state` is a live state with a free stack slot; `desk` outlives it.
pub(super) unsafe fn install(state: *mut ffi::lua_State, desk: *const Desk) {
    unsafe {
        ffi::lua_pushlightuserdata(state, desk as *mut c_void);
        ffi::lua_rawsetp(state, ffi::LUA_REGISTRYINDEX, (&raw const KEY).cast());
    }
}

/// The desk of the interpreter `state` belongs to.
///
/// # Safety
/// `install` was called for it, and the stack has a free slot.
pub(super) unsafe fn desk<'a>(state: *mut ffi::lua_State) -> &'a Desk {
    unsafe {
        ffi::lua_rawgetp(state, ffi::LUA_REGISTRYINDEX, (&raw const KEY).cast());
        let desk = ffi::lua_touserdata(state, -1) as *const Desk;
        ffi::lua_pop(state, 1);
        &*desk
    }
}

/// How many calls are looked through for one in a block: deep recursion must not make errors slow.
const LEVELS: i32 = 200;

/// The innermost line of a block's text being run in `state`.
///
/// # Safety
/// Called from C that Lua called, in `state`.
pub(super) unsafe fn spot(state: *mut ffi::lua_State) -> Option<Spot> {
    for level in 0..LEVELS {
        // SAFETY: lua_getstack fills what lua_getinfo needs; all zeroes are a valid lua_Debug.
        let found = unsafe {
            let mut activation: ffi::lua_Debug = std::mem::zeroed();
            if ffi::lua_getstack(state, level, &mut activation) == 0 {
                return None;
            }
            ffi::lua_getinfo(state, c"Sl".as_ptr(), &mut activation);
            chunk_of(CStr::from_ptr(activation.source)).zip(u32::try_from(activation.currentline).ok())
        };
        if let Some((chunk, line)) = found {
            return Some(Spot { chunk, line });
        }
    }
    None
}

fn chunk_of(source: &CStr) -> Option<u32> {
    let digits = source.to_bytes().strip_prefix(b"=\x01")?;
    std::str::from_utf8(digits).ok()?.parse().ok()
}
