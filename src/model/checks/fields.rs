//! Fields that are not there: of Lua's libraries, of robots, of their messages.

use lrp_bridge::{Function, Port, Scope};
use serde_json::Value;

use crate::lua::{Checker, FieldKind, FieldUse};
use crate::model::Description;
use crate::model::blocks::{Role, place};
use crate::model::program::*;
use crate::model::suggestion::{listed, suggestion};
use crate::syntax::nearest::nearest;
use crate::syntax::{Code, Diagnostic};

/// Misspelt fields of what every block has at hand and of bridges whose offer is known.
pub fn unknown_field(program: &Program, offered: &[Option<Description>], checker: &Checker) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for block in &program.blocks {
        let mut seen: Vec<&FieldUse> = Vec::new();
        for used in &block.facts.fields {
            let same =
                |other: &&FieldUse| (&other.name, &other.fields, other.kind) == (&used.name, &used.fields, used.kind);
            // A variable may have the name of something built in.
            if seen.iter().any(same) || block.reads.iter().any(|&var| *program[var].name == *used.name) {
                continue;
            }
            seen.push(used);
            let bridge = program.bridges.iter().position(|bridge| *bridge.name == *used.name);
            let wrong = match bridge {
                Some(bridge) => {
                    let known = offered.get(bridge).and_then(Option::as_ref).filter(|it| it.scope == Scope::Closed);
                    known.and_then(|offer| robot(used, offer))
                }
                None => library(used, checker.fields(&used.name)),
            };
            found.extend(wrong.map(|wrong| at(program, block, used, wrong)));
        }
    }
    found
}

struct Wrong {
    message: String,
    help: String,
}

fn at(program: &Program, block: &Block, used: &FieldUse, Wrong { message, help }: Wrong) -> Diagnostic {
    let role = if used.kind == FieldKind::Given { Role::Any } else { Role::Field };
    let name = used.fields.last().map(|field| (field.as_str(), role));
    let span = place(program.source(block.span), block.span, used.line, name);
    Diagnostic::error(Code::UnknownField, span, message).help(help)
}

/// Functions that Lua has, and that would reach out of the program.
const OUTSIDE: &[&str] = &["difftime", "execute", "exit", "getenv", "remove", "rename", "setlocale", "tmpname"];

fn library(used: &FieldUse, known: &[&str]) -> Option<Wrong> {
    let (name, [field]) = (&used.name, used.fields.as_slice()) else { return None };
    let right = used.kind != FieldKind::Write && known.contains(&field.as_str());
    if known.is_empty() || right || used.kind == FieldKind::Given {
        return None;
    }
    if used.kind == FieldKind::Write {
        let message = format!("`{name}.{field}` can't be assigned: libraries stay as they are");
        return Some(Wrong { message, help: "declare a variable for it".to_string() });
    }
    let outside = name == "os" && OUTSIDE.contains(&field.as_str());
    let help = match outside {
        true => "blocks can't reach files and processes; `--allow-system` lets them use all of `os`".to_string(),
        false => suggestion(field, known),
    };
    Some(Wrong { message: format!("`{name}` has no field `{field}`"), help })
}

fn robot(used: &FieldUse, offer: &Description) -> Option<Wrong> {
    let (port, inner) = used.fields.split_first()?;
    match used.kind {
        FieldKind::Read if inner.is_empty() => unknown_port(used, port, offer),
        FieldKind::Read => match functions(offer, port) {
            Some(functions) => no_function(used, port, &inner[0], functions),
            None => missing(used, &offer.input(port)?.message, inner),
        },
        FieldKind::Given => missing(used, sent(offer, port)?, inner),
        FieldKind::Method => match (inner, functions(offer, port)) {
            ([], _) => no_method(used, port, offer),
            ([function], Some(functions)) => no_function(used, port, function, functions),
            _ => None,
        },
        FieldKind::Write if offer.output(port).is_some() && inner.is_empty() => Some(Wrong {
            message: format!("`{}.{port}` is an output and can't be assigned", used.name),
            help: format!("call it to send: `{}.{port}{{ .. }}`", used.name),
        }),
        FieldKind::Write => unknown_port(used, port, offer),
    }
}

