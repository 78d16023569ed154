//! What is said of a block without running it.

use std::sync::Arc;

use lrp::lua::{Checker, Facts, FieldKind, Gives, NameUse, known_fields, known_names};
use serde_json::json;

use super::{eval, lua};

fn uses(names: &[NameUse]) -> Vec<(&str, u32)> {
    names.iter().map(|found| (found.name.as_str(), found.line)).collect()
}

fn facts(code: &str) -> Facts {
    Checker::default().check(code).unwrap_or_else(|error| panic!("{code}: {error}"))
}

#[test]
fn free_names_are_found_with_luas_own_scoping() {
    let found = facts("local a = b\nlocal function f(c) d = c + a return e.x end\nif a then g = f(h) end");
    assert_eq!(uses(&found.reads), [("b", 1), ("e", 2), ("h", 3)]);
    assert_eq!(uses(&found.writes), [("d", 2), ("g", 3)]);
}

#[test]
fn words_in_strings_fields_and_comments_are_no_names() {
    let found = facts("x.y.z('a b' --[[ c ]] .. [[d]], {e = 1, [f] = 2}):m() -- n");
    assert_eq!(uses(&found.reads), [("x", 1), ("f", 1)]);
}

#[test]
fn expressions_have_names_too() {
    let found = facts("light.data > limit and print");
    assert_eq!(uses(&found.reads), [("light", 1), ("limit", 1), ("print", 1)]);
}

#[test]
fn long_names_and_many_constants_are_no_obstacle() {
    let long = "a".repeat(60);
    let many: String = (0..300).map(|n| format!("t[{n}.5] = 'c{n}'\n")).collect();
    let found = facts(&format!("local t = {{}}\n{many}{long} = late\nlate = {long}\nreturn function() late2 = 1 end"));
    assert_eq!(uses(&found.reads), [("late", 302), (long.as_str(), 303)]);
    assert_eq!(uses(&found.writes), [(long.as_str(), 302), ("late", 303), ("late2", 304)]);
}

#[test]
fn lines_are_right_in_long_blocks() {
    let found = facts(&format!("local x\n{}\nreturn function()\n return far end", "\n".repeat(1000)));
    assert_eq!(uses(&found.reads), [("far", 1004)]);
}

/// `read robot.light.data`, each with its line.
fn fields(code: &str) -> Vec<String> {
    let told = |kind| match kind {
        FieldKind::Read => "read",
        FieldKind::Write => "write",
        FieldKind::Method => "method",
        FieldKind::Given => "given",
    };
    let fields = facts(code).fields;
    fields.iter().map(|it| format!("{} {} {}.{}", it.line, told(it.kind), it.name, it.fields.join("."))).collect()
}

#[test]
fn fields_of_free_names_are_followed() {
    assert_eq!(fields("a.b.c + d.e\n.f"), ["1 read a.b", "1 read a.b.c", "1 read d.e", "2 read d.e.f"]);
    assert_eq!(fields("a.b = nil; a:m(1); a['c'] = a.d"), ["1 write a.b", "1 method a.m", "1 read a.d", "1 write a.c"]);
    assert_eq!(fields("local r = a; if x then y = r.b end"), ["1 read a.b"]);
    assert_eq!(fields("return function() return a.b end"), ["1 read a.b"]);
}

#[test]
fn fields_of_tables_that_are_handed_over_are_followed() {
    let given = ["1 read a.f", "1 given a.f.x", "1 given a.f.x.y", "1 given a.f.z"];
    assert_eq!(fields("a.f{ x = { y = 1 }, z = 2 }"), given);
    assert_eq!(fields("local t = { x = { y = 1 } }; t.z = 2; a.f(t); a.f(t, 1)")[..4], given);
    assert_eq!(fields("a.f({ x = 1 }, 2)"), ["1 read a.f"], "only a single argument is a message");
}

#[test]
fn what_is_not_certain_is_not_said_of_fields() {
    assert_eq!(fields("local a = {}; return a.b"), [""; 0], "a local");
    assert_eq!(fields("(x and a or c).b"), [""; 0], "one of several");
    assert_eq!(fields("local r = a; r = c.d; return r.b"), ["1 read c.d", "1 read c.d.b"], "assigned anew");
    let shared = "local r = a; local function f() r = {} end; f(); return r.b";
    assert_eq!(fields(shared), [""; 0], "another function may assign it");
    assert_eq!(fields("local r = a; while r do local s = r.b; r = {} end"), [""; 0], "a loop comes back");
    assert_eq!(fields("a.b().c"), ["1 read a.b"], "what a call gives");
}

