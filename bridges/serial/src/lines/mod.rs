//! A robot that speaks in lines of text. What its lines hold becomes inputs; outputs and calls are templates of lines.

mod calls;
mod fields;
mod framer;
mod nmea;
mod settings;
mod shape;
mod template;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lrp_bridge::{Argument, Call, Description, Found, Function, Level, Port};
use serde_json::Value;

pub use calls::{CallForm, Calls};
pub use fields::{Field, Fields};
pub use framer::{Framer, Piece};
pub use settings::{KEYS, Ready, Settings, described};
pub use shape::{Columns, Inputs};
pub use template::Template;

use crate::codec::{Begun, Codec, Heard};
use crate::settings::Protocol;

/// How long a robot may take to begin where nothing says otherwise: an Arduino begins anew when its port is opened.
const BOOT: Duration = Duration::from_secs(2);
/// How long a line that says it is ready is waited for.
const READY: Duration = Duration::from_secs(10);
/// Fields that no input takes, of which no more are told.
const FIELDS: usize = 64;
const NO_STOP: &str = "the form has no `stop`: nothing halts this robot when the program stops";
/// What a person needs to see of a line.
const SHOWN: usize = 60;

pub struct Lines {
    settings: Settings,
    framer: Framer,
    calls: Calls,
    /// The last message of each input.
    messages: Vec<Value>,
    opened: Instant,
    is_ready: bool,
    /// Fields that no input takes.
    unused: BTreeMap<String, Found>,
}

impl Lines {
    pub fn new(settings: Settings) -> Lines {
        Lines {
            messages: settings.inputs.messages(),
            settings,
            framer: Framer::default(),
            calls: Calls::default(),
            opened: Instant::now(),
            is_ready: false,
            unused: BTreeMap::new(),
        }
    }

    fn line(&mut self, line: &str, heard: &mut Vec<Heard>) {
        if self.settings.ready.is_said(line) {
            self.ready(heard);
        } else if !self.is_ready {
            // What is said before belongs to nobody, and may be the rest of a line.
            if self.settings.ready == Ready::FirstLine {
                self.ready(heard);
            }
        } else if let Some(comment) = line.strip_prefix('#') {
            heard.push(Heard::Log(Level::Info, comment.trim().to_string()));
        } else if let Some((id, result)) = self.calls.answer(line) {
            heard.push(Heard::Reply(id, result));
        } else {
            self.fields(line, heard);
        }
    }

    fn fields(&mut self, line: &str, heard: &mut Vec<Heard>) {
        let fields = match self.settings.fields.read(line, &self.settings.columns) {
            Ok(fields) => fields,
            Err(why) => {
                heard.push(Heard::Unreadable(format!("`{}` can't be read: {why}", shown(line))));
                return;
            }
        };
        let mut touched = Vec::new();
        for (name, field) in fields {
            let name = self.settings.renamed.get(&name).cloned().unwrap_or(name);
            self.field(&name, field, line, &mut touched, heard);
        }
        for input in touched {
            heard.push(Heard::Input(self.settings.inputs.name(input).to_string(), self.messages[input].clone()));
        }
    }

    fn field(&mut self, name: &str, field: Field, line: &str, touched: &mut Vec<usize>, heard: &mut Vec<Heard>) {
        let Some(slot) = self.settings.inputs.slot(name) else {
            if let Field::Json(Value::Object(table)) = field {
                for (key, value) in table {
                    self.field(&format!("{name}.{key}"), Field::Json(value), line, touched, heard);
                }
            } else {
                self.unused(name, &field, heard);
            }
            return;
        };
        match slot.fit(field) {
            Ok(value) => {
                slot.set(&mut self.messages[slot.input], value);
                if !touched.contains(&slot.input) {
                    touched.push(slot.input);
                }
            }
            Err(wanted) => {
                heard.push(Heard::Unreadable(format!("`{name}` in `{}` should be {wanted}", shown(line))));
            }
        }
    }

    fn unused(&mut self, name: &str, field: &Field, heard: &mut Vec<Heard>) {
        if self.unused.len() >= FIELDS || self.unused.contains_key(name) {
            return;
        }
        let found = Found {
            name: name.to_string(),
            what: "field".into(),
            type_name: field.type_name().into(),
            doc: "comes in, and no input takes it".into(),
            setting: field.example().map(|example| format!("inputs.{name} = {example}")),
        };
        self.unused.insert(name.to_string(), found);
        heard.push(Heard::Fields(self.unused.values().cloned().collect()));
    }
}

impl Codec for Lines {
    fn offer(&self) -> Description {
        self.settings.offer()
    }