/// What a device can do.
fn functions<'o>(offer: &'o Description, device: &str) -> Option<&'o [Function]> {
    offer.devices.iter().find(|known| known.name == device).map(|device| device.functions.as_slice())
}

/// The message of an output, or the one that a call takes.
fn sent<'o>(offer: &'o Description, port: &str) -> Option<&'o Value> {
    let message = |call: &'o Function| call.arguments.first().map(|argument| &argument.message);
    offer.output(port).map(|port| &port.message).or_else(|| offer.function(port).and_then(message))
}

fn no_function(used: &FieldUse, device: &str, wanted: &str, functions: &[Function]) -> Option<Wrong> {
    let known: Vec<&str> = functions.iter().map(|function| function.name.as_str()).collect();
    if known.contains(&wanted) {
        return None;
    }
    let there = format!("it has: {}", listed(&known));
    let help = match nearest(wanted, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? {there}"),
        None => there,
    };
    Some(Wrong { message: format!("`{}.{device}` has no function `{wanted}`", used.name), help })
}

fn names(ports: &[Port]) -> Vec<&str> {
    ports.iter().map(|port| port.name.as_str()).collect()
}

fn unknown_port(used: &FieldUse, port: &str, offer: &Description) -> Option<Wrong> {
    let ports = offer.inputs.iter().chain(&offer.outputs).map(|port| port.name.as_str());
    let calls: Vec<&str> = offer.calls.iter().map(|call| call.name.as_str()).collect();
    let devices: Vec<&str> = offer.devices.iter().map(|device| device.name.as_str()).collect();
    let known = ports.chain(calls.iter().copied()).chain(devices.iter().copied()).chain(["age"]);
    if known.clone().any(|name| name == port) {
        return None;
    }
    let lists = [
        ("inputs", names(&offer.inputs)),
        ("outputs", names(&offer.outputs)),
        ("calls", calls.clone()),
        ("devices", devices.clone()),
    ];
    let lists = lists.iter().filter(|(title, list)| !list.is_empty() || matches!(*title, "inputs" | "outputs"));
    let there: Vec<String> = lists.map(|(title, list)| format!("{title}: {}", listed(list))).collect();
    let there = there.join("; ");
    let help = match nearest(port, known) {
        Some(near) => format!("did you mean `{near}`? {there}"),
        None => there,
    };
    Some(Wrong { message: format!("`{}` has no input or output `{port}`", used.name), help })
}

fn no_method(used: &FieldUse, method: &str, offer: &Description) -> Option<Wrong> {
    let name = &used.name;
    let help = match () {
        () if method == "age" => return None,
        () if offer.output(method).is_some() => format!("send with a dot: `{name}.{method}{{ .. }}`"),
        () if offer.calls.iter().any(|call| call.name == method) => {
            format!("call it with a dot: `{name}.{method}(..)`")
        }
        () if offer.input(method).is_some() => format!("read with a dot: `{name}.{method}`"),
        () => format!("there is `{name}:age(\"INPUT\")`; what it offers is written with a dot"),
    };
    Some(Wrong { message: format!("`{name}` has no method `{method}`"), help })
}

/// The last of the fields, where the message around it has others.
fn missing(used: &FieldUse, message: &Value, fields: &[String]) -> Option<Wrong> {
    let (last, before) = fields.split_last()?;
    let around = before.iter().try_fold(message, |around, field| around.get(field))?.as_object()?;
    if around.is_empty() || around.contains_key(last) {
        return None;
    }
    let known: Vec<&str> = around.keys().map(String::as_str).collect();
    let help = match nearest(last, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? it has: {}", listed(&known)),
        None => format!("it has: {}", listed(&known)),
    };
    let path = used.fields[..used.fields.len() - 1].join(".");
    Some(Wrong { message: format!("`{}.{path}` has no field `{last}`", used.name), help })
}
