//! A block's text as it reads once its variables are called what the next program calls them, letter by letter.

use std::sync::Arc;

use super::ids::*;
use super::matching::Matching;
use super::program::Program;
use crate::syntax::lua_names;

/// The old text with the new names in it; layout and comments stay.
pub fn code_now(old: &Program, block: BlockId, new: &Program, matching: &Matching) -> Arc<str> {
    let was = &old[block];
    let is_renamed = |&var: &VarId| matching.var(var).is_some_and(|now| new[now].name != old[var].name);
    if old.alias.is_none() && !was.uses.iter().any(is_renamed) {
        return was.code.clone();
    }
    let mut code = String::with_capacity(was.code.len());
    let mut copied = 0;
    for word in lua_names::words(&was.code).into_iter().filter(|word| word.is_free) {
        let name = &was.code[word.token.range.clone()];
        if let Some(now) = old.var_in(was, name).and_then(|var| matching.var(var)) {
            code.push_str(&was.code[copied..word.token.range.start]);
            code.push_str(&new[now].name);
            copied = word.token.range.end;
        }
    }
    code.push_str(&was.code[copied..]);
    code.into()
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
