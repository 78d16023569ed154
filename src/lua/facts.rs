//! What can be said of a block without running it. Knows nothing of variables.

use std::sync::{Arc, LazyLock};

use serde_json::Value;

use super::bytecode::{self, Kind, Use};
use super::known::Known;
use super::precompiled::Precompiled;
use super::registers::{FieldUse, Gives};
use super::source::Form;
use super::value::Bounds;
use super::{Access, Failure, Limits, Lua, SyntaxError, source};

/// A free name of a block: neither a local nor a field. Built-in names are among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameUse {
    pub name: String,
    /// 1-based in the block's text.
    pub line: u32,
}

/// The free names of a block, by line: those it reads and those it assigns, functions in it included.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    pub reads: Vec<NameUse>,
    pub writes: Vec<NameUse>,
    /// Fields of free names, by line; not all can be told.
    pub fields: Vec<FieldUse>,
    pub gives: Gives,
    pub(super) form: Form,
}

/// Looks at blocks with an interpreter of its own.
pub struct Checker {
    lua: Lua,
    access: Access,
    known: Known,
}

/// Bounds of a configuration.
const CONFIG: Bounds = Bounds { depth: 16, bytes: 1 << 20 };

impl Default for Checker {
    fn default() -> Self {
        Self::new(Access::Sandboxed)
    }
}

impl Checker {
    /// For blocks that will have this access.
    pub fn new(access: Access) -> Self {
        Self { lua: Lua::new(Limits::default(), Access::Sandboxed, 0), access, known: Known::default() }
    }

    /// The names that every block has at hand.
    pub fn at_hand(&self) -> Vec<&'static str> {
        let besides: &[&str] = match self.access {
            Access::Sandboxed => &[],
            Access::System => SYSTEM,
        };
        known_names().iter().chain(besides).copied().collect()
    }

    /// Begins with another program: blocks that were in one of the last two are known.
    pub fn next_program(&mut self) {
        self.known.next_program();
    }

    /// What can be said of a block of the program; one that is known isn't looked at again.
    ///
    /// # Errors
    /// As for `check`.
    pub fn check_block(&mut self, code: &Arc<str>) -> Result<Arc<Facts>, SyntaxError> {
        if let Some(facts) = self.known.get(code) {
            return Ok(facts);
        }
        let facts = Arc::new(self.check(code)?);
        self.known.insert(code.clone(), facts.clone());
        Ok(facts)
    }

    /// A block that was looked at, compiled with those of its free names as variables, each named once. One that is known
    /// isn't compiled again.
    ///
    /// # Errors
    /// There are more than 200 variables.
    pub fn precompile(
        &mut self,
        code: &Arc<str>,
        facts: &Arc<Facts>,
        variables: &[&str],
    ) -> Result<Arc<Precompiled>, SyntaxError> {
        if let Some(precompiled) = self.known.precompiled(code, variables) {
            return Ok(precompiled);
        }
        let precompiled = Arc::new(self.lua.precompile(code, facts, variables)?);
        self.known.insert_precompiled(code, precompiled.clone());
        Ok(precompiled)
    }

    /// The fields of a library that every block has at hand, sorted; none where that isn't known of a name.
    pub fn fields(&self, library: &str) -> &'static [&'static str] {
        match self.access {
            Access::System if library == "os" => &[],
            _ => known_fields(library),
        }
    }

    /// What can be said of a block.
    ///
    /// # Errors
    /// The text is neither an expression nor statements.
    pub fn check(&mut self, code: &str) -> Result<Facts, SyntaxError> {
        self.lua.facts(code)
    }

    /// The value of `{code}`: a configuration, which is data, so no names are at hand. Lines are those of `code`.
    ///
    /// # Errors
    /// The text isn't the inside of a table, uses a name, fails, or takes more than a block may.
    pub fn config(&mut self, code: &str) -> Result<Value, SyntaxError> {
        let code = format!("{{{code}\n}}");
        let facts = self.check(&code)?;
        if let Some(NameUse { name, line }) = facts.reads.into_iter().chain(facts.writes).next() {
            let message = format!("'{name}' is nothing here: a configuration is data; a text needs quotation marks");
            return Err(SyntaxError { message, line, token: Some(name) });
        }
        let block = self.lua.compile(&code, &[])?;
        let value = self.lua.eval_within(block, CONFIG);
        self.lua.free_block(block);
        value.map_err(|Failure { message, line, token, .. }| SyntaxError { message, line, token })
    }
}

