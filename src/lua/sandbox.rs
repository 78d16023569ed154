//! What every block has at hand, and that it gets at nothing else. Knows nothing of variables.

use std::ffi::c_int;
use std::rc::Rc;
use std::sync::OnceLock;

use mlua::{Function, LuaOptions, StdLib, Table};
use mlua_sys as ffi;

use super::desk::Desk;
use super::{Access, base, bounded, coroutines, log, search, text};

/// Lua's own functions, behind ours of the same name.
pub(super) struct Originals {
    concat: ffi::lua_CFunction,
    format: ffi::lua_CFunction,
    insert: ffi::lua_CFunction,
    load: ffi::lua_CFunction,
    rawset: ffi::lua_CFunction,
    remove: ffi::lua_CFunction,
    rep: ffi::lua_CFunction,
    setmetatable: ffi::lua_CFunction,
    shift: ffi::lua_CFunction,
    sort: ffi::lua_CFunction,
    xpcall: ffi::lua_CFunction,
}

static ORIGINALS: OnceLock<Originals> = OnceLock::new();

/// Lua's own functions. Ours call them in their own frame, so that messages and positions stay right.
pub(super) fn originals() -> &'static Originals {
    match ORIGINALS.get() {
        Some(originals) => originals,
        None => unreachable!("they are taken before any of ours can be called"),
    }
}

macro_rules! forward {
    ($($name:ident)*) => {
        impl Originals {
            $(
                /// # Safety
                /// Called from C that Lua called, with its arguments on the stack.
                pub unsafe fn $name(&self, state: *mut ffi::lua_State) -> c_int {
                    unsafe { (self.$name)(state) }
                }
            )*
        }
    };
}

forward!(concat format insert load rawset remove rep setmetatable shift sort xpcall);

/// Whether iteration over a table's keys is the same in every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Lua's hash seed is fixed.
    Fixed,
    /// It isn't, so `pairs` sorts the keys.
    ByKey,
}

/// The order in which Lua has the keys below when its hash seed is the one in .cargo/config.toml.
const KNOWN_ORDER: &str = include_str!("order.txt");
const KEYS: &str = "local t, s = {}, {} for i = 1, 24 do t['key' .. i] = i end for k in next, t do s[#s + 1] = k end return table.concat(s, ' ')";

/// Finds the text of a module by its name, or says why it doesn't.
pub type Finder = Box<dyn Fn(&str) -> Result<String, String>>;

/// Tables the prelude and Rust share.
pub(super) struct Sandbox {
    pub mlua: mlua::Lua,
    pub environment: Table,
    /// Modules that were read, by name.
    pub loaded: Table,
    own: Table,
}

impl Sandbox {
    pub fn new(access: Access, desk: &Rc<Desk>, seed: u64) -> mlua::Result<Self> {
        let mlua = interpreter(access);
        mlua.set_app_data(desk.clone());
        // SAFETY: the state is live, nothing runs, and the application data keeps the desk as long as the state.
        unsafe { mlua.exec_raw::<()>((), |state| super::desk::install(state, Rc::as_ptr(desk)))? };
        let (environment, own, loaded) = (mlua.globals(), mlua.create_table()?, mlua.create_table()?);
        own.set("loaded", &loaded)?;
        let sandbox = Self { mlua, environment, loaded, own };
        sandbox.take_originals()?;
        let order = sandbox.order()?;
        sandbox.replace_functions()?;
        sandbox.protect_strings()?;
        sandbox.run_prelude(access, order, seed)?;
        sandbox.be_strict()?;
        let names = sandbox.environment.pairs::<String, mlua::Value>().filter_map(|pair| Some(pair.ok()?.0));
        desk.known.borrow_mut().extend(names);
        Ok(sandbox)
    }

    /// The function by which modules are found: their text, or why not.
    pub fn set_finder(&self, find: Finder) -> mlua::Result<()> {
        let find = self.mlua.create_function(move |_, name: String| {
            Ok(match find(&name) {
                Ok(text) => (Some(text), None),
                Err(why) => (None, Some(why)),
            })
        })?;
        self.own.raw_set("find", find)
    }

    fn order(&self) -> mlua::Result<Order> {
        let order: String = self.mlua.load(KEYS).eval()?;
        Ok(if order == KNOWN_ORDER.trim_end() { Order::Fixed } else { Order::ByKey })
    }

    fn take_originals(&self) -> mlua::Result<()> {
        let env = &self.environment;
        let (table, string): (Table, Table) = (env.get("table")?, env.get("string")?);
        let originals = Originals {
            concat: self.original(&table, "concat")?,
            format: self.original(&string, "format")?,
            insert: self.original(&table, "insert")?,
            load: self.original(env, "load")?,
            rawset: self.original(env, "rawset")?,
            remove: self.original(&table, "remove")?,
            rep: self.original(&string, "rep")?,
            setmetatable: self.original(env, "setmetatable")?,
            shift: self.original(&table, "move")?,
            sort: self.original(&table, "sort")?,
            xpcall: self.original(env, "xpcall")?,
        };
        ORIGINALS.get_or_init(|| originals);
        Ok(())
    }

    fn original(&self, library: &Table, name: &str) -> mlua::Result<ffi::lua_CFunction> {
        let function: Function = library.raw_get(name)?;
        let mut found = None;
        // SAFETY: the function is on top of the stack.
        unsafe { self.mlua.exec_raw::<()>(function, |state| found = ffi::lua_tocfunction(state, -1))? };
        found.ok_or_else(|| mlua::Error::runtime(format!("{name} isn't Lua's own")))
    }

