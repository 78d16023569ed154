//! Blocks that take too long or too much are stopped.

use std::time::{Duration, Instant};

use lrp::lua::{Access, FailureKind, Limits, Lua, Num, Ran, Test};
use serde_json::json;

use super::{compile, eval, fail, lua};

/// Little memory, and time enough to use it up.
const SMALL: Limits = Limits { time: Duration::from_secs(20), memory: 8 << 20 };

/// Ways to run for ever.
const RUNAWAYS: &[&str] = &[
    "while true do end",
    "::again:: goto again",
    "repeat until false",
    "pcall(function() while true do end end)",
    "return pcall(pcall, function() while true do end end)",
    "while true do pcall(function() while true do end end) end",
    "local function f() pcall(f) f() end while true do pcall(f) end",
    "xpcall(function() error('x') end, function() while true do end end)",
    "while true do xpcall(function() while true do end end, function() while true do end end) end",
    "table.sort({3, 2, 1}, function() while true do end end)",
    "return setmetatable({}, {__index = function() while true do end end}).x",
    "return ('x'):gsub('.', function() while true do end end)",
    "do local x <close> = setmetatable({}, {__close = function() while true do end end}) end",
    "local x <close> = setmetatable({}, {__close = function() while true do end end}) while true do end",
    "print(setmetatable({}, {__tostring = function() while true do end end}))",
    "while true do pcall(string.rep, 'x', 1 << 40) end",
    "coroutine.wrap(function() while true do end end)()",
    "coroutine.wrap(function() while true do pcall(function() while true do end end) end end)()",
    "while true do coroutine.wrap(function() end)() end",
    "coroutine.wrap(function() coroutine.wrap(function() while true do end end)() end)()",
    "local c = coroutine.wrap(function() while true do coroutine.yield() end end) while true do c() end",
    "while true do coroutine.resume(coroutine.create(function() while true do end end)) end",
    "local c = coroutine.create(function() local x <close> = setmetatable({}, {__close = function() while true do end end}) coroutine.yield() end) \
     coroutine.resume(c) coroutine.close(c)",
    "local c = coroutine.wrap(function() local x <close> = setmetatable({}, {__close = function() while true do end end}) error('x') end) c()",
    "string.find(('a'):rep(20000), ('.-'):rep(20) .. 'b')",
    "string.match(('a'):rep(20000), ('.-'):rep(20) .. 'b')",
    "string.gsub(('a'):rep(20000), ('.-'):rep(20) .. 'b', '')",
    "for _ in string.gmatch(('a'):rep(20000), ('.-'):rep(20) .. 'b') do end",
    "while true do pcall(string.find, ('a'):rep(20000), ('.-'):rep(20) .. 'b') end",
    "string.find(('a'):rep(10000000), ('a'):rep(5000000) .. 'b', 1, true)",
    "string.find(('('):rep(1000000), '%b()')",
    "load(function() return ' ' end)",
    "local t = {} for i = 1, 2000000 do t[i] = -i end while true do table.sort(t) end",
    "while true do load('return 1') end",
    "for i = 1, math.huge do print(i) end",
    "for k in (function() return 1 end) do end",
];

#[test]
fn whatever_runs_for_ever_is_stopped() {
    for code in RUNAWAYS {
        let mut lua = lua();
        let start = Instant::now();
        let failure = fail(&mut lua, code);
        assert_eq!(failure.kind, FailureKind::OverTime, "{code}: {failure:?}");
        assert!(start.elapsed() < Duration::from_secs(3), "{code} took {:?}", start.elapsed());
        assert_eq!(
            eval(&mut lua, "local c = coroutine.wrap(function() return ('abc'):upper() end) return c()"),
            json!("ABC"),
            "{code}"
        );
    }
}

#[test]
fn what_could_loop_in_c_is_refused() {
    let mut lua = lua();
    for code in [
        "table.move({}, 1, 1e12, 2)",
        "table.remove(setmetatable({}, {__len = function() return 1e15 // 1 | 0 end}), 1)",
        "table.insert(setmetatable({}, {__len = function() return 1 << 50 end}), 1, 1)",
        "table.concat(setmetatable({}, {__index = tostring}), '', 1, 1 << 50)",
        "table.unpack({}, 1, 1 << 40)",
        "string.rep('x', 1 << 40)",
    ] {
        let failure = fail(&mut lua, code);
        assert_ne!(failure.kind, FailureKind::OverTime, "{code}");
    }
    assert_eq!(eval(&mut lua, "string.rep('', 1 << 60)"), json!(""));
    assert_eq!(eval(&mut lua, "table.concat(table.move({1, 2, 3}, 1, 3, 2), ' ')"), json!("1 1 2 3"));
}

#[test]
fn a_stopped_block_tells_its_line() {
    let mut lua = lua();
    let block = compile(&mut lua, "local x = 1\n\nwhile true do x = x + 1 end");
    assert_eq!(lua.run(block), Ran::Failed);
    let failure = lua.take_failure();
    assert_eq!((failure.block, failure.line), (Some(block), 3));
    assert_eq!(failure.message, "stopped, as it ran for more than 20 ms");
}

#[test]
fn a_block_within_its_time_is_left_alone_after_one_that_was_not() {
    let mut lua = lua();
    let good = compile(&mut lua, "local n = 0 for i = 1, 1000 do n = n + i end return n");
    for _ in 0..5 {
        fail(&mut lua, "while true do end");
        for _ in 0..50 {
            assert_eq!(lua.run(good), Ran::Done);
        }
    }
}

