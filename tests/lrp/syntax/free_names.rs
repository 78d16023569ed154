//! The free names of a piece of Lua: as Lua's own compiler finds them.

use std::collections::BTreeSet;

use lrp::lua::Checker;
use lrp::syntax::lua_names::words;
use proptest::prelude::*;

use super::any_lua::piece;
use crate::plot::Choices;

fn free(code: &str) -> Vec<String> {
    let free = words(code).into_iter().filter(|word| word.is_free);
    free.map(|word| format!("{}@{}", &code[word.token.range.clone()], word.token.range.start)).collect()
}

#[test]
fn locals_fields_keys_and_labels_are_not_free() {
    let cases = [
        ("x + y.x", "x@0 y@4"),
        ("local x = x; x = 1", "x@10"),
        ("local x <const>, y = y, x x = y z()", "y@21 x@24 z@32"),
        ("local x y = x", "y@8"),
        ("do local x = 1 end x = 1", "x@19"),
        ("local function x() x() end", ""),
        ("local x = function() return x end", "x@28"),
        ("function x.y.z(a, ...) return a, b, ... end", "x@9 b@33"),
        ("function x:y(a) return self, a end return self", "x@9 self@42"),
        ("for x = x, x + 1, x do x = 2 end x = 3", "x@8 x@11 x@18 x@33"),
        ("for k, v in pairs(v) do k = v end", "pairs@12 v@18"),
        ("while x do local x = 1 x = 2 end x()", "x@6 x@33"),
        ("if x then local x x = 1 elseif x then x = 2 else local x x = 3 end", "x@3 x@31 x@38"),
        ("repeat local x = 1 until x == y x = 2", "y@30 x@32"),
        ("t = { x = x, [x] = 1, x; y = 2, f = function(x) return x end }", "t@0 x@10 x@14 x@22"),
        ("goto x ::x:: x = 1", "x@13"),
        ("x:y(z)", "x@0 z@4"),
        ("f{ x = 1 } 'x' [[x]] -- x", "f@0"),
        ("local a = b (c or d).e f(a)", "b@10 c@13 d@18 f@23"),
        ("local x = #x .. -x ^ x == not x return x", "x@11 x@17 x@21 x@30"),
        ("local x = { x } return function(y) return x, y, z end", "x@12 z@48"),
    ];
    for (code, expected) in cases {
        assert_eq!(free(code).join(" "), expected, "{code}");
    }
}

#[test]
fn broken_code_is_read_as_well() {
    for code in ["end end x", ") ] } x", "local", "function", "for x", "until x until", "local x <", "::", "{ x ="] {
        words(code);
    }
}

#[test]
fn they_are_what_the_compiler_finds() {
    let mut checked = 0;
    for folder in ["ok", "run", "edit"] {
        for path in std::fs::read_dir(crate::runs::corpus(folder)).expect("the corpus").flatten() {
            let text = std::fs::read_to_string(path.path()).unwrap_or_default();
            for code in text.split('[').filter_map(|piece| Some(piece.split_once(']')?.0)) {
                let Ok(facts) = Checker::default().check(code) else { continue };
                let wanted: BTreeSet<&str> =
                    facts.reads.iter().chain(&facts.writes).map(|found| &*found.name).collect();
                let found = words(code).into_iter().filter(|word| word.is_free);
                let found: BTreeSet<&str> = found.map(|word| &code[word.token.range]).collect();
                assert_eq!(found, wanted, "{code}");
                checked += 1;
            }
        }
    }
    assert!(checked > 300, "only {checked} blocks");
}

/// Each free name gets one of its own: then the compiler has to find exactly those.
fn told_apart(code: &str) -> (String, BTreeSet<String>) {
    let (mut text, mut names, mut copied) = (String::new(), BTreeSet::new(), 0);
    for word in words(code).into_iter().filter(|word| word.is_free) {
        let name = format!("free{}", word.token.range.start);
        text += &code[copied..word.token.range.start];
        text += &name;
        copied = word.token.range.end;
        names.insert(name);
    }
    (text + &code[copied..], names)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn each_place_is_what_the_compiler_makes_of_it(numbers in prop::collection::vec(any::<u32>(), 10..150)) {
        let code = piece(&mut Choices::new(&numbers));
        if Checker::default().check(&code).is_ok() {
            let (text, names) = told_apart(&code);
            let facts = Checker::default().check(&text);
            prop_assert!(facts.is_ok(), "{facts:?}\n{code}\n{text}");
            let facts = facts.unwrap_or_default();
            let found: BTreeSet<String> = facts.reads.into_iter().chain(facts.writes).map(|it| it.name).collect();
            prop_assert_eq!(found, names, "{}\n{}", code, text);
        }
    }
}

#[test]
fn most_random_pieces_are_lua() {
    let mut random = 1u32;
    let mut numbers = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        random >> 8
    };
    let is_lua = |numbers: Vec<u32>| Checker::default().check(&piece(&mut Choices::new(&numbers))).is_ok();
    let fine = (0..100).filter(|_| is_lua((0..80).map(|_| numbers()).collect())).count();
    assert!(fine > 40, "only {fine} of 100");
}
