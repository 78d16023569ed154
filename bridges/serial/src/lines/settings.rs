//! The settings of a robot that speaks in lines, and what may be wrong with them.

use std::collections::BTreeMap;
use std::time::Duration;

use lrp_bridge::Setting;
use serde_json::Value;

use super::{CallForm, Columns, Fields, Inputs, Template};
use crate::read::{Read, texts};

pub const KEYS: [&str; 9] = ["ready", "fields", "columns", "rename", "inputs", "outputs", "calls", "stop", "eol"];

const TIMEOUT: f64 = 1000.0;
const TIMEOUTS: std::ops::RangeInclusive<f64> = 1.0..=600_000.0;
const READY: std::ops::RangeInclusive<f64> = 0.0..=60_000.0;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    pub ready: Ready,
    pub fields: Fields,
    pub columns: Columns,
    /// The robot's name of a field -> ours.
    pub renamed: BTreeMap<String, String>,
    pub inputs: Inputs,
    pub outputs: BTreeMap<String, Vec<Template>>,
    pub calls: BTreeMap<String, CallForm>,
    pub stop: Vec<String>,
    pub eol: String,
}

/// When the robot listens, once its port is open.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Ready {
    /// When it says anything, or a usual time has gone by.
    #[default]
    FirstLine,
    /// When it says this.
    Line(String),
    After(Duration),
}

impl Ready {
    pub fn is_said(&self, line: &str) -> bool {
        matches!(self, Ready::Line(wanted) if line.starts_with(wanted.as_str()))
    }
}

pub fn described() -> Vec<Setting> {
    let setting = |name, doc, example: &str| Setting::new(name, doc).example(example);
    vec![
        setting(
            "ready",
            "the line that says the robot listens, or the ms it takes; by default its first line, or 2 s",
            "\"ready\"",
        ),
        setting(
            "fields",
            "lines: how a line holds its fields: \"kv\", the default, \"csv\", \"json\" or \"nmea\"",
            "\"csv\"",
        ),
        setting(
            "inputs",
            "lines: each input by example, a value or a table of fields",
            "{ light = 0, pose = { x = 0, y = 0 } }",
        ),
        setting(
            "columns",
            "csv, nmea: the field in each column, \"\" for none; or a table of such lists by first column",
            "{ \"light\", \"pose.x\" }",
        ),
        setting("rename", "lines: the robot's name of a field, and ours", "{ px = \"pose.x\" }"),
        setting(
            "outputs",
            "lines: the line that each output sends, or a list of lines",
            "{ move = \"M {linear.x:.2} {angular.z:.2}\" }",
        ),
        setting(
            "calls",
            "lines: as outputs; or a table of send, reply, error and timeout (ms)",
            "{ tone = { send = \"T {hz}\", reply = \"ok {}\" } }",
        ),
        setting("stop", "what halts the robot. lines: a line, or a list. firmata: a value by pin name", "\"S\""),
        setting("eol", "lines: what ends a line that is sent; \"\\n\" by default", "\"\\r\\n\""),
    ]
}

impl Settings {
    pub fn read(read: &mut Read) -> Settings {
        let inputs = inputs(read);
        let fields = fields(read);
        let settings = Settings {
            ready: ready(read),
            fields,
            columns: columns(read, &inputs),
            renamed: renamed(read, &inputs),
            outputs: outputs(read),
            calls: calls(read),
            stop: stop(read),
            eol: eol(read),
            inputs,
        };
        let has_columns = matches!(fields, Fields::Csv | Fields::Nmea);
        if has_columns && !settings.inputs.is_empty() && settings.columns == Columns::default() {
            read.wrong("fields", "which column is which has to be said", "as `columns = { \"light\", \"bumper\" }`");
        }
        if !has_columns && settings.columns != Columns::default() {
            read.wrong("columns", "only \"csv\" and \"nmea\" have columns", "say `fields = \"csv\"`, or leave it out");
        }
        settings
    }
}

