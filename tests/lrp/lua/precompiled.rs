//! Blocks compiled ahead, by a checker: any interpreter can take them up.

use std::sync::Arc;

use lrp::lua::{Checker, Precompiled, Ran};
use serde_json::json;

use super::{compile, lua};

fn precompiled(checker: &mut Checker, code: &str, variables: &[&str]) -> Arc<Precompiled> {
    let code = Arc::from(code);
    let facts = checker.check_block(&code).expect("this is Lua");
    checker.precompile(&code, &facts, variables).expect("it has few variables")
}

#[test]
fn a_block_compiled_ahead_runs_in_any_interpreter() {
    let code =
        "local add = function(n) total = total + n return tostring(total) end\nreturn add(step) .. ' ' .. add(step)";
    let ahead = precompiled(&mut Checker::default(), code, &["total", "step"]);
    for start in [1, 10] {
        let mut lua = lua();
        compile(&mut lua, "'another one before'");
        let (step, total) = (lua.cell(), lua.cell());
        lua.set(step, &json!(2));
        lua.set(total, &json!(start));
        let block = lua.load(&ahead, &[("step", step), ("total", total)]).unwrap();
        assert_eq!(lua.eval(block), Ok(json!(format!("{} {}", start + 2, start + 4))));
        assert_eq!(lua.get(total), json!(start + 4));
        assert_eq!(lua.writes(block), [total]);
    }
}

#[test]
fn each_block_of_the_same_bytecode_tells_its_own_errors() {
    let mut lua = lua();
    let ahead = precompiled(&mut Checker::default(), "local f = function()\n  error('no')\nend\nf()", &[]);
    let blocks = [(); 2].map(|()| lua.load(&ahead, &[]).unwrap());
    for block in blocks {
        assert_eq!(lua.run(block), Ran::Failed);
        let failure = lua.take_failure();
        assert_eq!((failure.block, failure.line, &*failure.message), (Some(block), 2, "no"));
    }
}

#[test]
fn what_is_built_in_is_refused_by_the_interpreter_that_has_it() {
    let ahead = precompiled(&mut Checker::default(), "local x = 1\nprint = x", &[]);
    let error = lua().load(&ahead, &[]).unwrap_err();
    assert_eq!((error.line, error.token.as_deref()), (2, Some("print")));
}

#[test]
fn a_block_is_compiled_once_for_the_same_variables() {
    let mut checker = Checker::default();
    let mut ahead = |variables: &[&str]| precompiled(&mut checker, "speed = limit", variables);
    let first = ahead(&["speed", "limit"]);
    assert!(Arc::ptr_eq(&first, &ahead(&["speed", "limit"])));
    assert!(!Arc::ptr_eq(&first, &ahead(&["speed"])), "limit is something else now");
}
