//! The functions of `t`: each with its name, how it is called, and what it does to the program under test.

use std::rc::Rc;

use mlua::{FromLuaMulti, Function, IntoLuaMulti, Lua, MultiValue, Table, Value};
use serde_json::json;

use super::api::Api;
use super::bench::{Bench, Trouble};
use super::calls::Said;
use super::failure::Complaint;
use super::message::hint;
use super::readable::sent;
use super::value::{source, to_json, to_lua};
use crate::runtime::What;
use crate::runtime::{BreakAt, Breaking, Command, Saves, Time};

/// The table a test calls `t`.
pub fn table(lua: &Lua, api: &Rc<Api>) -> mlua::Result<Table> {
    let t = Functions { lua, table: lua.create_table()?, api };
    t.loading()?;
    t.passing_time()?;
    t.commanding()?;
    t.asking()?;
    t.expecting()?;
    refuse_others(lua, &t.table)?;
    Ok(t.table)
}

struct Functions<'l> {
    lua: &'l Lua,
    table: Table,
    api: &'l Rc<Api>,
}

impl Functions<'_> {
    /// `usage`: how it is called, as in `set(path, value)`.
    fn add<A, R>(&self, usage: &'static str, f: impl Fn(&Lua, &Api, A) -> mlua::Result<R> + 'static) -> mlua::Result<()>
    where
        A: FromLuaMulti,
        R: IntoLuaMulti,
    {
        let api = Rc::clone(self.api);
        let function = self.lua.create_function(move |lua, mut arguments: MultiValue| {
            if !matches!(arguments.pop_front(), Some(Value::Table(_))) {
                return Err(Complaint::new(format!("call it with a colon: `t:{usage}`")).into());
            }
            let wrong = |error: mlua::Error| match error {
                mlua::Error::FromLuaConversionError { from, .. } => {
                    Complaint::new(format!("it is called `t:{usage}`, not with a {from}"))
                }
                other => Complaint::new(format!("it is called `t:{usage}`; {other}")),
            };
            f(lua, &api, A::from_lua_multi(arguments, lua).map_err(wrong)?)
        })?;
        let name = usage.split('(').next().unwrap_or(usage);
        self.table.raw_set(name, function)
    }

    fn loading(&self) -> mlua::Result<()> {
        self.add("load(file, options)", |_, api, (file, options): (String, Option<Table>)| {
            Ok(api.load(&file, options.as_ref())?)
        })?;
        self.add("source(text, options)", |_, api, (text, options): (String, Option<Table>)| {
            Ok(api.source(text, options.as_ref())?)
        })?;
        self.add("write(file, text)", |_, api, (file, text): (String, String)| Ok(api.write(&file, text)?))?;
        self.add("edit(text or function)", |_, api, edit: Value| match edit {
            Value::Function(change) => edit_by(api, &change),
            Value::String(text) => Ok(api.with(|bench| bench.edit(text.to_string_lossy()))?),
            other => Err(Complaint::new(format!(
                "an edit is a text, or a function of the old text, not a {}",
                other.type_name()
            ))
            .into()),
        })
    }

    fn passing_time(&self) -> mlua::Result<()> {
        self.add("advance(ms)", |_, api, ms: f64| {
            let time = (ms.is_finite() && ms >= 0.0).then(|| Time::from_ms(ms));
            let time = time.ok_or_else(|| Complaint::new(format!("{ms} is no time in milliseconds")))?;
            Ok(api.with(|bench| bench.advance(time))?)
        })?;
        self.add("step(n)", |_, api, count: Option<u64>| Ok(api.with(|bench| bench.steps(count.unwrap_or(1)))?))?;
        self.add("input(name, message)", |_, api, (name, message): (String, Value)| {
            Ok(api.with(|bench| bench.input(&name, to_json(&message)?))?)
        })
    }

    fn commanding(&self) -> mlua::Result<()> {
        self.add("pause()", |_, api, ()| Ok(api.command(Command::Pause)?))?;
        self.add("resume()", |_, api, ()| Ok(api.command(Command::Resume)?))?;
        self.add("restart()", |_, api, ()| Ok(api.command(Command::Restart)?))?;
        self.add("hold()", |_, api, ()| Ok(api.command(Command::Saves { mode: Saves::Hold })?))?;
        self.add("apply()", |_, api, ()| Ok(api.command(Command::ApplyHeld)?))?;
        self.add("drop()", |_, api, ()| Ok(api.command(Command::DropHeld)?))?;
        self.add("transition_to(path)", |_, api, state: String| Ok(api.command(Command::TransitionTo { state })?))?;
        self.add("jump_to(path)", |_, api, state: String| Ok(api.command(Command::JumpTo { state })?))?;
        self.add("set(path, value)", |_, api, (var, value): (String, Value)| {
            Ok(api.command(Command::Set { var, value: source(&value)? })?)
        })?;
        self.add("reset(path)", |_, api, var: String| Ok(api.command(Command::Reset { var })?))?;
        self.breaking("break_at(state, transition or {condition =, machine =})", Breaking::Set)?;
        self.breaking("clear_break(state, transition or {condition =, machine =})", Breaking::Clear)?;
        self.replying()
    }

    fn replying(&self) -> mlua::Result<()> {
        self.add("reply(call, value)", |_, api, (call, value): (String, Value)| {
            let value = to_json(&value)?;
            Ok(api.with(|bench| bench.reply(&call, Said::Done(value)))?)
        })?;
        self.add("fail(call, error)", |_, api, (call, error): (String, String)| {
            Ok(api.with(|bench| bench.reply(&call, Said::Failed(error)))?)
        })?;
        self.add("feedback(call, value)", |_, api, (call, value): (String, Value)| {
            let value = to_json(&value)?;
            Ok(api.with(|bench| bench.reply(&call, Said::Feedback(value)))?)
        })?;
        self.add("calls(name)", |lua, api, name: String| {
            let calls = api.with(|bench| bench.calls(&name))?;
            calls.iter().map(|arguments| to_lua(lua, arguments)).collect::<mlua::Result<Vec<Value>>>()
        })
    }

    fn breaking(&self, usage: &'static str, mode: Breaking) -> mlua::Result<()> {
        self.add(usage, move |_, api, at: Value| {
            let at = match at {
                Value::String(name) => place(&name.to_string_lossy()),
                Value::Table(table) => condition(&table)?,
                other => {
                    let kind = other.type_name();
                    return Err(Complaint::new(format!("it is called `t:{usage}`, not with a {kind}")).into());
                }
            };
            Ok(api.command(Command::Break { at, mode })?)
        })
    }

    fn asking(&self) -> mlua::Result<()> {
        self.add("is_paused()", |_, api, ()| Ok(api.with(|bench| Ok(bench.is_paused()))?))?;
        self.add("breakpoints()", |lua, api, ()| {
            let all = api.with(|bench| Ok(bench.breakpoints().to_vec()))?;
            all.iter().map(|breakpoint| to_lua(lua, &json!(breakpoint))).collect::<mlua::Result<Vec<Value>>>()
        })?;
        self.add("get(path)", |lua, api, path: String| {
            let value = api.with(|bench| bench.get(&path))?;
            value.map_or(Ok(Value::Nil), |value| to_lua(lua, &value))
        })?;
        self.add("active()", |_, api, ()| Ok(api.with(|bench| Ok(bench.active()))?))?;
        self.add("is_active(path)", |_, api, path: String| Ok(api.with(|bench| bench.is_active(&path))?))?;
        self.add("why(path)", |lua, api, path: String| {
            let ways = api.with(|bench| bench.why(&path))?;
            ways.iter().map(|way| to_lua(lua, &json!(way))).collect::<mlua::Result<Vec<Value>>>()
        })?;
        self.add("held()", |lua, api, ()| {
            let held = api.with(|bench| Ok(bench.held().map(|held| json!(held))))?;
            held.map_or(Ok(Value::Nil), |held| to_lua(lua, &held))
        })?;
        self.add("outputs(name)", |lua, api, name: String| outputs(lua, api, &name))?;
        self.add("records(kind)", |lua, api, kind: Option<String>| records(lua, api, kind.as_deref()))?;
        self.add("errors()", |lua, api, ()| {
            let troubles = api.with(|bench| Ok(bench.troubles()))?;
            troubles.iter().map(|trouble| to_lua(lua, &spelled_out(trouble))).collect::<mlua::Result<Vec<Value>>>()
        })
    }

    fn expecting(&self) -> mlua::Result<()> {
        self.add("expect(condition, message)", |_, _, (condition, message): (Value, Value)| match condition {
            Value::Nil | Value::Boolean(false) => {
                let message = match message {
                    Value::Nil => format!("expected this, and it is {}", condition.to_string()?),
                    message => message.to_string()?,
                };
                Err(Complaint::new(message).into())
            }
            _ => Ok(()),
        })?;
        self.add("expect_active(path)", |_, api, path: String| Ok(api.with(|bench| bench.expect_active(&path))?))?;
        self.add("expect_output(name, predicate)", |lua, api, (name, holds): (String, Option<Function>)| {
            for message in outputs(lua, api, &name)? {
                match &holds {
                    Some(holds) if !holds.call::<bool>(message)? => {}
                    _ => return Ok(()),
                }
            }
            Err(api.with(|bench| missing_output(bench, &name)).map_or_else(mlua::Error::from, mlua::Error::from))
        })
    }
}

