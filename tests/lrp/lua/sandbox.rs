//! What blocks have at hand, and what they can't reach.

use std::cell::RefCell;
use std::rc::Rc;

use lrp::lua::{Access, Limits, Lua, Ran};
use serde_json::json;

use super::{compile, eval, fail, lua};

#[test]
fn there_is_no_way_out() {
    let mut lua = lua();
    for code in [
        "io.open('x')",
        "os.execute('x')",
        "os.getenv('x')",
        "os.exit()",
        "dofile('x')",
        "loadfile('x')",
        "collectgarbage()",
        "debug.getregistry()",
        "package.loadlib('x', 'y')",
        "string.dump(print)",
        "warn('x')",
        "load('\\27Lua')()",
        "load(function() return '\\27Lua' end, 'x', 'b')()",
        "load('x = 1')()",
        "load('return io.open')()",
        "x = 1",
        "_G.x = 1",
        "_ENV.x = 1",
        "rawset(_G, 'x', 1)",
        "setmetatable(_G, {})",
        "setmetatable(_ENV, nil)",
        "setmetatable({}, {__gc = print})",
        "getmetatable('').__index = {}",
        "getmetatable('').x = 1",
        "getmetatable(_G).__index = nil",
        "require('os')",
        "coroutine.wrap(function() x = 1 end)()",
        "string.upper = nil",
        "math.hidden = 1",
        "rawset(math, 'hidden', 1)",
    ] {
        fail(&mut lua, code);
    }
    assert_eq!(eval(&mut lua, "('a'):upper() .. string.upper('b')"), json!("AB"));
    assert_eq!(eval(&mut lua, "rawget(_G, 'x')"), json!(null));
}

#[test]
fn load_has_the_names_of_blocks() {
    let mut lua = lua();
    assert_eq!(eval(&mut lua, "load('return math.max(1, 2)')()"), json!(2));
    assert_eq!(eval(&mut lua, "load('return x', 'x', 't', {x = 5})()"), json!(5));
    assert_eq!(eval(&mut lua, "load('return +')"), json!(null));
}

#[test]
fn the_system_is_there_when_asked_for() {
    let mut lua = Lua::new(Limits::default(), Access::System, 1);
    lua.now(5_000_000);
    assert_eq!(
        eval(&mut lua, "type(io.open) .. type(os.getenv) .. type(debug.traceback) .. os.time()"),
        json!("functionfunctionfunction5")
    );
}

