//! What holds for every Lua there is: a block ends where Lua says that it does, and the same code laid out anew is the same.

use lrp::lua::Checker;
use lrp::syntax::ast::{Form, MachineItem, StateItem};
use lrp::syntax::lua_tokens::{same_code, tokens};
use lrp::syntax::{FileId, Source, parse};

pub fn check(code: &str, checker: &mut Checker) {
    tokens_lie_in_order(code);
    if checker.check(code).is_ok() && is_readable(code) {
        ends_where_lua_says(code);
        assert!(same_code(code, &format!("\n{code}\n")), "{code:?}");
    }
}

fn tokens_lie_in_order(code: &str) {
    let mut at = 0;
    for token in tokens(code) {
        assert!(token.range.start >= at && token.range.end > token.range.start, "{code:?}");
        assert!(code.get(token.range.clone()).is_some(), "{code:?}");
        at = token.range.end;
    }
}

/// Some of what Lua takes is refused in the text of a program: control characters, brackets without end.
fn is_readable(code: &str) -> bool {
    let plain = code.chars().all(|c| !c.is_control() || matches!(c, '\n' | '\r' | '\t')) && !code.contains('\u{feff}');
    plain && code.matches(['(', '[', '{']).count() < 90
}

fn ends_where_lua_says(code: &str) {
    // What ends with a comment needs a line's end before the bracket, as `]` would be part of the comment.
    let text = format!("(machine m (state s (running [{code}\n]))) (spawn m s)");
    let source = Source::new("a.lrp", &*text);
    let parsed = parse(&source, FileId(0));
    let block = parsed.tree.forms.iter().find_map(|form| match form {
        Form::Machine(machine) => machine.items.iter().find_map(|item| match item {
            MachineItem::State(state) => state.items.iter().find_map(|item| match item {
                StateItem::Running(block) => Some(block.text.to_string()),
                _ => None,
            }),
            _ => None,
        }),
        _ => None,
    });
    assert_eq!(block.as_deref(), Some(&*format!("{code}\n")), "{text:?}: {:?}", parsed.diagnostics);
    assert_eq!(parsed.diagnostics, [], "{text:?}");
}