impl Lua {
    /// What can be said of a block.
    ///
    /// # Errors
    /// The text is neither an expression nor statements.
    pub fn facts(&mut self, code: &str) -> Result<Facts, SyntaxError> {
        // SAFETY: nothing runs, and there is no memory limit.
        let (form, read) = self.unlimited(|lua| unsafe { source::analyse(lua.stack.state(), code) })?;
        let bytecode::Read { uses, fields, gives } = read;
        let mut facts = Facts { fields, gives, form, ..Facts::default() };
        for Use { name, line, kind } in uses {
            match kind {
                Kind::Read => facts.reads.push(NameUse { name, line }),
                Kind::Write => facts.writes.push(NameUse { name, line }),
            }
        }
        Ok(facts)
    }

    /// Every name that blocks can use besides variables: built-in ones, and robots.
    pub fn at_hand(&self) -> Vec<String> {
        self.desk.known.borrow().iter().cloned().collect()
    }
}

/// The names that blocks have at hand only where the command line allows it.
pub const SYSTEM: &[&str] = &["debug", "io"];

/// The names every block has at hand, sorted; those of `Access::System` besides are in [`SYSTEM`].
pub fn known_names() -> &'static [&'static str] {
    static NAMES: LazyLock<Vec<&str>> = LazyLock::new(|| KNOWN.iter().map(|(name, _)| *name).collect());
    &NAMES
}

/// The fields of a library every block has at hand, sorted; none for other names.
pub fn known_fields(library: &str) -> &'static [&'static str] {
    KNOWN.iter().find(|(name, _)| *name == library).map_or(&[], |(_, fields)| fields)
}

const KNOWN: &[(&str, &[&str])] = &[
    ("_G", &[]),
    ("_VERSION", &[]),
    ("assert", &[]),
    ("coroutine", &["close", "create", "isyieldable", "resume", "running", "status", "wrap", "yield"]),
    ("elapsed", &[]),
    ("error", &[]),
    ("getmetatable", &[]),
    ("ipairs", &[]),
    ("load", &[]),
    ("log", &["debug", "error", "info", "warn"]),
    (
        "math",
        &[
            "abs",
            "acos",
            "asin",
            "atan",
            "atan2",
            "ceil",
            "cos",
            "cosh",
            "deg",
            "exp",
            "floor",
            "fmod",
            "frexp",
            "huge",
            "ldexp",
            "log",
            "log10",
            "max",
            "maxinteger",
            "min",
            "mininteger",
            "modf",
            "pi",
            "pow",
            "rad",
            "random",
            "randomseed",
            "sin",
            "sinh",
            "sqrt",
            "tan",
            "tanh",
            "tointeger",
            "type",
            "ult",
        ],
    ),
    ("next", &[]),
    ("now", &[]),
    ("os", &["clock", "date", "time"]),
    ("pairs", &[]),
    ("pcall", &[]),
    ("print", &[]),
    ("rawequal", &[]),
    ("rawget", &[]),
    ("rawlen", &[]),
    ("rawset", &[]),
    ("require", &[]),
    ("select", &[]),
    ("setmetatable", &[]),
    (
        "string",
        &[
            "byte", "char", "find", "format", "gmatch", "gsub", "len", "lower", "match", "pack", "packsize", "rep",
            "reverse", "sub", "unpack", "upper",
        ],
    ),
    ("table", &["concat", "insert", "move", "pack", "remove", "sort", "unpack"]),
    ("tonumber", &[]),
    ("tostring", &[]),
    ("type", &[]),
    ("utf8", &["char", "charpattern", "codepoint", "codes", "len", "offset"]),
    ("xpcall", &[]),
];
