//! Lua for blocks, from outside: text in, values and failures out.

mod blocks;
mod facts;
mod limits;
mod patterns;
mod precompiled;
mod rounds;
mod sandbox;
mod values;

use std::time::Duration;

use lrp::lua::{Access, Block, Failure, Limits, Lua, Ran};
use serde_json::Value;

/// An interpreter in which runaway blocks are stopped soon.
fn lua() -> Lua {
    Lua::new(Limits { time: Duration::from_millis(20), ..Limits::default() }, Access::Sandboxed, 7)
}

fn compile(lua: &mut Lua, code: &str) -> Block {
    match lua.compile(code, &[]) {
        Ok(block) => block,
        Err(error) => panic!("{code}: {error}"),
    }
}

/// The value of a block without variables.
fn eval(lua: &mut Lua, code: &str) -> Value {
    let block = compile(lua, code);
    let value = lua.eval(block);
    lua.free_block(block);
    match value {
        Ok(value) => value,
        Err(failure) => panic!("{code}: {failure:?}"),
    }
}

/// Why a block without variables fails.
fn fail(lua: &mut Lua, code: &str) -> Failure {
    let block = compile(lua, code);
    assert_eq!(lua.run(block), Ran::Failed, "{code}");
    let failure = lua.take_failure();
    lua.free_block(block);
    failure
}
