//! Our matcher does what Lua's does.

use proptest::prelude::*;

use super::lua;

const CALLS: &str = r###"
  local s, p, r, init = ...
  local out = {}
  local function note(...)
    local t = table.pack(...)
    for i = 1, t.n do t[i] = math.type(t[i]) == "integer" and "#" .. t[i] or tostring(t[i]) end
    out[#out + 1] = table.concat(t, "|")
  end
  note(pcall(string.find, s, p))
  note(pcall(string.find, s, p, init))
  note(pcall(string.find, s, p, init, true))
  note(pcall(string.match, s, p))
  note(pcall(string.match, s, p, init))
  note(pcall(string.gsub, s, p, r))
  note(pcall(string.gsub, s, p, "<%0>", 2))
  note(pcall(string.gsub, s, p, function(...) return select("#", ...) end))
  note(pcall(string.gsub, s, p, { a = "A", b = false, ab = 7 }))
  note(pcall(function() for a, b in string.gmatch(s, p) do note(a, b) end end))
  note(pcall(function() for a, b in string.gmatch(s, p, init) do note(a, b) end end))
  return table.concat(out, "\n")
"###;

/// Patterns, most of them well-formed.
fn patterns() -> impl Strategy<Value = String> {
    let item = prop_oneof![
        6 => "[ab.]",
        2 => prop::sample::select(vec!["%a", "%d", "%S", "%w", "%p", "%.", "%x", "%z", "%g", "%c", "%u", "%L"]).prop_map(str::to_owned),
        2 => prop::sample::select(vec!["[ab]", "[^a]", "[a-c]", "[]]", "[^]]", "[%d_]", "[a-]", "[%a-z]", "[", "[^", "[a-%", "[]", "[%]"]).prop_map(str::to_owned),
        2 => prop::sample::select(vec!["%b()", "%bab", "%b", "%f[a]", "%f[^a]", "%f", "%f[", "%1", "%2", "%0", "%"]).prop_map(str::to_owned),
        3 => prop::sample::select(vec!["(", ")", "()", "$", "^", "-", "\0", "é"]).prop_map(str::to_owned),
    ];
    let suffix = prop::sample::select(vec!["", "", "", "*", "+", "-", "?"]);
    ("\\^?", prop::collection::vec((item, suffix), 0..7))
        .prop_map(|(anchor, items)| anchor + &items.into_iter().map(|(item, suffix)| item + suffix).collect::<String>())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn ours_does_what_luas_does(
        cases in prop::collection::vec(("[ab()1. \\]\0é_]{0,10}", patterns(), "[a%01]{0,4}", -12_i64..13), 20)
    ) {
        let own = mlua::Lua::new();
        let (own, lua) = (own.load(CALLS).set_name("=calls").into_function().unwrap(), lua());
        let ours = lua.mlua().load(CALLS).set_name("=calls").into_function().unwrap();
        for (subject, pattern, replacement, init) in cases {
            let arguments = (subject.as_str(), pattern.as_str(), replacement.as_str(), init);
            let expected: mlua::LuaString = own.call(arguments).unwrap();
            let found: mlua::LuaString = ours.call(arguments).unwrap();
            prop_assert_eq!(found.to_string_lossy(), expected.to_string_lossy(), "{:?}", arguments);
        }
    }
}

#[test]
fn many_optional_items_need_no_stack() {
    assert_eq!(
        super::eval(&mut lua(), "#string.match(('a'):rep(100), ('b?'):rep(50000) .. 'a+')"),
        serde_json::json!(100)
    );
}
