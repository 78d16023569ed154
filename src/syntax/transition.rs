//! The four forms of a transition: `on`, `eps`, `ontime`, `exit`. Knows how they are written, not what they do.

use super::ast::{Name, Sources, Timeout, Transition, TransitionKind, Trigger};
use super::diagnostic::{Code, Diagnostic};
use super::form::Form;
use super::keyword::Keyword;
use super::leaves::breakpoint;
use super::names::shortened;
use super::pieces::PieceKind;
use super::reader::{Group, Node};
use super::source::Span;

/// Just over 31 years; what is longer is a mistake.
pub const MAX_TIMEOUT_MS: f64 = 1e12;

pub fn transition(form: &mut Form) -> Option<Transition> {
    let before = before_arrow(form)?;
    let (kind, sources) = match form.keyword {
        Keyword::Eps => (TransitionKind::Eps, before),
        Keyword::Ontime => {
            let (first, sources) = split(form, before, "milliseconds")?;
            (TransitionKind::Ontime(timeout(form, first)?), sources)
        }
        Keyword::Exit => {
            let (first, sources) = split(form, before, "an event")?;
            (TransitionKind::Exit(trigger(form, first)?), sources)
        }
        _ => {
            let (first, sources) = split(form, before, "an event")?;
            (TransitionKind::On(trigger(form, first)?), sources)
        }
    };
    let sources = source(form, sources)?;
    let target = form.name("a target state")?;
    let name = name(form);
    let breaks = breaks(form);
    if form.rest.first().is_some_and(|node| !breaks.is_empty() && node.is(PieceKind::Word)) {
        let diagnostic = form.error(form.text.point(&form.rest[0]), "a transition's name comes before its `(break)`");
        form.fail::<()>(diagnostic.help(format!("write `{} (break)`", form.text.of(&form.rest[0]))));
    }
    form.finish();
    Some(Transition { span: form.span(), kind, sources, target, name, breaks })
}

/// Those at the end of a transition.
fn breaks(form: &mut Form) -> Vec<Span> {
    let mut breaks = Vec::new();
    while let Some(group) = form.rest.first().and_then(as_break) {
        form.next();
        let mut inner = Form::new(form.text, group, Keyword::Break);
        breaks.extend(breakpoint(&mut inner));
        if let Some(fault) = inner.fault {
            form.fail::<()>(fault);
        }
    }
    breaks
}

fn as_break(node: &Node) -> Option<&Group> {
    match node {
        Node::Group(group) if group.keyword == Some(Keyword::Break) => Some(group),
        _ => None,
    }
}

fn name(form: &mut Form) -> Option<Name> {
    if let Some(arrow) = form.next_if(PieceKind::Arrow) {
        let diagnostic = form.error(arrow.span(form.text.file), "a transition has one target only");
        return form.fail(diagnostic.help("write a transition of its own for the next step"));
    }
    match form.rest.first() {
        None => None,
        Some(node) if as_break(node).is_some() => None,
        Some(_) => form.name("the transition's name"),
    }
}

/// Takes everything up to the arrow, and the arrow.
fn before_arrow<'a>(form: &mut Form<'a>) -> Option<&'a [Node]> {
    let rest = form.rest;
    match rest.iter().position(|node| node.is(PieceKind::Arrow)) {
        Some(at) => {
            form.rest = &rest[at + 1..];
            Some(&rest[..at])
        }
        None => {
            let diagnostic = no_arrow(form);
            form.fail(diagnostic)
        }
    }
}

fn no_arrow(form: &Form) -> Diagnostic {
    let nearly =
        form.rest.iter().find(|node| node.is(PieceKind::Other) && !matches!(form.text.of(node), "," | "{" | "}"));
    match (nearly, form.rest) {
        (Some(node), _) => form
            .error(node.span(form.text.file), format!("{} is no arrow", form.text.describe(node)))
            .help("write it `->`"),
        (None, []) => form.missing("everything after its keyword"),
        (None, _) => form.missing("the arrow `->` and a target state"),
    }
}

/// The first node, and those that give the source.
fn split<'a>(form: &mut Form<'a>, before: &'a [Node], what: &str) -> Option<(&'a Node, &'a [Node])> {
    let keyword = form.keyword.name();
    let message = match before {
        [first, rest @ ..] if !rest.is_empty() => return Some((first, rest)),
        [node] if node.is(PieceKind::Block) || is_number(form, node) => {
            format!("`{keyword}` lacks a source state before `->`")
        }
        [node] if node.is(PieceKind::Word) => {
            format!("`{keyword}` lacks {what} or a source state before `->`")
        }
        [_] => format!("`{keyword}` lacks {what} before `{}`", form.text.of(&before[0])),
        _ => format!("`{keyword}` lacks {what} and a source state before `->`"),
    };
    let diagnostic = at_arrow(form, before, message);
    form.fail(diagnostic)
}

fn is_number(form: &Form, node: &Node) -> bool {
    form.keyword == Keyword::Ontime && form.text.of(node).starts_with(|c: char| c.is_ascii_digit())
}

/// An error that points at the arrow, which is the last thing taken.
fn at_arrow(form: &Form, before: &[Node], message: String) -> Diagnostic {
    let arrow = &form.group.nodes[1 + before.len()];
    form.error(arrow.span(form.text.file), message)
}