    fn replace_functions(&self) -> mlua::Result<()> {
        let env = &self.environment;
        for name in ["dofile", "loadfile", "collectgarbage", "warn"] {
            env.raw_set(name, mlua::Value::Nil)?;
        }
        env.raw_set("log", self.mlua.create_table()?)?;
        if !env.contains_key("os")? {
            env.raw_set("os", self.mlua.create_table()?)?;
        }
        env.raw_get::<Table>("string")?.raw_set("dump", mlua::Value::Nil)?;
        for (library, functions) in FUNCTIONS {
            let library = if library.is_empty() { env.clone() } else { env.raw_get(*library)? };
            for &(name, function) in *functions {
                // SAFETY: each keeps to Lua's rules for C functions: it owns nothing that needs a destructor where it can raise an error.
                library.raw_set(name, unsafe { self.mlua.create_c_function(function)? })?;
            }
        }
        Ok(())
    }

    fn run_prelude(&self, access: Access, order: Order, seed: u64) -> mlua::Result<()> {
        for name in ["now", "pcall", "getmetatable", "rawget"] {
            self.own.raw_set(name, self.environment.raw_get::<Function>(name)?)?;
        }
        self.own.raw_set("seed", seed as i64)?;
        self.own.raw_set("date", self.date(access)?)?;
        self.set_finder(Box::new(|name| Err(format!("module '{name}' is not found"))))?;
        let order = match order {
            Order::Fixed => "as stored",
            Order::ByKey => "by key",
        };
        let prelude = self.mlua.load(include_str!("prelude.lua")).set_name("=lrp");
        prelude.call::<()>((&self.environment, &self.own, order))?;
        for (name, key) in [("less", &raw const bounded::LESS), ("compare", &raw const bounded::COMPARE)] {
            let function: Function = self.own.raw_get(name)?;
            // SAFETY: the function is on top of the stack; the key is an address of ours.
            unsafe {
                self.mlua
                    .exec_raw::<()>(function, |state| ffi::lua_rawsetp(state, ffi::LUA_REGISTRYINDEX, key.cast()))?
            };
        }
        Ok(())
    }

    /// Lua's `os.date`, without the library it is in.
    fn date(&self, access: Access) -> mlua::Result<Function> {
        match access {
            Access::System => self.environment.raw_get::<Table>("os")?.raw_get("date"),
            Access::Sandboxed => {
                // SAFETY: luaopen_os is a function for Lua to call.
                let open = unsafe { self.mlua.create_c_function(ffi::luaopen_os)? };
                open.call::<Table>(())?.raw_get("date")
            }
        }
    }

    /// What `("x"):upper()` finds stays, whatever is done to `string`.
    fn protect_strings(&self) -> mlua::Result<()> {
        let copy = self.mlua.create_table()?;
        for pair in self.environment.raw_get::<Table>("string")?.pairs::<String, mlua::Value>() {
            let (name, function) = pair?;
            copy.raw_set(name, function)?;
        }
        let metatable = self.mlua.create_table()?;
        metatable.raw_set("__index", copy)?;
        metatable.raw_set("__metatable", false)?;
        // SAFETY: pops the metatable; a string's metatable is that of all strings.
        unsafe {
            self.mlua.exec_raw::<()>(("", metatable), |state| {
                ffi::lua_setmetatable(state, -2);
            })
        }
    }

    /// An unknown name is an error.
    fn be_strict(&self) -> mlua::Result<()> {
        let metatable = self.mlua.create_table()?;
        // SAFETY: as for the functions above.
        unsafe {
            metatable.raw_set("__index", self.mlua.create_c_function(base::read_unknown)?)?;
            metatable.raw_set("__newindex", self.mlua.create_c_function(base::write_unknown)?)?;
        }
        metatable.raw_set("__metatable", false)?;
        self.environment.set_metatable(Some(metatable))
    }
}

fn interpreter(access: Access) -> mlua::Lua {
    let options = LuaOptions::new().catch_rust_panics(true);
    let safe = StdLib::TABLE | StdLib::STRING | StdLib::MATH | StdLib::UTF8 | StdLib::COROUTINE;
    match access {
        // SAFETY: the only unsafe library is debug, which the user asked for.
        Access::System => unsafe {
            mlua::Lua::unsafe_new_with(safe | StdLib::IO | StdLib::OS | StdLib::DEBUG, options)
        },
        // SAFETY: no library in it is unsafe.
        Access::Sandboxed => unsafe { mlua::Lua::unsafe_new_with(safe, options) },
    }
}

type Functions = &'static [(&'static str, ffi::lua_CFunction)];

/// Our functions, by library; in front the names without one.
const FUNCTIONS: &[(&str, Functions)] = &[
    (
        "",
        &[
            ("elapsed", base::elapsed),
            ("load", base::load),
            ("now", base::now),
            ("print", log::info),
            ("rawset", base::rawset),
            ("setmetatable", base::setmetatable),
            ("tostring", text::tostring),
            ("xpcall", coroutines::xpcall),
        ],
    ),
    ("coroutine", &[("close", coroutines::close), ("resume", coroutines::resume), ("wrap", coroutines::wrap)]),
    ("log", &[("debug", log::debug), ("info", log::info), ("warn", log::warn), ("error", log::error)]),
    (
        "string",
        &[
            ("find", search::find),
            ("format", text::format),
            ("gmatch", search::gmatch),
            ("gsub", search::gsub),
            ("match", search::matched),
            ("rep", bounded::rep),
        ],
    ),
    (
        "table",
        &[
            ("concat", bounded::concat),
            ("insert", bounded::insert),
            ("move", bounded::shift),
            ("remove", bounded::remove),
            ("sort", bounded::sort),
        ],
    ),
];