#[test]
fn time_is_program_time() {
    let mut lua = lua();
    lua.now(90_061_500_000);
    lua.since(90_000_000_000);
    assert_eq!(
        eval(&mut lua, "{now(), elapsed(), os.time(), os.clock()}"),
        json!([90_061_500.0, 61_500.0, 90_061, 90_061.5])
    );
    assert_eq!(eval(&mut lua, "os.date('%Y-%m-%d %H:%M:%S')"), json!("1970-01-02 01:01:01"));
    assert_eq!(eval(&mut lua, "os.date('!%H:%M', 60)"), json!("00:01"));
    assert_eq!(eval(&mut lua, "os.time({year = 2024, month = 2, day = 29, hour = 0})"), json!(1_709_164_800));
    assert_eq!(
        eval(&mut lua, "os.time({year = 2023, month = 14, day = 29, hour = 12, min = -1})"),
        json!(1_709_207_940)
    );
    assert_eq!(eval(&mut lua, "os.time(os.date('*t', 951782399))"), json!(951_782_399));
    assert!(fail(&mut lua, "os.time({})").message.contains("field 'year' missing"));
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let code = "local t, s = {}, {} for i = 1, 50 do t['k' .. i * 7] = true t[i + 0.5] = true end
        for k in pairs(t) do s[#s + 1] = tostring(k) end
        for i = 1, 5 do s[#s + 1] = math.random(1000000) end
        math.randomseed() s[#s + 1] = math.random(1000000)
        return tostring({}) .. tostring(print) .. tostring(coroutine.create(print)) .. string.format('%s|%10s', {}, print) .. #s .. table.concat(s, ' '):sub(-400)";
    let run = |seed| {
        let mut lua = Lua::new(Limits::default(), Access::Sandboxed, seed);
        eval(&mut lua, code)
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
    assert!(
        run(1).as_str().is_some_and(|text| text.starts_with("tablefunctionthreadtable|  function106")),
        "{}",
        run(1)
    );
    fail(&mut lua(), "string.format('%p', {})");
}

/// .cargo/config.toml fixes the seed; a build that doesn't heed it sorts keys instead.
#[test]
fn the_hash_seed_is_fixed() {
    let order = "local t, s = {}, {} for i = 1, 24 do t['key' .. i] = i end for k in next, t do s[#s + 1] = k end return table.concat(s, ' ')";
    assert_eq!(eval(&mut lua(), order), json!(include_str!("../../../src/lua/order.txt").trim_end()));
}

#[test]
fn without_a_fixed_seed_keys_are_sorted() {
    let lua = mlua::Lua::new();
    let run = "local prelude = ...
        local env = { os = {}, math = {}, require = false }
        prelude(env, { now = os.clock, pcall = pcall, getmetatable = getmetatable, rawget = rawget, seed = 1, date = os.date }, 'by key')
        local function keys(t) local s = {} for k, v in env.pairs(t) do s[#s + 1] = tostring(k) .. '=' .. tostring(v) end return table.concat(s, ' ') end
        local dropped = { a = 1, b = 2, c = 3 }
        for k in env.pairs(dropped) do dropped.b = nil end
        return keys { 10, 20, b = 1, a = 2, [0.5] = 3, [true] = 4, [false] = 5 } .. ';'
            .. keys(setmetatable({}, { __pairs = function() return next, { x = 1 } end })) .. ';' .. keys(dropped)";
    let prelude = lua.load(include_str!("../../../src/lua/prelude.lua")).into_function().unwrap();
    let keys: String = lua.load(run).call(prelude).unwrap();
    assert_eq!(keys, "0.5=3 1=10 2=20 a=2 b=1 false=5 true=4;x=1;a=1 c=3");
}

#[test]
fn text_of_values_is_as_ever_otherwise() {
    let mut lua = lua();
    for (code, text) in [
        ("tostring(1)", "1"),
        ("tostring(1.0)", "1.0"),
        ("tostring(nil)", "nil"),
        ("tostring(setmetatable({}, {__tostring = function() return 'me' end}))", "me"),
        ("tostring(setmetatable({}, {__name = 'Robot'}))", "Robot"),
        ("string.format('%5.1f|%d|%s|%%|%-4s|%q', 1.25, 3, true, 'x', 'a')", "  1.2|3|true|%|x   |\"a\""),
    ] {
        assert_eq!(eval(&mut lua, code), json!(text), "{code}");
    }
    assert!(fail(&mut lua, "string.format('%d', {})").message.contains("number expected, got table"));
    assert!(fail(&mut lua, "tostring()").message.contains("value expected"));
}

#[test]
fn modules_are_read_once() {
    let mut lua = lua();
    let read = Rc::new(RefCell::new(Vec::new()));
    let log = read.clone();
    lua.library(Box::new(move |name| {
        log.borrow_mut().push(name.to_owned());
        match name {
            "drive.pid" => {
                Ok("local M = {} function M.twice(x) return 2 * x end\nfunction M.bad() error('oh') end return M"
                    .to_owned())
            }
            "loop" => Ok("return require('loop')".to_owned()),
            "wrong" => Ok("return +".to_owned()),
            "global" => Ok("\nx = 1".to_owned()),
            _ => Err(format!("{name}.lua is not there")),
        }
    }));
    let block = compile(&mut lua, "require('drive.pid').twice(4)");
    assert_eq!((lua.eval(block), lua.eval(block)), (Ok(json!(8)), Ok(json!(8))));
    assert_eq!(*read.borrow(), ["drive.pid"]);
    lua.forget("drive.pid");
    assert_eq!(lua.run(block), Ran::Done);
    assert_eq!(read.borrow().len(), 2);
    let mut message = |code| fail(&mut lua, code).message;
    assert_eq!(message("require('drive.pid').bad()"), "drive/pid.lua:2: oh");
    assert!(message("require('loop')").ends_with("module 'loop' requires itself"));
    assert_eq!(message("require('wrong')"), "wrong.lua:1: unexpected symbol near '+'");
    assert!(message("require('global')").starts_with("global.lua:2: there is no variable 'x'"));
    assert_eq!(message("require('nowhere')"), "nowhere.lua is not there");
}