    fn open(&mut self, now: Instant) -> Vec<u8> {
        self.framer = Framer::default();
        self.messages = self.settings.inputs.messages();
        self.opened = now;
        self.is_ready = false;
        Vec::new()
    }

    fn hear(&mut self, bytes: &[u8], _: Instant) -> Vec<Heard> {
        let mut heard = Vec::new();
        for piece in self.framer.take(bytes) {
            match piece {
                Piece::Line(line) => self.line(&line, &mut heard),
                // Noise while a board begins is nothing to talk about.
                Piece::Garbage(_) if !self.is_ready => {}
                Piece::Garbage(what) => heard.push(Heard::Unreadable(what)),
            }
        }
        heard
    }

    fn tick(&mut self, now: Instant) -> Vec<Heard> {
        let late = self.calls.late(now);
        let mut heard: Vec<Heard> = late.into_iter().map(|(id, why)| Heard::Reply(id, Err(why))).collect();
        let waited = now.duration_since(self.opened);
        match &self.settings.ready {
            _ if self.is_ready => {}
            Ready::Line(line) if waited >= READY => {
                let why =
                    format!("the robot hasn't said `{line}` in {} s: is `ready` or `baud` wrong?", READY.as_secs());
                heard.push(Heard::Lost(why));
            }
            Ready::After(time) if waited >= *time => self.ready_unsaid(&mut heard),
            Ready::FirstLine if waited >= BOOT => self.ready_unsaid(&mut heard),
            _ => {}
        }
        heard
    }

    fn send(&mut self, output: &str, message: &Value) -> Result<Vec<u8>, String> {
        let form = self.settings.outputs.get(output).ok_or_else(|| format!("there is no output `{output}`"))?;
        self.settings.render(form, message)
    }

    fn call(&mut self, call: &Call, now: Instant) -> Result<Begun, String> {
        let form = self.settings.calls.get(&call.call).ok_or_else(|| format!("there is no call `{}`", call.call))?;
        let bytes = self.settings.render(&form.send, &form.message(&call.arguments))?;
        let waits = self.calls.begin(call.id, form, now);
        Ok(Begun { bytes, waits })
    }

    fn cancel(&mut self, id: u64) {
        self.calls.cancel(id);
    }

    fn forget_calls(&mut self) -> Vec<u64> {
        self.calls.forget()
    }

    fn stop(&mut self) -> Vec<u8> {
        self.settings.lines(&self.settings.stop)
    }

    fn end_of_message(&self) -> Vec<u8> {
        self.settings.eol.clone().into_bytes()
    }

    fn adopt(&mut self, protocol: &Protocol) -> Option<Vec<u8>> {
        let Protocol::Lines(settings) = protocol else { return None };
        if settings.inputs != self.settings.inputs {
            self.messages = settings.inputs.messages();
            self.unused.clear();
        }
        self.settings = settings.clone();
        Some(Vec::new())
    }
}

impl Lines {
    /// Where no line was heard, what came of one may lack its beginning.
    fn ready_unsaid(&mut self, heard: &mut Vec<Heard>) {
        self.framer.forget_first();
        self.ready(heard);
    }

    fn ready(&mut self, heard: &mut Vec<Heard>) {
        self.is_ready = true;
        let moves = !self.settings.outputs.is_empty() || !self.settings.calls.is_empty();
        if moves && self.settings.stop.is_empty() {
            heard.push(Heard::Log(Level::Warn, NO_STOP.into()));
        }
        heard.push(Heard::Ready);
    }
}

impl Settings {
    fn offer(&self) -> Description {
        let outputs = self.outputs.iter().map(|(name, lines)| {
            let doc = lines.iter().map(Template::source).collect::<Vec<_>>().join(", then ");
            Port::new(name, Template::message(lines), format!("sends {doc}"))
        });
        let calls = self.calls.iter().map(|(name, form)| {
            let arguments = form.arguments.iter().map(Argument::new).collect();
            Function::new(name, arguments, form.doc())
        });
        Description {
            inputs: self.inputs.ports(),
            outputs: outputs.collect(),
            calls: calls.collect(),
            ..Description::default()
        }
    }

    fn render(&self, lines: &[Template], message: &Value) -> Result<Vec<u8>, String> {
        let lines: Result<Vec<String>, String> = lines.iter().map(|line| line.render(message)).collect();
        Ok(self.lines(&lines?))
    }

    fn lines(&self, lines: &[String]) -> Vec<u8> {
        lines.iter().flat_map(|line| [line.as_str(), &self.eol]).collect::<String>().into_bytes()
    }
}

fn shown(line: &str) -> String {
    match line.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}..", &line[..end]),
        None => line.to_string(),
    }
}
