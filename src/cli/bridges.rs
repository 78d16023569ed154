//! `lrp bridges`: which kinds of robots there are, where they lie, and what one offers.

use std::process::ExitCode;

use lrp_bridge::{About, Argument, Description, Function, Port};
use serde_json::json;

use super::output::{fail, finish};
use crate::session::plugins::{Answer, Plugin, Plugins};
use crate::session::robots::{BUILT_IN, about_built_in};
use crate::syntax::nearest::nearest;

pub fn list(kind: Option<&str>, plugins: &Plugins) -> ExitCode {
    match kind {
        Some(kind) => one(kind, plugins),
        None => all(plugins),
    }
}

fn all(plugins: &Plugins) -> ExitCode {
    let mut text = String::new();
    for (about, _) in BUILT_IN.iter().filter_map(|kind| about_built_in(kind)) {
        text += &row(&about.kind, &about.version, &about.summary, "built in");
    }
    for plugin in plugins.folders.all() {
        let place = plugin.path.display().to_string();
        text += &match plugins.ask(&plugin.kind, &json!({})) {
            Some(Ok(Answer { about, .. })) => row(&plugin.kind, &about.version, &about.summary, &place),
            Some(Err(why)) => row(&plugin.kind, "-", &format!("can't be used: {why}"), &place),
            None => continue,
        };
    }
    text += "\nlooked for in\n";
    for folder in plugins.folders.paths() {
        let there = if folder.is_dir() { "" } else { "  (no such folder)" };
        text += &format!("  {}{there}\n", folder.display());
    }
    finish(&text, ExitCode::SUCCESS)
}

fn row(kind: &str, version: &str, summary: &str, place: &str) -> String {
    format!("{kind:10} {version:8} {summary}\n{:20}{place}\n", "")
}

fn one(kind: &str, plugins: &Plugins) -> ExitCode {
    if let Some((about, description)) = about_built_in(kind) {
        return finish(&told(&about, &description, None), ExitCode::SUCCESS);
    }
    let Some(plugin) = plugins.folders.find(kind) else { return unknown(kind, plugins) };
    match plugins.ask(kind, &json!({})) {
        Some(Ok(Answer { about, description, .. })) => {
            finish(&told(&about, &description, Some(&plugin)), ExitCode::SUCCESS)
        }
        Some(Err(why)) => fail(format_args!("{} can't be used: {why}", plugin.path.display())),
        None => unknown(kind, plugins),
    }
}

fn unknown(kind: &str, plugins: &Plugins) -> ExitCode {
    let found = plugins.folders.all();
    let known: Vec<&str> = BUILT_IN.iter().copied().chain(found.iter().map(|plugin| &*plugin.kind)).collect();
    let help = match nearest(kind, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there is: {}; `lrp bridges` tells where bridges are looked for", known.join(", ")),
    };
    fail(format_args!("there is no bridge of kind `{kind}`; {help}"))
}

fn told(about: &About, description: &Description, plugin: Option<&Plugin>) -> String {
    let place = plugin.map_or("built in".to_string(), |plugin| plugin.path.display().to_string());
    let mut text = format!("{} {}: {}\n{place}\n", about.kind, about.version, about.summary);
    if !about.settings.is_empty() {
        text += &format!("\nsettings: (bridge NAME {} [ .. ])\n", about.kind);
        for setting in &about.settings {
            text += &entry(&setting.name, &setting.doc);
            text +=
                &setting.example.as_ref().map_or(String::new(), |it| entry("", &format!("{} = {it}", setting.name)));
        }
    }
    text += &ports("inputs", &description.inputs);
    text += &ports("outputs", &description.outputs);
    text += &functions("calls", ".", &description.calls);
    for device in &description.devices {
        text += &functions(&format!("device {}: {}", device.name, device.doc), ":", &device.functions);
    }
    text
}

fn entry(name: &str, doc: &str) -> String {
    format!("  {name:16} {doc}\n")
}

fn ports(title: &str, ports: &[Port]) -> String {
    if ports.is_empty() {
        return String::new();
    }
    let port = |port: &Port| {
        let of_type = if port.type_name.is_empty() { String::new() } else { format!("{}  ", port.type_name) };
        let message = if port.message.is_null() { "any message".to_string() } else { port.message.to_string() };
        entry(&port.name, &port.doc) + &entry("", &format!("{of_type}{message}"))
    };
    format!("\n{title}\n{}", ports.iter().map(port).collect::<String>())
}

fn functions(title: &str, mark: &str, functions: &[Function]) -> String {
    if functions.is_empty() {
        return String::new();
    }
    let argument = |argument: &Argument| match &argument.default {
        Some(default) => format!("{} = {default}", argument.name),
        None => argument.name.clone(),
    };
    let function = |function: &Function| {
        let arguments: Vec<String> = function.arguments.iter().map(argument).collect();
        entry(&format!("{mark}{}({})", function.name, arguments.join(", ")), &function.doc)
    };
    format!("\n{title}\n{}", functions.iter().map(function).collect::<String>())
}
