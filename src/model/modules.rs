//! The Lua files that a program's blocks require by literal names, also through each other. Knows nothing of disks.

use std::collections::BTreeSet;
use std::ops::Range;

use super::files::MOST;
use super::ids::ModuleId;
use super::program::{Module, Program};
use crate::syntax::lua_tokens::{Token, TokenKind, tokens};
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

/// `require "name"` or `require("name")` in a piece of Lua.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Required {
    pub name: String,
    /// Of the name with its quotes.
    pub range: Range<usize>,
}

/// What a piece of Lua requires by literal names, in the order written.
pub fn required(code: &str) -> Vec<Required> {
    if !code.contains("require") {
        return Vec::new();
    }
    let comment = |token: &Token| matches!(token.kind, TokenKind::Comment | TokenKind::UnclosedComment);
    let tokens: Vec<Token> = tokens(code).filter(|token| !comment(token)).collect();
    let text = |at: usize| tokens.get(at).map_or("", |token| &code[token.range.clone()]);
    let mut found = Vec::new();
    for at in (0..tokens.len()).filter(|&at| text(at) == "require") {
        let field = at > 0 && matches!(text(at - 1), "." | ":" | "function");
        let (name, closed) = match text(at + 1) {
            "(" => (at + 2, matches!(text(at + 3), ")" | ",")),
            _ => (at + 1, true),
        };
        let literal = tokens.get(name).filter(|token| token.kind == TokenKind::String && closed && !field);
        if let Some(Token { range, .. }) = literal
            && let Some(name) = plain(&code[range.clone()])
        {
            found.push(Required { name: name.to_string(), range: range.clone() });
        }
    }
    found
}

/// The inside of a string in quotes without escapes: a module's name needs none.
fn plain(string: &str) -> Option<&str> {
    let inside = ['"', '\''].iter().find_map(|&quote| string.strip_prefix(quote)?.strip_suffix(quote))?;
    (!inside.contains('\\')).then_some(inside)
}

/// Puts the required files into the program, and notes in each block which it requires. `find` gives the text of a module by
/// its name, or why there is none: that is found out again when the block runs, and only warned of here.
pub fn collect(program: &mut Program, mut find: impl FnMut(&str) -> Result<Source, String>) {
    let mut missing = Vec::new();
    for index in 0..program.blocks.len() {
        let span = program.blocks[index].span;
        let mut requires = BTreeSet::new();
        for Required { name, range } in required(&program.blocks[index].code.clone()) {
            match module(program, &name, &mut find) {
                Ok(module) => requires.insert(module),
                Err(why) => {
                    let start = span.start as usize;
                    let place = Span::new(span.file, start + range.start, start + range.end);
                    missing.push(Diagnostic::warning(Code::UnknownModule, place, why));
                    continue;
                }
            };
        }
        program.blocks[index].requires = requires.into_iter().collect();
    }
    let all: Vec<ModuleId> = (0..program.modules.len() as u32).map(ModuleId).collect();
    let closed: Vec<Vec<ModuleId>> = all.iter().map(|&it| closure(program, &program[it].requires)).collect();
    for (module, requires) in program.modules.iter_mut().zip(closed) {
        module.requires = requires;
    }
    for index in 0..program.blocks.len() {
        program.blocks[index].requires = closure(program, &program.blocks[index].requires);
    }
    program.findings.extend(missing);
}

/// The module of a name, with what it requires itself.
fn module(
    program: &mut Program,
    name: &str,
    find: &mut impl FnMut(&str) -> Result<Source, String>,
) -> Result<ModuleId, String> {
    if let Some(known) = program.modules.iter().position(|module| *module.name == *name) {
        return Ok(ModuleId(known as u32));
    }
    if program.modules.len() == MOST {
        return Err(format!("`{name}` is not taken for part of the program: {MOST} Lua files are required already"));
    }
    let source = find(name)?;
    let id = ModuleId(program.modules.len() as u32);
    let names = required(&source.text);
    let file = FileId(program.sources.len() as u16);
    program.sources.push(source);
    program.modules.push(Module { name: name.into(), file, requires: Vec::new() });
    // One that isn't there is told of when it is required.
    let requires: BTreeSet<ModuleId> =
        names.iter().filter_map(|required| module(program, &required.name, find).ok()).collect();
    program.modules[id.index()].requires = requires.into_iter().collect();
    Ok(id)
}

/// Some modules and all that they require.
fn closure(program: &Program, modules: &[ModuleId]) -> Vec<ModuleId> {
    let mut all: BTreeSet<ModuleId> = BTreeSet::new();
    let mut next = modules.to_vec();
    while let Some(module) = next.pop() {
        if all.insert(module) {
            next.extend(&program[module].requires);
        }
    }
    all.into_iter().collect()
}
