//! Values of variables, as they are shown and compared.

use lrp::lua::Cell;
use serde_json::{Value, json};

use super::{Lua, eval, lua};

#[test]
fn values_are_shown_as_json() {
    let mut lua = lua();
    for (code, value) in [
        ("nil", json!(null)),
        ("true", json!(true)),
        ("3", json!(3)),
        ("3.0", json!(3.0)),
        ("0/0", json!("nan")),
        ("1/0", json!("inf")),
        ("-1/0", json!("-inf")),
        ("math.maxinteger", json!(i64::MAX)),
        ("'a\\u{e9}'", json!("aé")),
        ("'\\255'", json!("\u{FFFD}")),
        ("print", json!({ "lua": "function" })),
        ("{print}", json!([{ "lua": "function" }])),
        ("{}", json!({})),
        ("{1, 2, {3}}", json!([1, 2, [3]])),
        ("{1, nil, 3}", json!({ "1": 1, "3": 3 })),
        ("{1, 2, x = 3}", json!({ "1": 1, "2": 2, "x": 3 })),
        ("{[1.5] = 1, [true] = 2}", json!({ "1.5": 1, "true": 2 })),
        ("{{{{{1, 2, 3}}}}}", json!([[[[{ "cut": 3 }]]]])),
        ("{{{{{}}}}}", json!([[[[{}]]]])),
    ] {
        assert_eq!(eval(&mut lua, code), value, "{code}");
    }
}

#[test]
fn large_values_are_cut() {
    let mut lua = lua();
    let array = eval(&mut lua, "local t = {} for i = 1, 5000 do t[i] = i end return t");
    let array = array.as_array().unwrap();
    let left_out = array.last().unwrap()["cut"].as_u64().unwrap() as usize;
    assert_eq!(array.len() - 1 + left_out, 5000);
    assert!(serde_json::to_string(array).unwrap().len() < 2500);

    let object = eval(&mut lua, "local t = {} for i = 1, 5000 do t[('k%04d'):format(i)] = i end return t");
    let object = object.as_object().unwrap();
    assert_eq!(object.len() - 1 + object["cut"].as_u64().unwrap() as usize, 5000);
    assert_eq!((object["k0001"].clone(), object["k0050"].clone()), (json!(1), json!(50)));

    let text = eval(&mut lua, "('x'):rep(5000)");
    assert!(text.as_str().unwrap().chars().count() < 1100 && text.as_str().unwrap().ends_with('…'));
    assert_eq!(
        eval(&mut lua, "local t = {} t.t = t return t"),
        json!({ "t": { "t": { "t": { "t": { "cut": 1 } } } } })
    );
    eval(&mut lua, "local t = {} for i = 1, 3000 do t['k' .. i] = t end return t");
}

#[test]
fn a_value_set_is_the_value_got() {
    let mut lua = lua();
    let x = lua.cell();
    for value in [
        json!(null),
        json!(false),
        json!(-5),
        json!(2.5),
        json!(1e300),
        json!("é"),
        json!([1, [2, {"a": "b"}]]),
        json!({"k": [true]}),
    ] {
        lua.set(x, &value);
        assert_eq!(lua.get(x), value);
    }
    lua.clear(x);
    assert_eq!((lua.get(x), lua.number_in(x)), (Value::Null, None));
}

/// Whether running `code` is seen as a change of `x`.
fn changes(lua: &mut Lua, x: Cell, code: &str) -> bool {
    let block = lua.compile(code, &[("x", x)]).unwrap();
    lua.changed(x);
    lua.run(block);
    let changed = lua.changed(x);
    assert!(!lua.changed(x), "{code}");
    changed
}

#[test]
fn changes_are_seen() {
    let mut lua = lua();
    let x = lua.cell();
    assert!(!lua.changed(x));
    for (code, expected) in [
        ("x = 1", true),
        ("x = 1", false),
        ("x = 1.0", true),
        ("x = false", true),
        ("x = nil", true),
        ("x = 'abcdefghij'", true),
        ("x = 'abcde' .. 'fghij'", false),
        ("x = 'abcdefghik'", true),
        ("x = {1, 2, {a = 3}}", true),
        ("x = {1, 2, {a = 3}}", false),
        ("x[3].a = 4", true),
        ("x[1], x[2] = x[2], x[1]", true),
        ("x = {a = 1, b = 2}", true),
        ("x = {b = 2} x.a = 1", false),
        ("x = {a = 2, b = 1}", true),
        ("x = {{{{1}}}}", true),
        ("x[1][1][1][1] = 2", true),
        ("x.x = x", true),
        ("x = print", true),
        ("x = pairs", true),
    ] {
        assert_eq!(changes(&mut lua, x, code), expected, "{code}");
    }
}
