//! The Lua that tests are written in: its standard libraries without what reaches files, and where an error came from.
//! Knows nothing of programs.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use mlua::chunk::ChunkMode;
use mlua::{Error, Function, HookTriggers, IntoLuaMulti, Lua, LuaOptions, MultiValue, StdLib, Table, Value, VmState};

use super::deadline::Deadline;
use super::failure::{Complaint, Failure, Place};
use crate::session::modules;
use crate::syntax::nearest::nearest;

const MEMORY: usize = 1 << 30;
/// Instructions between two looks at the deadline.
const PATIENCE: u32 = 10_000;

pub struct TestLua {
    pub lua: Lua,
    xpcall: Function,
    folder: PathBuf,
    deadline: Deadline,
}

impl TestLua {
    /// `folder`: where `require` finds Lua files, and what names of files are relative to.
    pub fn new(folder: &Path, deadline: Deadline) -> mlua::Result<TestLua> {
        let libraries = StdLib::COROUTINE | StdLib::TABLE | StdLib::STRING | StdLib::UTF8 | StdLib::MATH | StdLib::OS;
        let lua = Lua::new_with(libraries, LuaOptions::new())?;
        lua.set_memory_limit(MEMORY)?;
        let xpcall = lua.globals().raw_get("xpcall")?;
        let this = TestLua { lua, xpcall, folder: folder.to_path_buf(), deadline };
        this.restrict()?;
        this.offer_require()?;
        Ok(this)
    }

    fn restrict(&self) -> mlua::Result<()> {
        let (lua, globals) = (&self.lua, self.lua.globals());
        for name in ["dofile", "loadfile", "load", "collectgarbage"] {
            globals.raw_set(name, Value::Nil)?;
        }
        let os: Table = globals.get("os")?;
        let time = lua.create_table()?;
        for name in ["clock", "date", "difftime", "time"] {
            time.raw_set(name, os.get::<Value>(name)?)?;
        }
        globals.raw_set("os", time)?;
        let strict = lua.create_table()?;
        let unknown = lua.create_function(|lua, (_, name): (Value, Value)| -> mlua::Result<()> {
            let name = name.to_string()?;
            let names: Vec<String> = lua.globals().pairs::<String, Value>().flatten().map(|(name, _)| name).collect();
            let near = nearest(&name, names.iter().map(String::as_str));
            let hint = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            Err(Complaint::new(format!("there is no variable or function `{name}`{hint}")).into())
        })?;
        strict.raw_set("__index", unknown)?;
        globals.set_metatable(Some(strict))
    }

    fn offer_require(&self) -> mlua::Result<()> {
        let loaded = self.lua.create_table()?;
        let find = modules::library(self.folder.clone(), |_, _| ());
        let require = self.lua.create_function(move |lua, name: String| {
            let known: Value = loaded.raw_get(&*name)?;
            if !known.is_nil() {
                return Ok(known);
            }
            let text = find(&name).map_err(Complaint::new)?;
            let file = format!("={}.lua", name.replace('.', "/"));
            let chunk = lua.load(text).set_name(file).set_mode(ChunkMode::Text);
            let value = match chunk.call::<Value>(&*name)? {
                Value::Nil => Value::Boolean(true),
                value => value,
            };
            loaded.raw_set(name, &value)?;
            Ok(value)
        })?;
        self.lua.globals().raw_set("require", require)
    }