fn ready(read: &mut Read) -> Ready {
    match read.given("ready") {
        None => Ready::FirstLine,
        Some(Value::String(line)) if !line.trim().is_empty() => Ready::Line(line.trim().to_string()),
        Some(Value::Number(number)) if number.as_f64().is_some_and(|ms| READY.contains(&ms)) => {
            Ready::After(Duration::from_secs_f64(number.as_f64().unwrap_or_default() / 1000.0))
        }
        Some(_) => {
            read.wrong("ready", "`ready` is a line, or a time of up to 60000 ms", "as \"ready\", or 500");
            Ready::FirstLine
        }
    }
}

fn fields(read: &mut Read) -> Fields {
    let Some(name) = read.text("fields") else { return Fields::Kv };
    Fields::of_name(name).unwrap_or_else(|| {
        read.wrong("fields", format!("there are no fields `{name}`"), "\"kv\", \"csv\", \"json\" or \"nmea\"");
        Fields::Kv
    })
}

fn inputs(read: &mut Read) -> Inputs {
    let mut inputs = Inputs::default();
    // A list of names: whatever comes.
    if let Some(names) =
        read.given("inputs").and_then(Value::as_array).and_then(|list| texts(&list.clone().into()).map(owned))
    {
        for name in names {
            if read.is_name(&name, "inputs") {
                inputs.add(&name, &Value::Null);
            }
        }
        return inputs;
    }
    for (name, place, example) in read.entries("inputs", "as `{ light = 0, bumper = false }`, or a list of names") {
        if read.is_name(name, &place) {
            inputs.add(name, example);
        }
    }
    inputs
}

fn owned(texts: Vec<&str>) -> Vec<String> {
    texts.into_iter().map(str::to_string).collect()
}

fn columns(read: &mut Read, inputs: &Inputs) -> Columns {
    const HELP: &str = "a list of fields, \"\" for a column that isn't needed";
    match read.given("columns") {
        None => Columns::default(),
        Some(Value::Object(_)) => {
            let mut lists = BTreeMap::new();
            for (tag, place, list) in read.entries("columns", HELP) {
                match texts(list) {
                    Some(names) => lists.insert(tag.to_string(), known(read, &place, &names, inputs)),
                    None => {
                        read.wrong(&place, format!("`{place}` is a list of texts"), HELP);
                        None
                    }
                };
            }
            Columns::Tagged(lists)
        }
        Some(list) => match texts(list) {
            Some(names) => Columns::Same(known(read, "columns", &names, inputs)),
            None => {
                read.wrong("columns", "`columns` is a list of texts", HELP);
                Columns::default()
            }
        },
    }
}

fn renamed(read: &mut Read, inputs: &Inputs) -> BTreeMap<String, String> {
    const HELP: &str = "as `{ px = \"pose.x\" }`";
    let mut all = BTreeMap::new();
    for (theirs, place, ours) in read.entries("rename", HELP) {
        match ours.as_str() {
            Some(ours) => {
                known(read, &place, &[ours], inputs);
                all.insert(theirs.to_string(), ours.to_string());
            }
            None => read.wrong(&place, format!("`{place}` is a text"), HELP),
        }
    }
    all
}

fn known(read: &mut Read, place: &str, names: &[&str], inputs: &Inputs) -> Vec<String> {
    for name in names.iter().filter(|name| !name.is_empty() && inputs.slot(name).is_none()) {
        let help = match inputs.is_empty() {
            true => "name it in `inputs` first, as `inputs = { light = 0 }`".to_string(),
            false => format!("`inputs` has {}", inputs.fields().join(", ")),
        };
        read.wrong(place, format!("no input has a field `{name}`"), &help);
    }
    names.iter().map(|name| (*name).to_string()).collect()
}

