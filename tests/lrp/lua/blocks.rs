//! Blocks: compiled once, called often, each failure on its own.

use lrp::lua::{Failure, FailureKind, Level, LogLine, Num, Ran, SyntaxError, Test};
use serde_json::json;

use super::{compile, eval, fail, lua};

#[test]
fn a_block_is_an_expression_or_statements() {
    let mut lua = lua();
    assert_eq!(eval(&mut lua, "1 + 1 -- two"), json!(2));
    assert_eq!(eval(&mut lua, "local x = 2 return x * 2"), json!(4));
    assert_eq!(eval(&mut lua, ""), json!(null));
    assert_eq!(eval(&mut lua, "(function(...) return select('#', ...) end)(1, 2)"), json!(2));
}

#[test]
fn variables_are_shared_by_blocks() {
    let mut lua = lua();
    let (a, b) = (lua.cell(), lua.cell());
    let scope = [("a", a), ("b", b)];
    let set = lua.compile("a = 1 b = a + 1", &scope).unwrap();
    let keep = lua.compile("b = function() a = a + 1 return a end", &scope).unwrap();
    let use_it = lua.compile("b() return b()", &scope).unwrap();
    assert_eq!(lua.run(set), Ran::Done);
    assert_eq!((lua.get(a), lua.number_in(b)), (json!(1), Some(2.0)));
    assert_eq!(lua.run(keep), Ran::Done);
    assert_eq!(lua.eval(use_it), Ok(json!(3)));
    assert_eq!(lua.get(a), json!(3));
}

#[test]
fn the_innermost_variable_of_a_name_counts() {
    let mut lua = lua();
    let (outer, inner) = (lua.cell(), lua.cell());
    let set = lua.compile("x = 1", &[("x", outer), ("x", inner)]).unwrap();
    assert_eq!(lua.run(set), Ran::Done);
    assert_eq!((lua.get(outer), lua.get(inner)), (json!(null), json!(1)));
}

#[test]
fn a_call_tells_what_came_of_it() {
    let mut lua = lua();
    let mut block = |code| compile(&mut lua, code);
    let (yes, no, text, nothing, bad) =
        (block("1 < 2"), block("1 > 2"), block("'x'"), block("local x = 1"), block("nil + 1"));
    assert_eq!(
        [yes, no, text, nothing, bad].map(|block| lua.test(block)),
        [Test::True, Test::False, Test::NotBoolean("string"), Test::NotBoolean("nil"), Test::Failed]
    );
    let half = compile(&mut lua, "0.5");
    assert_eq!(
        [half, text, bad].map(|block| lua.number(block)),
        [Num::Number(0.5), Num::NotNumber("string"), Num::Failed]
    );
}

#[test]
fn a_failed_initialisation_leaves_the_variable() {
    let mut lua = lua();
    let x = lua.cell();
    let (good, bad) = (compile(&mut lua, "{1}"), compile(&mut lua, "error('no')"));
    assert_eq!(lua.init(good, x), Ran::Done);
    assert_eq!(lua.init(bad, x), Ran::Failed);
    assert_eq!(lua.get(x), json!([1]));
}

#[test]
fn numbers_of_freed_variables_and_blocks_are_used_again() {
    let mut lua = lua();
    let x = lua.cell();
    lua.set(x, &json!(1));
    lua.free_cell(x);
    let y = lua.cell();
    assert_eq!((x, lua.get(y)), (y, json!(null)));
    assert!(!lua.changed(y));
    let block = compile(&mut lua, "1");
    lua.free_block(block);
    assert_eq!(compile(&mut lua, "2"), block);
}

#[test]
fn a_block_tells_what_it_assigns() {
    let mut lua = lua();
    let cells: Vec<_> = (0..4).map(|_| lua.cell()).collect();
    let scope: Vec<_> = ["a", "b", "c", "d"].into_iter().zip(cells.clone()).collect();
    let block = lua.compile("a = b local f = function() c = 1 end local d d = 2 b.x = 1", &scope).unwrap();
    let mut writes = lua.writes(block).to_vec();
    writes.sort();
    assert_eq!(writes, [cells[0], cells[2]]);
    let guard = lua.compile("a == b and c.x > 1", &scope).unwrap();
    assert_eq!(lua.writes(guard), []);
}