/// A misspelt function is the likeliest mistake of a test.
fn refuse_others(lua: &Lua, table: &Table) -> mlua::Result<()> {
    let mut names: Vec<String> = table.pairs::<String, Value>().flatten().map(|(name, _)| name).collect();
    names.sort();
    let unknown = lua.create_function(move |_, (_, name): (Value, Value)| -> mlua::Result<()> {
        let name = name.to_string()?;
        let hint = hint(&name, names.iter().map(String::as_str));
        Err(Complaint::new(format!("`t` has no function `{name}`; {hint}")).into())
    })?;
    let meta = lua.create_table()?;
    meta.raw_set("__index", unknown)?;
    table.set_metatable(Some(meta))
}

/// A transition as lists of changes name it, or else a state's path.
fn place(name: &str) -> BreakAt {
    match name.contains("->") {
        true => BreakAt::Transition { transition: name.into() },
        false => BreakAt::State { state: name.into() },
    }
}

fn condition(table: &Table) -> mlua::Result<BreakAt> {
    for key in table.pairs::<Value, Value>().flatten().map(|(key, _)| key) {
        let key = key.to_string()?;
        if !CONDITION.contains(&&*key) {
            let hint = hint(&key, CONDITION.into_iter());
            return Err(Complaint::new(format!("a breakpoint has no `{key}`; {hint}")).into());
        }
    }
    let field = |key: &str| table.get::<Option<String>>(key);
    let condition = field("condition")?.ok_or_else(|| Complaint::new("the `condition` to break on is missing"))?;
    Ok(BreakAt::Condition { condition: condition.into(), machine: field("machine")?.unwrap_or_default().into() })
}

