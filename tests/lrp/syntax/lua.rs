//! Lua's lexical rules, and guessing at names.

use lrp::syntax::lua_tokens::{TokenKind, same_code, tokens};
use lrp::syntax::nearest::nearest;

fn kinds(code: &str) -> String {
    let name = |kind| match kind {
        TokenKind::Name => "n",
        TokenKind::Keyword => "k",
        TokenKind::Number => "0",
        TokenKind::String => "s",
        TokenKind::UnclosedString => "S",
        TokenKind::Symbol => "",
        TokenKind::Comment => "c",
        TokenKind::UnclosedComment => "C",
        TokenKind::Unknown => "?",
    };
    let shown = |kind, text: &str| format!("{}{text}", name(kind));
    tokens(code).map(|token| shown(token.kind, &code[token.range])).collect::<Vec<_>>().join(" ")
}

#[test]
fn tokens_are_lua_s() {
    let cases = [
        ("local x<const> = y.end_", "klocal nx < nconst > = ny . nend_"),
        ("a..b...c", "na .. nb ... nc"),
        ("a//b>>1~=c::d", "na // nb >> 01 ~= nc :: nd"),
        ("1 0x1F 1e-3 0x.8p+2 .5 3x 1..2", "01 00x1F 01e-3 00x.8p+2 0.5 03x 01..2"),
        ("a-1-b", "na - 01 - nb"),
        (
            r#" 'it\'s' "a\\" "\z
           b" "#,
            "s'it\\'s' s\"a\\\\\" s\"\\z\n           b\"",
        ),
        ("'a\\\r\nb'", "s'a\\\r\nb'"),
        ("'open\nx", "S'open nx"),
        ("[[a]b]] [=[a]]b]=] [=x", "s[[a]b]] s[=[a]]b]=] [ = nx"),
        ("[[open", "S[[open"),
        ("x--[[a\nb]]y", "nx c--[[a\nb]] ny"),
        ("x--[a\ny", "nx c--[a ny"),
        ("--\ry", "c-- ny"),
        ("--[==[a]=]", "C--[==[a]=]"),
        ("x:=5", "nx : = 05"),
        ("a ! é", "na ?! ?é"),
        ("'\\", "S'\\"),
    ];
    for (code, expected) in cases {
        assert_eq!(kinds(code), expected, "{code}");
    }
}

#[test]
fn same_code_sees_through_layout_and_comments_only() {
    let same =
        [("", "  -- nothing\n"), ("x=1", " x = 1 --[[ now ]]\n"), ("f()\ng()", "f() g()"), ("[[a\r\nb]]", "[[a\nb]]")];
    let different = [
        ("x = 1", "x = 2"),
        ("a b", "ab"),
        ("a - -b", "a --b"),
        ("'a'", "'a '"),
        ("'a'", "\"a\""),
        ("1 .. 2", "1..2"),
        ("x", "x y"),
        ("[[a\n\nb]]", "[[a\nb]]"),
    ];
    for (a, b) in same {
        assert!(same_code(a, b), "{a:?} {b:?}");
    }
    for (a, b) in different {
        assert!(!same_code(a, b), "{a:?} {b:?}");
    }
}

#[test]
fn the_nearest_name_is_found() {
    let known = ["lookleft", "lookright", "moving", "end", "bumpback", "été"];
    let cases = [
        ("lokleft", Some("lookleft")),
        ("lookrigth", Some("lookright")),
        ("Moving", Some("moving")),
        ("mvoing", Some("moving")),
        ("edn", Some("end")),
        ("ends", Some("end")),
        ("ete", None),
        ("éte", Some("été")),
        ("bumpturn", None),
        ("x", None),
        ("", None),
        ("moving", None),
    ];
    for (wanted, expected) in cases {
        assert_eq!(nearest(wanted, known), expected, "{wanted}");
    }
    assert_eq!(nearest("ab", ["ba", "abc", "a"]), Some("ba"));
    assert_eq!(nearest("x", ["y"]), None);
    assert_eq!(nearest("nn", ["na", "n"]), None);
    assert_eq!(nearest("AB", ["ab"]), Some("ab"));
}