#[test]
fn an_unknown_name_is_an_error_that_suggests_one() {
    let mut lua = lua();
    let speed = lua.cell();
    let block = lua.compile("local x = 1\nreturn sped", &[("speed", speed)]).unwrap();
    assert_eq!(lua.run(block), Ran::Failed);
    let failure = lua.take_failure();
    assert_eq!(failure.message, "there is no variable or function 'sped'; did you mean 'speed'?");
    assert_eq!((failure.line, failure.token.as_deref()), (2, Some("sped")));
    let assigned = fail(&mut lua, "total = 1");
    assert!(assigned.message.starts_with("there is no variable 'total' to assign to"), "{}", assigned.message);
    assert!(fail(&mut lua, "prnt(1)").message.ends_with("did you mean 'print'?"));
    assert!(fail(&mut lua, "load('total = 1')()").message.contains("'total'"));
    assert_eq!(eval(&mut lua, "pcall(function() return total end)"), json!(false));
}

#[test]
fn what_is_built_in_can_not_be_assigned() {
    let error = lua().compile("local x\nprint = nil", &[]).unwrap_err();
    assert_eq!((error.line, error.token.as_deref()), (2, Some("print")));
}

#[test]
fn a_name_can_be_added_after_a_block_was_compiled() {
    let mut lua = lua();
    let block = compile(&mut lua, "robot.speed");
    assert_eq!(lua.test(block), Test::Failed);
    lua.global("robot", |lua| Ok(mlua::Value::Table(lua.create_table_from([("speed", 3)])?))).unwrap();
    assert_eq!(lua.eval(block), Ok(json!(3)));
}

fn failure(lua: &mut lrp::lua::Lua, code: &str) -> (String, u32, Option<String>) {
    let Failure { message, line, token, kind, .. } = fail(lua, code);
    assert_eq!(kind, FailureKind::Runtime);
    (message, line, token)
}

#[test]
fn errors_are_readable() {
    let mut lua = lua();
    let x = lua.cell();
    let cases: [(&str, &str, u32, Option<&str>); 7] = [
        ("local t\n\nreturn t.x", "attempt to index a nil value (local 't')", 3, Some("t")),
        ("error('no light')", "no light", 1, None),
        ("error('no light', 0)", "no light", 1, None),
        ("\nerror({code = 1, why = 'dark'})", "{\"code\":1,\"why\":\"dark\"}", 2, None),
        ("error()", "nil", 1, None),
        ("\nstring.rep()", "bad argument #1 to 'rep' (string expected, got no value)", 2, None),
        ("table.insert(1, 2)", "bad argument #1 to 'insert' (table expected, got number)", 1, None),
    ];
    for (code, message, line, token) in cases.into_iter() {
        assert_eq!(failure(&mut lua, code), (message.to_owned(), line, token.map(str::to_owned)), "{code}");
    }
    let block = lua.compile("x.y = 1", &[("x", x)]).unwrap();
    assert_eq!(lua.run(block), Ran::Failed);
    assert_eq!(lua.take_failure().message, "attempt to index a nil value (variable 'x')");
}

#[test]
fn errors_from_rust_are_readable() {
    let mut lua = lua();
    lua.global("fly", |lua| {
        Ok(mlua::Value::Function(lua.create_function(|_, ()| Err::<(), _>(mlua::Error::runtime("no wings")))?))
    })
    .unwrap();
    assert_eq!(failure(&mut lua, "\nfly()"), ("no wings".to_owned(), 2, None));
    assert_eq!(eval(&mut lua, "select(2, pcall(fly)) and tostring(select(2, pcall(fly)))"), json!("no wings"));
}

#[test]
fn an_error_belongs_to_the_block_it_is_in() {
    let mut lua = lua();
    let f = lua.cell();
    let define = lua.compile("\nf = function()\n  error('deep') end", &[("f", f)]).unwrap();
    let call = lua.compile("f()", &[("f", f)]).unwrap();
    assert_eq!(lua.run(define), Ran::Done);
    assert_eq!(lua.run(call), Ran::Failed);
    let failure = lua.take_failure();
    assert_eq!((failure.block, failure.line, failure.message.as_str()), (Some(define), 3, "deep"));
    lua.free_block(define);
    assert_eq!(lua.run(call), Ran::Failed);
    assert_eq!(lua.take_failure().block, None);
}