const CONDITION: [&str; 2] = ["condition", "machine"];

fn edit_by(api: &Api, change: &Function) -> mlua::Result<()> {
    let old = api.with(|bench| Ok(bench.text().to_string()))?;
    // `gsub` gives a count as well.
    let new = change.call::<MultiValue>(&*old)?.pop_front();
    match new {
        Some(Value::String(new)) if new.to_string_lossy() == old => {
            Err(Complaint::new("the edit changes nothing: does its pattern still occur in the program?").into())
        }
        Some(Value::String(new)) => Ok(api.with(|bench| bench.edit(new.to_string_lossy()))?),
        other => {
            let what = other.map_or("nothing", |other| other.type_name());
            Err(Complaint::new(format!("the function gives the new text, not {what}")).into())
        }
    }
}

fn outputs(lua: &Lua, api: &Api, name: &str) -> mlua::Result<Vec<Value>> {
    let messages = api.with(|bench| Ok(bench.outputs(name)?.into_iter().cloned().collect::<Vec<_>>()))?;
    messages.iter().map(|message| to_lua(lua, message)).collect()
}

fn missing_output(bench: &Bench, name: &str) -> Result<Complaint, Complaint> {
    let (robot, output) = name.split_once('.').unwrap_or((name, ""));
    let messages = bench.outputs(name)?;
    let complaint = match messages.is_empty() {
        true => Complaint::new(format!("expected an output `{name}` in the last step")).seen("none"),
        false => {
            let seen: Vec<String> = messages.into_iter().map(|message| sent(robot, output, message)).collect();
            Complaint::new(format!("expected another output `{name}` in the last step")).seen(seen.join("\n"))
        }
    };
    Ok(complaint)
}

fn records(lua: &Lua, api: &Api, kind: Option<&str>) -> mlua::Result<Vec<Value>> {
    if let Some(unknown) = kind.filter(|kind| !What::KINDS.contains(kind)) {
        return Err(Complaint::new(format!(
            "there are no records `{unknown}`; {}",
            hint(unknown, What::KINDS.iter().copied())
        ))
        .into());
    }
    let mut told = api.told.borrow_mut();
    let new: Vec<_> =
        api.with(|bench| Ok(bench.records()[told.len()..].iter().map(|record| json!(record)).collect()))?;
    for record in new {
        told.push((record["kind"].as_str().unwrap_or_default().to_string(), to_lua(lua, &record)?));
    }
    let wanted = told.iter().filter(|(known, _)| kind.is_none_or(|kind| kind == known));
    Ok(wanted.map(|(_, record)| record.clone()).collect())
}

fn spelled_out(trouble: &Trouble) -> serde_json::Value {
    let mut error = json!(trouble.finding);
    error["state"] = json!(trouble.state);
    error["count"] = trouble.count.into();
    error
}