fn outputs(read: &mut Read) -> BTreeMap<String, Vec<Template>> {
    let mut all = BTreeMap::new();
    for (name, place, lines) in read.entries("outputs", "as `{ move = \"M {linear.x}\" }`") {
        if read.is_name(name, &place)
            && let Some(lines) = templates(read, &place, lines)
        {
            all.insert(name.to_string(), lines);
        }
    }
    all
}

fn templates(read: &mut Read, place: &str, value: &Value) -> Option<Vec<Template>> {
    let Some(lines) = texts(value).filter(|lines| !lines.is_empty()) else {
        read.wrong(place, format!("`{place}` is a line, or a list of lines"), "as \"M {linear.x}\"");
        return None;
    };
    lines.into_iter().map(|line| template(read, place, line)).collect()
}

fn template(read: &mut Read, place: &str, line: &str) -> Option<Template> {
    let parsed = Template::parse(line);
    if let Err(problem) = &parsed {
        read.wrong(place, format!("`{line}`: {problem}"), "as \"M {linear.x:.2}\"");
    }
    parsed.ok()
}

fn calls(read: &mut Read) -> BTreeMap<String, CallForm> {
    let mut all = BTreeMap::new();
    for (name, place, value) in read.entries("calls", "as `{ tone = \"T {hz}\" }`") {
        if read.is_name(name, &place)
            && let Some(call) = call(read, &place, value)
        {
            all.insert(name.to_string(), call);
        }
    }
    all
}

fn call(read: &mut Read, place: &str, value: &Value) -> Option<CallForm> {
    let mut inner = Read::new(value);
    let send = match value {
        Value::Object(_) => {
            inner.unknown_keys(&["send", "reply", "error", "timeout"], "a call");
            inner.given("send").cloned().unwrap_or_default()
        }
        line => line.clone(),
    };
    let reply = inner.text("reply").map(|line| answer(read, &format!("{place}.reply"), line));
    let error = inner.text("error").map(|line| answer(read, &format!("{place}.error"), line));
    let timeout = inner.number("timeout", TIMEOUTS, "ms").unwrap_or(TIMEOUT);
    for problem in inner.problems {
        let key = problem.key.clone().unwrap_or_default();
        read.problems.push(problem.at(format!("{place}.{key}")));
    }
    let send = templates(read, place, &send)?;
    let arguments = Template::paths(&send);
    if let Some(wrong) = arguments.iter().find(|name| name.is_empty() || name.contains('.')) {
        read.wrong(place, format!("`{{{wrong}}}` can't be an argument"), "an argument has a plain name, as `{hz}`");
    }
    if error.is_some() && reply.is_none() {
        read.wrong(
            place,
            "an `error` is waited for only beside a `reply`",
            "say what the robot answers if all is well",
        );
    }
    let timeout = Duration::from_secs_f64(timeout / 1000.0);
    Some(CallForm { send, arguments, reply: reply.flatten(), error: error.flatten(), timeout })
}

fn answer(read: &mut Read, place: &str, line: &str) -> Option<Template> {
    let template = template(read, place, line)?;
    if !template.is_readable() {
        read.wrong(place, format!("`{line}` has two fields without anything between them"), "as \"ok {a} {b}\"");
        return None;
    }
    Some(template)
}

fn stop(read: &mut Read) -> Vec<String> {
    let Some(value) = read.given("stop") else { return Vec::new() };
    let lines = texts(value).filter(|lines| lines.iter().all(|line| !line.contains(['\n', '\r'])));
    lines.map(owned).unwrap_or_else(|| {
        read.wrong("stop", "`stop` is a line, or a list of lines", "as \"S\"");
        Vec::new()
    })
}

fn eol(read: &mut Read) -> String {
    let eol = read.text("eol").unwrap_or("\n");
    if !matches!(eol, "\n" | "\r" | "\r\n") {
        read.wrong("eol", "`eol` is one of \"\\n\", \"\\r\\n\" and \"\\r\"", "leave it out for \"\\n\"");
    }
    eol.to_string()
}