#[test]
fn what_a_block_gives_in_any_case() {
    let gives = |code: &str| facts(code).gives;
    for (code, what) in [
        ("true", Gives::True),
        ("not true", Gives::False),
        ("nil", Gives::Nil),
        ("500", Gives::Number(500.0)),
        ("-2.5", Gives::Number(-2.5)),
        ("1e9 * 2", Gives::Number(2e9)),
        ("'x'", Gives::Text),
        ("{ x = 1, 2 }", Gives::Table),
        ("function() end", Gives::Function),
        ("x & 3", Gives::Bits),
        ("x | y", Gives::Bits),
        ("x = 3", Gives::Nothing),
        ("", Gives::Nothing),
        ("x = 3; return true", Gives::True),
        ("x", Gives::Something),
        ("f()", Gives::Something),
        ("...", Gives::Something),
        ("x > 3", Gives::Something),
        ("x and 3", Gives::Something),
        ("if x then return 3 end", Gives::Something),
        ("while true do end", Gives::Something),
        ("goto on; do return 3 end ::on:: return 4", Gives::Something),
    ] {
        assert_eq!(gives(code), what, "{code}");
    }
}

#[test]
fn known_names_are_those_at_hand() {
    let mut lua = lua();
    let names = eval(
        &mut lua,
        "local t = {} for k in pairs(_ENV) do t[#t + 1] = k end table.sort(t) return table.concat(t, ' ')",
    );
    assert_eq!(names, json!(known_names().join(" ")));
    for library in known_names() {
        let fields = format!(
            "local t = {{}} if type({library}) == 'table' and {library} ~= _G then for k in pairs({library}) do t[#t + 1] = k end end table.sort(t) return table.concat(t, ' ')"
        );
        assert_eq!(eval(&mut lua, &fields), json!(known_fields(library).join(" ")), "{library}");
    }
    assert_eq!(known_fields("nothing"), [""; 0]);
}

#[test]
fn a_configuration_is_data() {
    let mut checker = Checker::default();
    let config = "\n subscribe = { light = '/light std_msgs/msg/Int32' }, -- so\n stale = 500, list = {1, 2}, deep = {{{{{{7}}}}}}";
    let value = json!({ "subscribe": { "light": "/light std_msgs/msg/Int32" }, "stale": 500, "list": [1, 2], "deep": [[[[[[7]]]]]] });
    assert_eq!(checker.config(config), Ok(value));
    assert_eq!(checker.config(""), Ok(json!({})));
    let error = checker.config("a = 1,\nb = fast").unwrap_err();
    assert_eq!((error.line, error.token.as_deref()), (2, Some("fast")));
    assert_eq!(checker.config("a = 1,\n\nb = = 2").unwrap_err().line, 3);
    assert!(checker.config("a = (function() while true do end end)()").unwrap_err().message.contains("250 ms"));
    assert_eq!(checker.config("a = 'still here'"), Ok(json!({ "a": "still here" })));
}

#[test]
fn a_block_is_looked_at_once_while_programs_have_it() {
    let mut checker = Checker::default();
    let code = Arc::from("speed = limit");
    let look = |checker: &mut Checker| checker.check_block(&code).expect("this is Lua");
    let first = look(&mut checker);
    assert_eq!(*first, facts(&code));
    for missing_from in [0, 1] {
        (0..=missing_from).for_each(|_| checker.next_program());
        assert!(Arc::ptr_eq(&first, &look(&mut checker)), "known after {missing_from} programs without it");
    }
    (0..3).for_each(|_| checker.next_program());
    assert!(!Arc::ptr_eq(&first, &look(&mut checker)), "forgotten after two programs without it");
}

#[test]
fn a_block_that_is_no_lua_is_never_known() {
    let mut checker = Checker::default();
    let code = Arc::from("speed = = 1");
    let error = checker.check_block(&code).unwrap_err();
    checker.next_program();
    assert_eq!(checker.check_block(&code), Err(error));
}