#[test]
fn positions_are_those_of_the_file() {
    let mut lua = lua();
    let block = compile(&mut lua, "\nlocal ok, why = pcall(function() error('dark') end)\nprint(why)\nerror(why)");
    lua.set_place(block, &"x.lrp".into(), 13);
    for (first, said) in [(13, "x.lrp:14: dark"), (20, "x.lrp:21: dark")] {
        lua.set_place(block, &"x.lrp".into(), first);
        assert_eq!(lua.run(block), Ran::Failed);
        let log = lua.take_logs();
        assert_eq!(log, [LogLine { level: Level::Info, message: said.to_owned(), block: Some(block), line: 3 }]);
        let failure = lua.take_failure();
        assert_eq!((failure.message.as_str(), failure.block), (said, Some(block)));
    }
}

#[test]
fn a_syntax_error_has_a_line_and_a_word() {
    let mut lua = lua();
    let mut error = |code| lua.compile(code, &[]).unwrap_err();
    let found = |message: &str, line, token: Option<&str>| SyntaxError {
        message: message.to_owned(),
        line,
        token: token.map(str::to_owned),
    };
    assert_eq!(error("x = = 1"), found("unexpected symbol near '='", 1, Some("=")));
    assert_eq!(error("a > "), found("unexpected symbol near <eof>", 1, None));
    assert_eq!(error("local x = 1\nlocal y = x +"), found("unexpected symbol near <eof>", 2, None));
    assert_eq!(error("x := 1"), found("<name> expected near '='", 1, Some("=")));
    assert_eq!(error("return 1 end, function() return 2").line, 1);
    assert_eq!(error("\rlocal\r\nx = )").line, 3);
    assert_eq!(error("return ...").line, 1);
    let unclosed = error("\nif true then\n\nx()");
    assert_eq!(unclosed.message_in(11), "'end' expected (to close 'if' at line 12) near <eof>");
    assert_eq!(unclosed.line, 4);
}

#[test]
fn too_many_variables_are_a_syntax_error() {
    let mut lua = lua();
    let names: Vec<_> = (0..300).map(|n| format!("v{n}")).collect();
    let scope: Vec<_> = names.iter().map(|name| (name.as_str(), lua.cell())).collect();
    let sum = |count: usize| names[..count].iter().map(|name| format!("{name} = 1 ")).collect::<String>();
    let most = lua.compile(&sum(200), &scope).unwrap();
    assert_eq!(lua.run(most), Ran::Done);
    assert_eq!(lua.get(scope[199].1), json!(1));
    let error = lua.compile(&sum(201), &scope).unwrap_err();
    assert!(error.message.starts_with("more than 200 variables"), "{error}");
}

#[test]
fn what_is_printed_is_logged() {
    let mut lua = lua();
    assert!(!lua.has_logs());
    let block =
        compile(&mut lua, "print(1, 'a', nil, {x = {1, 2}}, print)\nlog.warn('low')\nlog.debug() log.error(2.5)");
    assert_eq!(lua.run(block), Ran::Done);
    assert!(lua.has_logs());
    let line = |level, message: &str, line| LogLine { level, message: message.to_owned(), block: Some(block), line };
    assert_eq!(
        lua.take_logs(),
        [
            line(Level::Info, "1\ta\tnil\t{\"x\":[1,2]}\tfunction", 1),
            line(Level::Warn, "low", 2),
            line(Level::Debug, "", 3),
            line(Level::Error, "2.5", 3),
        ]
    );
    assert!(!lua.has_logs());
}

#[test]
fn a_flood_of_lines_is_cut() {
    let mut lua = lua();
    let block = compile(&mut lua, "for i = 1, 1005 do print(i) end print(('x'):rep(10000))");
    assert_eq!(lua.run(block), Ran::Done);
    let log = lua.take_logs();
    assert_eq!((log.len(), log[1000].message.as_str()), (1001, "6 more lines were left out"));
}
