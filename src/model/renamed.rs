//! Lua as it reads once its variables are called what the next program calls them, letter by letter.

use std::sync::Arc;

use super::ids::*;
use super::matching::Matching;
use super::names::Names;
use super::program::Program;
use crate::syntax::lua_names::{self, Word};

/// A local of the code has the name that a variable has now, so the code can't be said with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Captured(pub Arc<str>);

/// A block's old text with the new names in it; layout and comments stay.
///
/// # Errors
/// Where a local of the block has one of the new names.
pub fn code_now(old: &Program, block: BlockId, new: &Program, matching: &Matching) -> Result<Arc<str>, Captured> {
    let was = &old[block];
    let is_renamed = |&var: &VarId| matching.var(var).is_some_and(|now| new[now].name != old[var].name);
    if old.alias.is_none() && !was.uses.iter().any(is_renamed) {
        return Ok(was.code.clone());
    }
    with_names(&was.code, |name| Some(&new[matching.var(old.var_in(was, name)?)?].name))
}

/// The same for an expression that sees the variables of a machine, or those at top level.
///
/// # Errors
/// Where a local of the expression has one of the new names.
pub fn expression_now(
    code: &str,
    old: &Program,
    machine: Option<MachineId>,
    new: &Program,
    matching: &Matching,
) -> Result<Arc<str>, Captured> {
    with_names(code, |name| Some(&new[matching.var(Names::of(old).var(machine, name)?)?].name))
}

fn with_names<'n>(code: &str, now: impl Fn(&str) -> Option<&'n Arc<str>>) -> Result<Arc<str>, Captured> {
    let mut text = String::with_capacity(code.len());
    let mut copied = 0;
    let mut replaced = Vec::new();
    for (index, Word { token, .. }) in lua_names::words(code).iter().enumerate().filter(|(_, word)| word.is_free) {
        let name = &code[token.range.clone()];
        if let Some(now) = now(name).filter(|now| ***now != *name) {
            text.push_str(&code[copied..token.range.start]);
            text.push_str(now);
            copied = token.range.end;
            replaced.push((index, now));
        }
    }
    text.push_str(&code[copied..]);
    let words = if replaced.is_empty() { Vec::new() } else { lua_names::words(&text) };
    match replaced.into_iter().find(|&(index, _)| !words[index].is_free) {
        Some((_, name)) => Err(Captured(name.clone())),
        None => Ok(text.into()),
    }
}

/// Where in a text of the same words a place of another text is; both count bytes.
pub fn place_now(was: &str, now: &str, place: usize) -> usize {
    let (before, after) = (lua_names::words(was), lua_names::words(now));
    let index = before.partition_point(|word| word.token.range.start <= place);
    let ranges =
        index.checked_sub(1).and_then(|index| Some((&before[index].token.range, &after.get(index)?.token.range)));
    let Some((was, now)) = ranges else { return place };
    match place < was.end {
        true => (now.start + place - was.start).min(now.end),
        false => now.end + place - was.end,
    }
}
