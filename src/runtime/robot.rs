//! Robots as blocks see them: inputs as fields, outputs and calls as functions, devices as objects. What they say goes in
//! before a step, what they are told comes out after it. Knows nothing of bridges.

use std::collections::HashSet;
use std::sync::Arc;

use lrp_bridge::{Argument, Function as Offered, Port, Scope};
use mlua::{Function, IntoLua, Table};
use serde_json::{Map, Value};

use super::engine::{Input, Reply};
use super::message::{from_lua, to_lua};
use super::record::What;
use super::time::Time;
use crate::lua::{Lua, device_mark};
use crate::model::Description;
use crate::syntax::nearest::nearest;

const OBJECT: &str = include_str!("robot.lua");

#[derive(Default)]
pub(super) struct Robots {
    robots: Vec<Robot>,
    /// Inputs of which it has been said that no message came yet.
    said: HashSet<NoMessage>,
}

struct Robot {
    name: Arc<str>,
    receive: Function,
    answer: Function,
    take: Function,
    missed: Function,
    offer: Function,
}

/// A block needed a message that hasn't come.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct NoMessage {
    pub bridge: Arc<str>,
    pub input: String,
    /// `has had no message yet`
    pub why: String,
}

impl Robots {
    pub fn describe(&mut self, lua: &mut Lua, name: &str, description: &Description, stale: Option<Time>) {
        let offer = offer(lua.mlua(), description, stale).expect("plain data becomes a Lua table");
        if let Some(robot) = self.robots.iter().find(|robot| &*robot.name == name) {
            robot.offer.call::<()>(offer).expect("replacing a table can't fail");
            return;
        }
        let mut made = None;
        lua.global(name, |lua| {
            let (object, engine) = make(lua, name, offer)?;
            made = Some(engine);
            Ok(mlua::Value::Table(object))
        })
        .expect("a name can be added");
        let engine = made.expect("the maker was called");
        let function = |key: &str| engine.get::<Function>(key).expect("robot.lua gives its functions");
        self.robots.push(Robot {
            name: name.into(),
            receive: function("receive"),
            answer: function("answer"),
            take: function("take"),
            missed: function("missed"),
            offer: function("offer"),
        });
    }

    pub fn is_empty(&self) -> bool {
        self.robots.is_empty()
    }

    pub fn receive(&self, lua: &Lua, input: &Input, now: Time) {
        let Some(robot) = self.robots.iter().find(|robot| robot.name == input.bridge) else { return };
        if let Ok(message) = to_lua(lua.mlua(), &input.value) {
            // Only a lack of memory can make this fail: the message is lost then, as on any full queue.
            let _ = robot.receive.call::<()>((&*input.name, message, now.ms()));
        }
    }

    /// How far a call has come, or how it ended.
    pub fn answer(&self, lua: &Lua, reply: &Reply) {
        let Some(robot) = self.robots.iter().find(|robot| robot.name == reply.bridge) else { return };
        if let Ok(value) = to_lua(lua.mlua(), &reply.value) {
            // Only a lack of memory can make this fail: the call seems to go on then.
            let _ = robot.answer.call::<()>((reply.id, reply.done, value, reply.error.as_deref()));
        }
    }

    /// What was sent since the last call, in order: outputs, calls, and calls that are no longer wanted.
    pub fn take_sent(&self) -> Vec<What> {
        let mut all = Vec::new();
        for robot in &self.robots {
            let Ok(Some(sent)) = robot.take.call::<Option<Vec<Table>>>(()) else { continue };
            all.extend(sent.iter().filter_map(|item| sent_item(&robot.name, item)));
        }
        all
    }

    /// Whether a block failed because it indexed an input that has had no message.
    pub fn no_message(&self, message: &str) -> Option<NoMessage> {
        if !message.contains("attempt to index a nil value") {
            return None;
        }
        for robot in &self.robots {
            let Ok((Some(input), Some(why))) = robot.missed.call::<(Option<String>, Option<String>)>(()) else {
                continue;
            };
            if message.contains(&format!("'{input}'")) {
                return Some(NoMessage { bridge: robot.name.clone(), input, why });
            }
        }
        None
    }

    /// Whether it is still to be said that an input has no message.
    pub fn is_news(&mut self, missing: &NoMessage) -> bool {
        self.said.insert(missing.clone())
    }
}