    /// A test file's text as a function.
    pub fn chunk(&self, file: &Path, text: &str) -> Result<Function, Box<Failure>> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let chunk = self.lua.load(text).set_name(format!("={name}")).set_mode(ChunkMode::Text);
        chunk.into_function().map_err(|error| self.failure(&error, Vec::new()))
    }

    /// Calls a function, or runs a file; what it raises becomes a failure with its place.
    pub fn call(&self, function: Function, arguments: impl IntoLuaMulti) -> Result<(), Box<Failure>> {
        self.deadline.restart();
        self.guarded(function, arguments).unwrap_or_else(|error| Err(self.failure(&error, Vec::new())))
    }

    fn guarded(&self, function: Function, arguments: impl IntoLuaMulti) -> mlua::Result<Result<(), Box<Failure>>> {
        self.watch()?;
        let places = Rc::new(std::cell::RefCell::new(Vec::new()));
        let (kept, folder) = (Rc::clone(&places), self.folder.clone());
        let handler = self.lua.create_function(move |lua, error: Value| {
            *kept.borrow_mut() = calls(lua, &folder);
            Ok(error)
        })?;
        let mut all = arguments.into_lua_multi(&self.lua)?;
        all.push_front(Value::Function(handler));
        all.push_front(Value::Function(function));
        let mut results: MultiValue = self.xpcall.call(all)?;
        self.lua.remove_global_hook();
        Ok(match results.pop_front() {
            Some(Value::Boolean(true)) => Ok(()),
            _ => Err(self.raised(results.pop_front().unwrap_or(Value::Nil), places.take())),
        })
    }

    /// Ends whatever runs once the deadline is over, also where it catches errors.
    fn watch(&self) -> mlua::Result<()> {
        let deadline = self.deadline.clone();
        self.lua.set_global_hook(HookTriggers::new().every_nth_instruction(PATIENCE), move |lua, _| {
            let Err(late) = deadline.check() else { return Ok(VmState::Continue) };
            let again = late.clone();
            lua.set_global_hook(HookTriggers::new().every_nth_instruction(1), move |_, _| Err(again.clone().into()))?;
            Err(late.into())
        })
    }

    fn raised(&self, error: Value, places: Vec<Place>) -> Box<Failure> {
        match error {
            Value::Error(error) => self.failure(&error, places),
            Value::String(text) => self.said(&text.to_string_lossy(), places),
            other => self.said(&format!("an error was raised that is no text but a {}", other.type_name()), places),
        }
    }

    fn failure(&self, error: &Error, places: Vec<Place>) -> Box<Failure> {
        if let Some(complaint) = error.downcast_ref::<Complaint>() {
            return Box::new(Failure { places, line: None, complaint: complaint.clone(), situation: None });
        }
        match error {
            Error::CallbackError { cause, .. } => self.failure(cause, places),
            Error::SyntaxError { message, .. } | Error::RuntimeError(message) => self.said(message, places),
            other => self.said(&other.to_string(), places),
        }
    }

    /// Lua puts the place of an error before its text.
    fn said(&self, message: &str, mut places: Vec<Place>) -> Box<Failure> {
        let message = message.split("\nstack traceback:").next().unwrap_or(message);
        let mut text = message;
        if let Some((place, rest)) = position(message, &self.folder) {
            text = rest;
            places.retain(|known| *known != place);
            places.insert(0, place);
        }
        Box::new(Failure { places, line: None, complaint: Complaint::new(text), situation: None })
    }
}

/// `x_test.lua:12: text` in its parts.
fn position<'m>(message: &'m str, folder: &Path) -> Option<(Place, &'m str)> {
    let (start, text) = message.split_once(": ")?;
    let (file, line) = start.rsplit_once(':')?;
    let line = line.parse().ok()?;
    file.ends_with(".lua").then(|| (Place { file: join(folder, file), line }, text))
}

/// How far out an error is traced: each level is looked up anew from the innermost one, and a recursion has very many.
const CALLS: usize = 100;

/// The lines of test files that are being run, innermost first.
fn calls(lua: &Lua, folder: &Path) -> Vec<Place> {
    let mut places = Vec::new();
    for level in 0..CALLS {
        let Some(found) = lua.inspect_stack(level, |debug| {
            let source = debug.source().source.map(|source| source.into_owned());
            (source, debug.current_line())
        }) else {
            break;
        };
        if let (Some(source), Some(line)) = found
            && let Some(file) = source.strip_prefix('=').filter(|file| file.ends_with(".lua"))
        {
            places.push(Place { file: join(folder, file), line });
        }
    }
    places
}

fn join(folder: &Path, file: &str) -> PathBuf {
    if folder == Path::new(".") { PathBuf::from(file) } else { folder.join(file) }
}
