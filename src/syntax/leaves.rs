//! The forms that hold no other form, each as it is written: one function for each. Knows nothing of what stands around them.

use std::sync::Arc;

use super::ast::{Block, Bridge, Event, Export, Import, Name, Spawn, Var};
use super::diagnostic::{Code, Diagnostic};
use super::form::Form;
use super::keyword::Keyword;
use super::names::shortened;
use super::pieces::PieceKind;
use super::reader::Node;
use super::source::Span;

pub fn bridge(form: &mut Form) -> Option<Bridge> {
    let name = form.lua_name("the bridge's name")?;
    let kind = form.name("the kind of robot")?;
    let config = if form.rest.is_empty() { None } else { Some(form.block("the configuration")?) };
    form.finish();
    Some(Bridge { span: form.span(), name, kind, config })
}

pub fn import(form: &mut Form) -> Option<Import> {
    let Some(node) = form.next_if(PieceKind::Text) else {
        let diagnostic = match form.rest {
            [] => form.missing("a file's name in quotes"),
            [node, ..] => no_quotes(form, node),
        };
        return form.fail(diagnostic);
    };
    let range = node.range();
    let inside = range.start + 1..range.end - 1;
    let text = &form.text.text[inside.clone()];
    if text.trim().is_empty() {
        let diagnostic = form.error(node.span(form.text.file), "the file's name is empty");
        return form.fail(diagnostic);
    }
    let file = Name { text: Arc::from(text), span: form.text.span(inside.start, inside.end) };
    form.finish();
    Some(Import { span: form.span(), file })
}

fn no_quotes(form: &Form, node: &Node) -> Diagnostic {
    let error = form.unexpected(node, "a file's name in quotes");
    if node.is(PieceKind::Word) {
        return error.help(format!("write `(import \"{}\")`", shortened(form.text.of(node))));
    }
    error.help("a file's name is written in quotes of one kind: `\"file.lrp\"` or `'file.lrp'`")
}

pub fn export(form: &mut Form) -> Option<Export> {
    let machine = form.name("the name of a machine")?;
    form.finish();
    Some(Export { span: form.span(), machine })
}

pub fn var(form: &mut Form) -> Option<Var> {
    let name = form.lua_name("the variable's name")?;
    let init = if form.next_if(PieceKind::Assign).is_some() {
        form.block("the initial value")
    } else {
        let diagnostic = no_assignment(form, &name);
        form.fail(diagnostic)
    };
    if init.is_some() {
        form.finish();
    }
    Some(Var { span: form.span(), init: init.unwrap_or_else(|| form.empty_block()), name })
}

/// What to say of `(var x [5])`, `(var x = [5])`, `(var x)`.
fn no_assignment(form: &Form, name: &Name) -> Diagnostic {
    let message = format!("the variable `{}` lacks its initial value", name.text);
    let example = format!("write `(var {} := [0])`", name.text);
    match form.rest {
        [] => Diagnostic { message, ..form.missing("") }.help(example),
        [node, ..] if node.is(PieceKind::Block) => {
            form.error(node.span(form.text.file), format!("`:=` is missing between `{}` and its value", name.text))
        }
        [node, ..] if assigns_otherwise(form, node) => form.error(
            node.span(form.text.file),
            format!("an initial value is given with `:=`, not `{}`", form.text.of(node)),
        ),
        [node] if node.is(PieceKind::Word) || node.is(PieceKind::Text) => {
            let value = shortened(form.text.of(node));
            form.unexpected(node, "`:=`").help(format!("write `(var {} := [{value}])`", name.text))
        }
        [node, ..] => form.unexpected(node, "`:=`"),
    }
}

fn assigns_otherwise(form: &Form, node: &Node) -> bool {
    node.is(PieceKind::Other) && matches!(form.text.of(node), "=" | ":")
}

pub fn event(form: &mut Form) -> Option<Event> {
    let name = form.name("the event's name")?;
    let block = match form.rest {
        [node, ..] if assigns_otherwise(form, node) => {
            let diagnostic = form
                .error(node.span(form.text.file), format!("`{}` is not needed here", form.text.of(node)))
                .help(format!("write `(event {} [condition])`", name.text));
            form.fail(diagnostic)
        }
        _ => {
            form.next_if(PieceKind::Assign);
            form.block("the condition")
        }
    };
    if block.is_some() {
        form.finish();
    }
    Some(Event { span: form.span(), block: block.unwrap_or_else(|| form.empty_block()), name })
}

pub fn spawn(form: &mut Form) -> Option<Spawn> {
    let machine = form.name("the name of a machine")?;
    let state = form.name("the state to start in")?;
    form.finish();
    Some(Spawn { span: form.span(), machine, state })
}

/// `(running [b])`, `(onexit [b])`, `(onpause [b])`, `(onresume [b])`
pub fn action(form: &mut Form) -> Option<Block> {
    let block = form.block("the action")?;
    one_action(form);
    Some(block)
}

/// `(break)`: its place.
pub fn breakpoint(form: &mut Form) -> Option<Span> {
    if let Some(node) = form.rest.first().filter(|node| node.is(PieceKind::Block)) {
        let message = "a `break` takes no condition: it pauses whenever it is reached";
        let error = form.error(node.span(form.text.file), message);
        return form.fail(error.help("write `(break)`; to pause on a condition, set it from the screen or in a test"));
    }
    form.finish();
    Some(form.span())
}

/// A second block in a form that takes one.
pub fn one_action(form: &mut Form) {
    if let [node, ..] = form.rest
        && node.is(PieceKind::Block)
    {
        let keyword = form.keyword.name();
        let help = match form.keyword {
            Keyword::Onpause | Keyword::Onresume => "put both in one block".to_string(),
            _ => {
                format!("write another `({keyword} [..])` after this one, or put both in one block")
            }
        };
        let message = format!("`{keyword}` takes one block");
        let diagnostic = Diagnostic::error(Code::BadForm, form.text.point(node), message).help(help);
        form.fail::<()>(diagnostic);
    }
    form.finish();
}
