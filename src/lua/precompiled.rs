//! A block compiled ahead, on another thread than the one that will run it: Lua's bytecode. Knows nothing of where the
//! variables are that it uses.

use std::sync::Arc;

use super::bytecode::HEADER;
use super::desk::{UNNAMED, chunk_name};
use super::{Facts, Lua, NameUse, SyntaxError, source};

/// A block that any interpreter can take up. Only its own text makes one: what Lua is given as bytecode, it trusts.
#[derive(Debug, PartialEq)]
pub struct Precompiled {
    variables: Arc<[Box<str>]>,
    facts: Arc<Facts>,
    bytecode: Vec<u8>,
}

impl Precompiled {
    /// The names in it that are variables, each once.
    pub fn variables(&self) -> impl Iterator<Item = &str> {
        self.variables.iter().map(|name| &**name)
    }

    /// What else could have been meant by a name in it.
    pub(super) fn scope(&self) -> Arc<[Box<str>]> {
        Arc::clone(&self.variables)
    }

    pub(super) fn writes(&self, name: &str) -> bool {
        self.facts.writes.iter().any(|found| found.name == name)
    }

    /// Names it assigns that are no variables.
    pub(super) fn other_writes(&self) -> impl Iterator<Item = &NameUse> {
        self.facts.writes.iter().filter(|found| !self.variables.iter().any(|name| **name == *found.name))
    }

    /// Its bytecode as that of chunk `id`: the name, which tells where errors are, is the first thing after the header.
    pub(super) fn named(&self, id: u32) -> Vec<u8> {
        let name = chunk_name(id);
        let (header, function) = self.bytecode.split_at(HEADER);
        [header, &size_byte(&name), name.as_bytes(), &function[1 + UNNAMED.count_bytes()..]].concat()
    }
}

/// The size of a short text as `lua_dump` writes it.
fn size_byte(text: &str) -> [u8; 1] {
    [0x80 | (text.len() as u8 + 1)]
}

impl Lua {
    /// Compiles a block of which the facts are known; these of its names are variables.
    pub(super) fn precompile(
        &mut self,
        code: &str,
        facts: &Arc<Facts>,
        variables: &[&str],
    ) -> Result<Precompiled, SyntaxError> {
        if let Some(name) = variables.get(source::NAMES) {
            let mut uses = facts.reads.iter().chain(&facts.writes);
            let line = uses.find(|found| *found.name == **name).map_or(1, |found| found.line);
            let message = format!("more than {} variables in one block: move some into a table", source::NAMES);
            return Err(SyntaxError { message, line, token: Some(name.to_string()) });
        }
        // SAFETY: nothing runs, and there is no memory limit.
        let bytecode =
            self.unlimited(|lua| unsafe { source::build(lua.stack.state(), code, facts.form, variables) })?;
        let variables = variables.iter().map(|&name| name.into()).collect();
        Ok(Precompiled { variables, facts: Arc::clone(facts), bytecode })
    }
}