fn trigger(form: &mut Form, node: &Node) -> Option<Trigger> {
    if node.is(PieceKind::Block) || node.is(PieceKind::UnclosedBlock) {
        return Some(Trigger::Block(form.block_of(node)));
    }
    if !node.is(PieceKind::Word) {
        let diagnostic = form.unexpected(node, "an event or a block");
        return form.fail(diagnostic);
    }
    form.checked(node).map(Trigger::Event)
}

fn timeout(form: &mut Form, node: &Node) -> Option<Timeout> {
    if node.is(PieceKind::Block) || node.is(PieceKind::UnclosedBlock) {
        return Some(Timeout::Block(form.block_of(node)));
    }
    if !node.is(PieceKind::Word) {
        let diagnostic = form.unexpected(node, "a number, a variable or a block");
        return form.fail(diagnostic);
    }
    let word = form.text.of(node);
    if !word.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '.')) {
        return form.lua_checked(node).map(Timeout::Variable);
    }
    let span = node.span(form.text.file);
    match milliseconds(word) {
        Ok(ms) => Some(Timeout::Number { ms, span }),
        Err((message, help)) => form.fail(Diagnostic::error(Code::BadTimeout, span, message).help(help)),
    }
}

/// A number of milliseconds, or what is wrong with it and what to do.
fn milliseconds(word: &str) -> Result<f64, (String, String)> {
    let shown = shortened(word);
    let digits = word.bytes().take_while(u8::is_ascii_digit).count();
    let is_decimal = |word: &str| {
        let (whole, fraction) = word.split_once('.').unwrap_or((word, "0"));
        [whole, fraction].iter().all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()))
    };
    if let Some(positive) = word.strip_prefix('-').filter(|rest| is_decimal(rest)) {
        return Err((format!("a timeout can't be negative: `{shown}`"), format!("write `{}`", shortened(positive))));
    }
    if !is_decimal(word) {
        let unit = word[digits..].to_ascii_lowercase();
        let help = match (unit.as_str(), word[..digits].parse::<u32>()) {
            ("ms", Ok(ms)) => format!("timeouts are in milliseconds already: write `{ms}`"),
            ("s" | "sec", Ok(s)) => format!("timeouts are in milliseconds: write `{}`", u64::from(s) * 1000),
            _ => "write milliseconds in digits, such as `500` or `0.5`".to_string(),
        };
        return Err((format!("`{shown}` is not a number of milliseconds"), help));
    }
    match word.parse::<f64>() {
        Ok(ms) if ms <= MAX_TIMEOUT_MS => Ok(ms),
        _ => Err((
            format!("`{shown}` ms is more than 31 years"),
            "leave the transition out if it is never to happen".to_string(),
        )),
    }
}

fn source(form: &mut Form, nodes: &[Node]) -> Option<Sources> {
    match nodes {
        [node] if node.is(PieceKind::Word) => form.checked(node).map(Sources::One),
        [node] if node.is(PieceKind::Star) => Some(Sources::Any(node.span(form.text.file))),
        [Node::Group(group)] => list(form, group),
        [node] => {
            let diagnostic = form.unexpected(node, "a source state");
            form.fail(diagnostic)
        }
        [] => {
            let taken = form.group.nodes.len() - 2 - form.rest.len();
            let before = &form.group.nodes[1..1 + taken];
            let diagnostic =
                at_arrow(form, before, format!("`{}` lacks a source state before `->`", form.keyword.name()));
            form.fail(diagnostic)
        }
        many => {
            let diagnostic = too_many(form, many);
            form.fail(diagnostic)
        }
    }
}

/// `(a b c)`: any of these.
fn list(form: &mut Form, group: &Group) -> Option<Sources> {
    if group.nodes.is_empty() {
        let span = form.text.span(group.start as usize, group.end as usize);
        let diagnostic =
            form.error(span, "the list of source states is empty").help("name the states, or write `*` for any");
        return form.fail(diagnostic);
    }
    let mut states = Vec::with_capacity(group.nodes.len());
    for node in &group.nodes {
        if !node.is(PieceKind::Word) {
            let diagnostic = form
                .unexpected(node, "a state")
                .help("a list of sources is written `(a b c)`; `*` alone stands for any state");
            return form.fail(diagnostic);
        }
        states.push(form.checked(node)?);
    }
    Some(Sources::Some(states))
}

/// More than one thing where the source should be.
fn too_many(form: &Form, nodes: &[Node]) -> Diagnostic {
    let (first, last) = (&nodes[0], &nodes[nodes.len() - 1]);
    if let Some(odd) = nodes.iter().find(|node| !node.is(PieceKind::Word)) {
        return form.unexpected(odd, "`->`");
    }
    let span = form.text.point(first).to(form.text.point(last));
    let names: Vec<&str> = nodes.iter().map(|node| form.text.of(node)).collect();
    let list = format!("several source states are put in brackets: `({})`", shortened(&names.join(" ")));
    let error = form.error(span, format!("{} names stand where one source state is expected", nodes.len()));
    match (form.keyword, names.as_slice()) {
        (Keyword::Eps, [event, state]) => {
            error.help(format!("for an event write `(on {event} {state} -> ..)`; {list}"))
        }
        (Keyword::Ontime, [unit @ ("ms" | "milliseconds" | "s" | "sec" | "seconds"), _]) => {
            error.help(format!("timeouts are in milliseconds, without a unit: leave `{unit}` out"))
        }

        _ => error.help(list),
    }
}
