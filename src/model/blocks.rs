//! What the Lua in a program's blocks refers to: variables, bridges, or nothing known.

use super::names::Names;
use super::program::Program;
use crate::lua::{self, Checker, NameUse};
use crate::syntax::lua_tokens::{TokenKind, tokens};
use crate::syntax::nearest::nearest;
use crate::syntax::{Code, Diagnostic, Source, Span};

pub fn resolve_blocks(program: &mut Program, checker: &mut Checker) {
    let mut found = Vec::new();
    for index in 0..program.blocks.len() {
        let block = &program.blocks[index];
        let facts = match checker.check(&block.code) {
            Ok(facts) => facts,
            Err(error) => {
                found.push(syntax_diagnostic(program.source(block.span), block.span, &error));
                continue;
            }
        };
        let names = Names::of(program);
        let mut uses = Vec::new();
        for (name, access) in
            facts.reads.iter().map(|name| (name, Access::Read)).chain(facts.writes.iter().map(|name| (name, Access::Write)))
        {
            match names.var(block.machine, &name.name) {
                Some(var) if !uses.contains(&var) => uses.push(var),
                Some(_) => {}
                None => found.extend(unknown_name(program, index, name, access)),
            }
        }
        program.blocks[index].uses = uses;
    }
    program.findings.extend(found);
}

#[derive(Clone, Copy, PartialEq)]
enum Access {
    Read,
    Write,
}

fn unknown_name(program: &Program, block: usize, name: &NameUse, access: Access) -> Option<Diagnostic> {
    let block = &program.blocks[block];
    let is_bridge = program.bridges.iter().any(|bridge| *bridge.name == *name.name);
    let is_at_hand = lua::known_names().contains(&&*name.name);
    let span = place(program.source(block.span), block.span, name.line, Some(&name.name));
    match access {
        Access::Read if is_bridge || is_at_hand => None,
        Access::Write if is_bridge || is_at_hand => {
            let message = format!("`{}` can't be assigned: it is not a variable of this program", name.name);
            Some(Diagnostic::error(Code::UnknownVariable, span, message).help("declare a variable of another name"))
        }
        _ => {
            let mut known: Vec<String> = Names::of(program).vars(block.machine).iter().map(ToString::to_string).collect();
            known.extend(program.bridges.iter().map(|bridge| bridge.name.to_string()));
            known.extend(lua::known_names().iter().map(ToString::to_string));
            let message = format!("`{}` is not a variable in scope here", name.name);
            let help = match nearest(&name.name, known.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("declare it with `(var {} := [..])`, or use `local` inside the block", name.name),
            };
            Some(Diagnostic::error(Code::UnknownVariable, span, message).help(help))
        }
    }
}

pub fn syntax_diagnostic(source: &Source, block: Span, error: &lua::SyntaxError) -> Diagnostic {
    let span = place(source, block, error.line, error.token.as_deref());
    let message = error.message_in(source.line(block.start as usize) as u32);
    let near = span.start.saturating_sub(block.start) as usize;
    match smalltalk(source.slice(block), near) {
        Some(help) => {
            let message = format!("this looks like Smalltalk; blocks are Lua: {message}");
            Diagnostic::error(Code::Smalltalk, span, message).help(help)
        }
        None => Diagnostic::error(Code::LuaSyntax, span, message),
    }
}

/// What to write in Lua, where a block that doesn't compile has the marks of Smalltalk.
fn smalltalk(code: &str, near: usize) -> Option<&'static str> {
    let ends_with_not = code.trim_end().ends_with(" not") || code.get(near..).is_some_and(|here| here.starts_with("not"));
    if code.contains(":=") {
        Some("in Lua a variable is assigned with `=`: `x = x + 1`")
    } else if code.contains("[:") {
        Some("in Lua a message is sent with a table: `robot.move{ linear = { x = 0.2 } }`")
    } else if ends_with_not {
        Some("in Lua `not` stands before what it negates: `not start`")
    } else {
        None
    }
}

/// The span of a name in a line (from 1) of a block, or of the line's code where the name is not found.
pub fn place(source: &Source, block: Span, line: u32, name: Option<&str>) -> Span {
    let first = source.line(block.start as usize);
    let range = source.line_range(first + line.max(1) as usize - 1);
    let start = range.start.clamp(block.start as usize, block.end as usize);
    let end = range.end.clamp(start, block.end as usize);
    let at = |start: usize, end: usize| Span::new(block.file, start, end);
    let code = &source.text[block.range()];
    let named = name.and_then(|name| {
        let offset = block.start as usize;
        let mut in_line = tokens(code)
            .filter(|token| !matches!(token.kind, TokenKind::Comment))
            .map(|token| (token.range.start + offset, token.range.end + offset))
            .filter(|&(from, _)| (start..end.max(start + 1)).contains(&from));
        in_line.find(|&(from, to)| source.text.get(from..to) == Some(name))
    });
    match named {
        Some((start, end)) => at(start, end),
        None => {
            let line = &source.text[start..end];
            let indent = line.len() - line.trim_start().len();
            at((start + indent).min(end), start + line.trim_end().len().max(indent.min(line.len())))
        }
    }
}