fn sent_item(bridge: &Arc<str>, item: &Table) -> Option<What> {
    let bridge = Arc::clone(bridge);
    if let Ok(id) = item.get::<u64>("cancelled") {
        return Some(What::Cancel { bridge, id });
    }
    let name: Arc<str> = item.get::<String>(1).ok()?.into();
    let value: mlua::Value = item.get(2).ok()?;
    match (item.get::<Option<u64>>(3).ok()?, value) {
        (None, message) => Some(What::Output { bridge, name, value: from_lua(&message).unwrap_or_default() }),
        (Some(id), mlua::Value::Table(arguments)) => {
            let count: usize = item.get("n").ok()?;
            let argument = |index| from_lua(&arguments.raw_get(index).ok()?);
            let arguments = (1..=count).map(|index| argument(index).unwrap_or_default()).collect();
            Some(What::Call { bridge, name, id, arguments: Value::Array(arguments) })
        }
        (Some(_), _) => None,
    }
}

fn make(lua: &mlua::Lua, name: &str, offer: Table) -> mlua::Result<(Table, Table)> {
    let now: Function = lua.globals().get("now")?;
    let near = lua.create_function(|_, (wanted, lists): (mlua::Value, Vec<Table>)| {
        let mut known = Vec::new();
        for list in lists {
            for pair in list.pairs::<String, mlua::Value>() {
                known.push(pair?.0);
            }
        }
        let wanted = wanted.to_string()?;
        Ok(nearest(&wanted, known.iter().map(String::as_str)).map(str::to_string))
    })?;
    let mark = mlua::LightUserData(device_mark().cast_mut());
    lua.load(OBJECT).set_name("=robot").call((name, offer, now, near, mark))
}

/// What a robot offers, as robot.lua reads it.
fn offer(lua: &mlua::Lua, description: &Description, stale: Option<Time>) -> mlua::Result<Table> {
    let offer = lua.create_table()?;
    offer.set("inputs", messages(lua, &description.inputs)?)?;
    offer.set("outputs", messages(lua, &description.outputs)?)?;
    let calls = lua.create_table()?;
    for call in &description.calls {
        calls.set(call.name.as_str(), arguments(lua, &call.arguments)?)?;
    }
    offer.set("calls", calls)?;
    let devices = lua.create_table()?;
    for device in &description.devices {
        devices.set(device.name.as_str(), functions(lua, &device.functions)?)?;
    }
    offer.set("devices", devices)?;
    offer.set("open", description.scope == Scope::Open)?;
    offer.set("stale", stale.map(Time::ms))?;
    Ok(offer)
}

fn messages(lua: &mlua::Lua, ports: &[Port]) -> mlua::Result<Table> {
    let messages = lua.create_table()?;
    for port in ports {
        messages.set(port.name.as_str(), shape(lua, &port.message)?)?;
    }
    Ok(messages)
}

fn functions(lua: &mlua::Lua, offered: &[Offered]) -> mlua::Result<Table> {
    let functions = lua.create_table()?;
    for function in offered {
        let entry = lua.create_table()?;
        entry.set("reads", function.reads.as_deref())?;
        entry.set("arguments", arguments(lua, &function.arguments)?)?;
        functions.set(function.name.as_str(), entry)?;
    }
    Ok(functions)
}

fn arguments(lua: &mlua::Lua, wanted: &[Argument]) -> mlua::Result<Table> {
    let arguments = lua.create_table()?;
    for argument in wanted {
        let entry = lua.create_table()?;
        entry.set("name", argument.name.as_str())?;
        entry.set("optional", argument.default.is_some())?;
        entry.set("default", argument.default.as_ref().map(|value| to_lua(lua, value)).transpose()?)?;
        if !argument.message.is_null() {
            entry.set("message", shape(lua, &argument.message)?)?;
        }
        arguments.push(entry)?;
    }
    Ok(arguments)
}

/// A message's defaults. What takes anything is there, but as nothing that a default could be.
fn shape(lua: &mlua::Lua, message: &Value) -> mlua::Result<mlua::Value> {
    let table = |fields: &Map<String, Value>| {
        let table = lua.create_table()?;
        for (field, value) in fields {
            table.raw_set(field.as_str(), shape(lua, value)?)?;
        }
        table.into_lua(lua)
    };
    match message {
        Value::Null => Ok(mlua::Value::NULL),
        Value::Object(fields) if !fields.contains_key("lua") => table(fields),
        value => to_lua(lua, value),
    }
}
