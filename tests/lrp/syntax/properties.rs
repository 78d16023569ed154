//! What holds for every text whatever, program or not.

use std::time::{Duration, Instant};

use lrp::syntax::lua_tokens::{same_code, tokens};
use lrp::syntax::parser::MAX_BYTES;
use lrp::syntax::{Code, FileId, Source, parse};
use proptest::prelude::*;
use proptest::sample::{Index, select};

use super::any_text::check;
use super::corpus::programs;

/// Texts made of what programs are made of, and a few things they aren't.
fn texts() -> impl Strategy<Value = String> {
    let words = [
        "(",
        ")",
        "(",
        ")",
        "[",
        "]",
        "[[",
        "]]",
        "{",
        "}",
        "->",
        "*",
        ":=",
        ";",
        "--",
        "--[[",
        "\"",
        "'",
        "\\",
        " ",
        " ",
        "\n",
        "\n  ",
        "\r",
        "\r\n\t",
        "a",
        "b",
        "-",
        "500",
        "-1.5",
        "machine ",
        "(machine m",
        "(state s",
        "(on e a->b",
        "(var x := [1]",
        "(onentry",
        "(spawn m s",
        "(event e",
        "running",
        "exit",
        "é",
        "状",
        "\u{301}",
        "😀",
        "\u{200b}",
        "\u{feff}",
        "\0",
        "→",
        "\u{a0}",
    ];
    let odd = any::<char>().prop_map(String::from);
    let word = prop_oneof![9 => select(words.to_vec()).prop_map(String::from), 1 => odd];
    prop::collection::vec(word, 0..60).prop_map(|words| words.concat())
}

/// Programs of the corpus with slices deleted, doubled and moved.
fn mutations() -> impl Strategy<Value = String> {
    let texts: Vec<String> = programs("ok").into_iter().map(|(_, source)| source.text.to_string()).collect();
    let change = (any::<Index>(), 0usize..40, any::<Index>(), 0u8..3);
    (select(texts), prop::collection::vec(change, 1..6)).prop_map(|(text, changes)| {
        let mut chars: Vec<char> = text.chars().collect();
        for (from, length, to, kind) in changes {
            if chars.is_empty() {
                break;
            }
            let from = from.index(chars.len());
            let slice = chars[from..(from + length).min(chars.len())].to_vec();
            if kind != 0 {
                let to = to.index(chars.len());
                chars.splice(to..to, slice.iter().copied());
            }
            if kind != 1 && from + slice.len() <= chars.len() {
                chars.drain(from..from + slice.len());
            }
        }
        chars.into_iter().collect()
    })
}

/// The same tokens with other white space and comments between them.
fn laid_out_anew(code: &str) -> String {
    let mut out = String::from("-- begin\n");
    for token in tokens(code) {
        out.push_str(&code[token.range]);
        out.push_str(" --[[ ] ]]\n\t");
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_parsed(text in texts()) {
        check(&text);
    }

    #[test]
    fn any_damaged_program_is_parsed(text in mutations()) {
        check(&text);
    }

    #[test]
    fn any_characters_are_parsed(text in any::<String>()) {
        check(&text);
    }

    #[test]
    fn tokens_tile_any_code(code in texts()) {
        let mut at = 0;
        for token in tokens(&code) {
            prop_assert!(token.range.start >= at && token.range.end > token.range.start);
            prop_assert!(code[at..token.range.start].chars().all(|c| c.is_ascii_whitespace() || c == '\x0b'));
            at = token.range.end;
        }
        prop_assert!(code[at..].chars().all(|c| c.is_ascii_whitespace() || c == '\x0b'));
    }

    #[test]
    fn same_code_looks_through_layout(code in texts()) {
        prop_assert!(same_code(&code, &code));
        // What is cut off at the end of its line or of the text has no layout to change.
        let closed = tokens(&code).all(|token| !code[token.range].starts_with(['"', '\'', '[', '-', '\\']));
        if closed {
            prop_assert!(same_code(&code, &laid_out_anew(&code)), "{:?}", laid_out_anew(&code));
        }
        let longer = format!("x {code}");
        prop_assert!(!same_code(&code, &longer));
    }
}

/// Each of these took a time that grows with the square of its length in some parser.
#[test]
fn hard_texts_take_no_time() {
    let n = 100_000;
    let texts = [
        "(".repeat(n),
        ")".repeat(n),
        "[".repeat(n),
        "]".repeat(n),
        "{".repeat(n),
        "(".repeat(n) + &")".repeat(n),
        "[".repeat(n) + &"]".repeat(n),
        "(var x := [".repeat(n),
        "(var x := [\n".repeat(n),
        "(running [x)\n".repeat(n),
        "(running [(\n".repeat(n),
        format!("[{}{}", "{".repeat(n), ")".repeat(n)),
        format!("[{}{}", "(".repeat(n), "]".repeat(n)),
        "(machine m\n(state s\n".repeat(n),
        "(machine m (state s ".repeat(n),
        " (state a)\n".repeat(n),
        "\"".repeat(n),
        "'\n".repeat(n),
        "[[=[".repeat(n),
        "(on e ".to_string() + &"(a) ".repeat(n),
        "(on e ".to_string() + &"a ".repeat(n),
        "(state ".to_string() + &"a/".repeat(n),
        "-".repeat(n),
        "\t\n ".repeat(n),
        format!("[{}", "--[[ ]] \n (state a".repeat(n)),
        format!("(machine m\n{})", "  (state s)\n  (eps s->s)\n".repeat(n / 2)),
    ];
    for text in texts {
        let begun = Instant::now();
        check(&text);
        let taken = begun.elapsed();
        assert!(taken < Duration::from_secs(5), "{taken:?} for {}", &text[..20]);
    }
}

#[test]
fn brackets_nested_too_deep_are_one_finding() {
    let n = 10_000;
    let closed = |open: &str, close: &str| open.repeat(n) + &close.repeat(n);
    let texts = [
        "(".repeat(n),
        closed("(", ")"),
        closed("(machine m (state s ", "))"),
        "(machine m (state s ".repeat(n),
        format!("(var x := [{}])", closed("(", ")")),
        format!("(var x := [{}])", closed("{", "}")),
        format!("(var x := [{}])", closed("[ ", "]")),
        format!("(var x := [{}", "(".repeat(n)),
        format!("(var x := [{}", "[ ".repeat(n)),
        format!("(var x := [{}", "{".repeat(n)),
    ];
    for text in texts {
        let parsed = parse(&Source::new("a.lrp", &*text), FileId(0));
        let codes: Vec<Code> = parsed.diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
        assert_eq!(codes, [Code::NestedTooDeep], "{}", &text[..30]);
    }
}

#[test]
fn a_text_of_the_largest_size_is_read_and_a_larger_one_refused() {
    let line = "(var x := [1])\n";
    let largest = line.repeat(MAX_BYTES / line.len());
    let parsed = parse(&Source::new("a.lrp", &*largest), FileId(0));
    assert_eq!((parsed.tree.forms.len(), parsed.diagnostics.len()), (MAX_BYTES / line.len(), 0));

    let larger = largest + line + line;
    let parsed = parse(&Source::new("a.lrp", &*larger), FileId(0));
    assert_eq!(parsed.tree.forms.len(), 0);
    assert_eq!(parsed.diagnostics.iter().map(|diagnostic| diagnostic.code).collect::<Vec<_>>(), [Code::TooLarge]);
}
