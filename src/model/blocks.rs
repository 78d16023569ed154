//! What the Lua in a program's blocks refers to: variables, bridges, or nothing known.

use super::link::renamed_words;
use super::names::Names;
use super::program::{Block, Program};
use crate::lua::{self, Checker, NameUse};
use crate::syntax::lua_names::{Word, words};
use crate::syntax::lua_tokens::{TokenKind, tokens};
use crate::syntax::nearest::nearest;
use crate::syntax::{Code, Diagnostic, Source, Span};

pub fn resolve_blocks(program: &mut Program, checker: &mut Checker) {
    checker.next_program();
    let at_hand = checker.at_hand();
    let mut found = Vec::new();
    for index in 0..program.blocks.len() {
        let block = &program.blocks[index];
        let facts = match checker.check_block(&block.code) {
            Ok(facts) => facts,
            Err(error) => {
                let span = error_span(program.source(block.span), block, &error, checker);
                found.push(explained(program.source(block.span), block.span, span, &error));
                continue;
            }
        };
        let names = Names::of(program);
        let (mut reads, mut writes) = (Vec::new(), Vec::new());
        let (mut missing, mut variables) = (Vec::new(), Vec::<&str>::new());
        let mut unknown: Vec<&str> = Vec::new();
        let read = facts.reads.iter().map(|name| (name, Access::Read));
        for (name, access) in read.chain(facts.writes.iter().map(|name| (name, Access::Write))) {
            let known = match access {
                Access::Read => &mut reads,
                Access::Write => &mut writes,
            };
            let var = names.var(block.machine, &name.name);
            known.extend(var.filter(|var| !known.contains(var)));
            variables.extend(var.and(Some(&*name.name)).filter(|name| !variables.contains(name)));
            if !program.is_called(var, &name.name) && !unknown.contains(&&*name.name) {
                unknown.push(&name.name);
                let finding = unknown_name(program, index, name, access, &at_hand);
                missing.extend(finding.as_ref().filter(|_| var.is_none()).map(|_| name.name.as_str().into()));
                found.extend(finding);
            }
        }
        // What Lua refuses only now is found by the one that runs it.
        let precompiled = checker.precompile(&program.blocks[index].code, &facts, &variables).ok();
        let block = &mut program.blocks[index];
        block.precompiled = precompiled;
        block.uses = reads.iter().copied().chain(writes.iter().copied().filter(|var| !reads.contains(var))).collect();
        (block.reads, block.writes, block.missing, block.facts) = (reads, writes, missing, facts);
    }
    program.findings.extend(found);
}

#[derive(Clone, Copy, PartialEq)]
enum Access {
    Read,
    Write,
}

fn unknown_name(
    program: &Program,
    block: usize,
    name: &NameUse,
    access: Access,
    at_hand: &[&str],
) -> Option<Diagnostic> {
    let block = &program.blocks[block];
    let is_bridge = program.bridges.iter().any(|bridge| *bridge.name == *name.name);
    let is_known = is_bridge || at_hand.contains(&&*name.name);
    if is_known && access == Access::Read {
        return None;
    }
    let span = place(program.source(block.span), block.span, name.line, Some((&name.name, Role::Free)));
    let (message, help) = if is_known {
        let message = format!("`{}` can't be assigned: it is not a variable of this program", name.name);
        (message, "declare a variable of another name".to_string())
    } else if let Some(renamed) = Names::of(program).var(block.machine, &name.name) {
        renamed_words(&name.name, program.name(renamed))
    } else {
        let message = format!("`{}` is not a variable in scope here", name.name);
        (message, what_instead(program, block, &name.name, at_hand))
    };
    Some(Diagnostic::error(Code::UnknownVariable, span, message).help(help))
}

/// What was probably meant by a name that nothing in scope has.
fn what_instead(program: &Program, block: &Block, name: &str, at_hand: &[&str]) -> String {
    if let Some(inside) = program.vars.iter().find(|var| *var.name == *name) {
        return format!("`{}` is seen only in its machine: declare it further out to share it", inside.path);
    }
    if lua::SYSTEM.contains(&name) {
        return format!("blocks can't reach files and processes; `--allow-system` lets them use `{name}`");
    }
    let vars = Names::of(program).vars(block.machine);
    let bridges = program.bridges.iter().map(|bridge| &*bridge.name);
    let known = vars.iter().map(|var| &**var).chain(bridges).chain(at_hand.iter().copied());
    match nearest(name, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("declare it with `(var {name} := [..])`, or use `local` inside the block"),
    }
}

pub fn syntax_diagnostic(source: &Source, block: Span, error: &lua::SyntaxError) -> Diagnostic {
    let token = error.token.as_deref().map(|token| (token, Role::Any));
    let span = match error.message.ends_with("near <eof>") {
        true => end_of(source, block),
        false => place(source, block, error.line, token),
    };
    explained(source, block, span, error)
}

/// Where a block ends too early: at what closes it.
fn end_of(source: &Source, block: Span) -> Span {
    let close = source.text[block.end as usize..].chars().next().map_or(0, char::len_utf8);
    Span::new(block.file, block.end as usize, block.end as usize + close)
}

