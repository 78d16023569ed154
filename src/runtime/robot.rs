//! Robots as blocks see them: inputs as fields, outputs as functions. What they say goes in before a step, what they are
//! told comes out after it. Knows nothing of bridges.

use std::collections::HashSet;
use std::sync::Arc;

use mlua::serde::{LuaSerdeExt, SerializeOptions};
use mlua::{Function, Table};
use serde_json::{Value, json};

use super::engine::Input;
use super::time::Time;
use crate::lua::Lua;
use crate::model::Description;
use crate::model::description::Scope;
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
        let offer = json!({
            "inputs": messages(&description.inputs),
            "outputs": messages(&description.outputs),
            "open": description.scope == Scope::Open,
            "stale": stale.map(Time::ms),
        });
        if let Some(robot) = self.robots.iter().find(|robot| &*robot.name == name) {
            let offer = to_lua(lua.mlua(), &offer).expect("plain data becomes a Lua table");
            robot.offer.call::<()>(offer).expect("replacing a table can't fail");
            return;
        }
        let mut made = None;
        lua.global(name, |lua| {
            let (object, engine) = make(lua, name, &offer)?;
            made = Some(engine);
            Ok(mlua::Value::Table(object))
        })
        .expect("a name can be added");
        let engine = made.expect("the maker was called");
        let function = |key: &str| engine.get::<Function>(key).expect("robot.lua gives its functions");
        self.robots.push(Robot {
            name: name.into(),
            receive: function("receive"),
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

    /// What was sent since the last call, in order: robot, output, message.
    pub fn take_outputs(&self, lua: &Lua) -> Vec<(Arc<str>, Arc<str>, Value)> {
        let mut outputs = Vec::new();
        for robot in &self.robots {
            let Ok(Some(sent)) = robot.take.call::<Option<Vec<Table>>>(()) else { continue };
            for pair in sent {
                let (Ok(name), Ok(message)) = (pair.get::<String>(1), pair.get::<mlua::Value>(2)) else { continue };
                let message = lua.mlua().from_value(message).unwrap_or(Value::Null);
                outputs.push((robot.name.clone(), name.into(), message));
            }
        }
        outputs
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

fn make(lua: &mlua::Lua, name: &str, offer: &Value) -> mlua::Result<(Table, Table)> {
    let now: Function = lua.globals().get("now")?;
    let near = lua.create_function(|_, (wanted, ports): (mlua::Value, Table)| {
        let mut known = Vec::new();
        for list in ["inputs", "outputs"] {
            for pair in ports.get::<Table>(list)?.pairs::<String, mlua::Value>() {
                known.push(pair?.0);
            }
        }
        let wanted = wanted.to_string()?;
        Ok(nearest(&wanted, known.iter().map(String::as_str)).map(str::to_string))
    })?;
    lua.load(OBJECT).set_name("=robot").call((name, to_lua(lua, offer)?, now, near))
}

fn messages(ports: &[crate::model::description::Port]) -> Value {
    Value::Object(ports.iter().map(|port| (port.name.clone(), port.message.clone())).collect())
}

fn to_lua(lua: &mlua::Lua, value: &Value) -> mlua::Result<mlua::Value> {
    let plain =
        SerializeOptions::new().serialize_none_to_null(false).serialize_unit_to_null(false).set_array_metatable(false);
    lua.to_value_with(value, plain)
}