#[test]
fn a_coroutine_that_was_stopped_elsewhere_can_go_on() {
    let mut lua = lua();
    let kept = lua.cell();
    let scope = [("kept", kept)];
    let start = "kept = coroutine.wrap(function() while true do coroutine.yield(1) end end) while true do kept() end";
    let start = lua.compile(start, &scope).unwrap();
    assert_eq!(lua.run(start), Ran::Failed);
    let again = lua
        .compile("kept = coroutine.wrap(function() coroutine.yield(1) return 2 end) kept() return kept()", &scope)
        .unwrap();
    assert_eq!(lua.eval(again), Ok(json!(2)));
}

#[test]
fn memory_is_limited() {
    for code in [
        "local s = 'x' while true do s = s .. s end",
        "local t = {} for i = 1, 1e9 do t[i] = {} end",
        "return string.rep('x', 1 << 30)",
    ] {
        let mut lua = Lua::new(SMALL, Access::Sandboxed, 1);
        let failure = fail(&mut lua, code);
        assert_eq!(failure.kind, FailureKind::OverMemory, "{code}: {failure:?}");
        assert_eq!(failure.message, "stopped, as more than 8 MiB of memory were in use");
        assert!(lua.memory() < 4 << 20, "{code}");
        assert_eq!(eval(&mut lua, "#('x'):rep(1000000)"), json!(1_000_000));
    }
}

#[test]
fn a_variable_that_keeps_too_much_stops_no_other_block() {
    let mut lua = Lua::new(SMALL, Access::Sandboxed, 1);
    let (small, big) = (lua.cell(), lua.cell());
    let scope = [("small", small), ("big", big)];
    let grow = lua.compile("small = {1} big = big or {} while true do big[#big + 1] = {#big} end", &scope).unwrap();
    assert_eq!(lua.run(grow), Ran::Failed);
    let failure = lua.take_failure();
    assert_eq!(failure.kind, FailureKind::OverMemory);
    assert!(failure.message.ends_with("most of it 'big'"), "{}", failure.message);
    let other = lua.compile("local t = {} for i = 1, 10000 do t[i] = {i} end return #t", &scope).unwrap();
    assert_eq!(lua.eval(other), Ok(json!(10_000)));
}

#[test]
fn deep_recursion_is_an_error() {
    let mut lua = Lua::new(Limits { time: Duration::from_secs(20), memory: 512 << 20 }, Access::Sandboxed, 1);
    let failure = fail(&mut lua, "local function f() return 1 + f() end\nreturn f()");
    assert_eq!((failure.kind, failure.line), (FailureKind::Runtime, 1));
    assert!(failure.message.starts_with("stack overflow"), "{}", failure.message);
    assert!(!failure.message.contains("traceback"), "{}", failure.message);
}

#[test]
fn failing_calls_leave_nothing_behind() {
    let mut lua = lua();
    let (bad, good) = (compile(&mut lua, "error({1})"), compile(&mut lua, "return 1, 2, 3"));
    for _ in 0..2_000 {
        assert_eq!(lua.run(bad), Ran::Failed);
        assert_eq!(lua.test(bad), Test::Failed);
        assert_eq!(lua.number(good), Num::Number(1.0));
    }
    let new = lua.cell();
    lua.set(new, &json!(5));
    assert_eq!(lua.number_in(new), Some(5.0));
}

#[test]
fn another_thread_sees_a_block_that_can_not_be_stopped() {
    let mut lua = lua();
    let emergency = lua.emergency();
    assert_eq!(emergency.overdue(), Duration::ZERO);
    lua.global("stuck", |lua| {
        let wait = lua.create_function(move |_, ()| {
            let start = Instant::now();
            // A while longer than until it is seen: then it has also been told to stop.
            while emergency.overdue() < Duration::from_millis(20) && start.elapsed() < Duration::from_secs(5) {
                std::hint::spin_loop();
            }
            Ok(!emergency.overdue().is_zero())
        })?;
        Ok(mlua::Value::Function(wait))
    })
    .unwrap();
    let block = compile(&mut lua, "stuck()");
    assert_eq!(lua.run(block), Ran::Failed);
    assert_eq!(lua.take_failure().kind, FailureKind::OverTime);
}

#[test]
fn only_what_ran_for_too_long_is_stopped() {
    let limit = Duration::from_millis(2);
    let mut lua = Lua::new(Limits { time: limit, ..Limits::default() }, Access::Sandboxed, 1);
    let count = lua.cell();
    let bodies = [
        "for i = 1, count do pcall(math.abs, i) end",
        "local c = coroutine.wrap(function() while true do coroutine.yield() end end) for i = 1, count do c() end",
        "for i = 1, count do coroutine.resume(coroutine.create(function() pcall(error) end)) end",
        "local s = ('ab'):rep(count // 10) return s:gsub('a+', '%0')",
    ];
    let blocks = bodies.map(|body| lua.compile(body, &[("count", count)]).unwrap());
    for round in 0..200_u64 {
        for block in blocks {
            lua.set(count, &json!(round * round * 7919 % 40_000));
            let start = Instant::now();
            let ran = lua.run(block);
            let took = start.elapsed();
            if ran == Ran::Failed {
                assert_eq!(lua.take_failure().kind, FailureKind::OverTime);
                assert!(took >= limit, "stopped after {took:?}");
            }
        }
    }
}