fn explained(source: &Source, block: Span, span: Span, error: &lua::SyntaxError) -> Diagnostic {
    let near = span.start.saturating_sub(block.start) as usize;
    let message = error.message_in(source.line(block.start as usize) as u32);
    if let Some(help) = smalltalk(source.slice(block), near) {
        let message = format!("this looks like Smalltalk; blocks are Lua: {message}");
        return Diagnostic::error(Code::Smalltalk, span, message).help(help);
    }
    if let Some(letter) = source.slice(span).chars().next().filter(|letter| !letter.is_ascii()) {
        let message = format!("`{letter}` can stand in a string or a comment only");
        return Diagnostic::error(Code::LuaSyntax, span, message)
            .help("names are made of the letters a to z, digits and `_`");
    }
    let diagnostic = Diagnostic::error(Code::LuaSyntax, span, message);
    match foreign(source.slice(block), near) {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

/// What to write in Lua for an operator of other languages.
fn foreign(code: &str, near: usize) -> Option<&'static str> {
    const OPERATORS: [(&str, &str); 8] = [
        ("+=", "Lua has no `+=`: write `x = x + 1`"),
        ("-=", "Lua has no `-=`: write `x = x - 1`"),
        ("*=", "Lua has no `*=`: write `x = x * 2`"),
        ("++", "Lua has no `++`: write `x = x + 1`"),
        ("!=", "in Lua it is written `~=`"),
        ("!", "in Lua it is written `not`"),
        ("&&", "in Lua it is written `and`"),
        ("||", "in Lua it is written `or`"),
    ];
    let is_near = |operator: &str| {
        let from = near.saturating_sub(operator.len() - 1);
        (from..=near).any(|at| code.get(at..).is_some_and(|here| here.starts_with(operator)))
    };
    OPERATORS.iter().find(|(operator, _)| is_near(operator)).map(|&(_, help)| help)
}

/// Lua tells the line and the token, which may stand there more than once: the one meant is the first up to which the
/// code already gives the same error.
fn error_span(source: &Source, block: &Block, error: &lua::SyntaxError, checker: &mut Checker) -> Span {
    let offset = block.span.start as usize;
    let first = source.line(offset);
    let in_line = |at: usize| source.line(offset + at) == first + error.line.max(1) as usize - 1;
    let is_letter = error.token.as_deref().is_some_and(|token| token.starts_with("<\\"));
    if is_letter
        && let Some(letter) =
            tokens(&block.code).find(|token| token.kind == TokenKind::Unknown && in_line(token.range.start))
    {
        return Span::new(block.span.file, offset + letter.range.start, offset + letter.range.end);
    }
    let candidates = tokens(&block.code)
        .map(|token| token.range)
        .filter(|range| in_line(range.start) && Some(&block.code[range.clone()]) == error.token.as_deref());
    for range in candidates {
        if checker.check(&block.code[..range.end]).is_err_and(|same| same == *error) {
            return Span::new(block.span.file, offset + range.start, offset + range.end);
        }
    }
    syntax_diagnostic(source, block.span, error).span
}

/// What to write in Lua, where a block that doesn't compile has the marks of Smalltalk.
fn smalltalk(code: &str, near: usize) -> Option<&'static str> {
    let ends_with_not =
        code.trim_end().ends_with(" not") || code.get(near..).is_some_and(|here| here.starts_with("not"));
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

/// What a sought name is in the code.
#[derive(Clone, Copy, PartialEq)]
pub enum Role {
    /// Found outside the block: no local, no field, no key of a table.
    Free,
    /// Not a field.
    Name,
    /// After a dot or a colon.
    Field,
    Any,
}

/// The span of a name in a line (from 1) of a block, or of the line's code where the name is not found.
pub fn place(source: &Source, block: Span, line: u32, name: Option<(&str, Role)>) -> Span {
    let first = source.line(block.start as usize);
    let range = source.line_range(first + line.max(1) as usize - 1);
    let start = range.start.clamp(block.start as usize, block.end as usize);
    let end = range.end.clamp(start, block.end as usize);
    let at = |start: usize, end: usize| Span::new(block.file, start, end);
    match name.and_then(|name| find_name(source, block, start..end.max(start + 1), name)) {
        Some(found) => found,
        None => {
            let line = &source.text[start..end];
            let indent = line.len() - line.trim_start().len();
            at((start + indent).min(end), start + line.trim_end().len().max(indent.min(line.len())))
        }
    }
}

/// The first such name among the tokens that begin in a range; one of another role where there is none of this.
fn find_name(source: &Source, block: Span, range: std::ops::Range<usize>, (name, role): (&str, Role)) -> Option<Span> {
    let code = source.slice(block);
    let offset = block.start as usize;
    let mut after_dot = false;
    let mut other = None;
    for Word { token, is_free } in words(code) {
        let text = &code[token.range.clone()];
        let is_field = std::mem::replace(&mut after_dot, matches!(text, "." | ":"));
        if text != name || !range.contains(&(offset + token.range.start)) {
            continue;
        }
        let span = Span::new(block.file, offset + token.range.start, offset + token.range.end);
        let is_it = match role {
            Role::Free => is_free,
            Role::Name => !is_field,
            Role::Field => is_field,
            Role::Any => true,
        };
        if is_it {
            return Some(span);
        }
        other.get_or_insert(span);
    }
    other
}
