//! Which element of one program is which of the next: a name that is changed throughout is one rename and nothing else,
//! whatever the program, and in a large one that is found out in no time.

use std::fmt::Write;
use std::time::{Duration, Instant};

use lrp::model::change::{Change, Op};
use lrp::model::diff::diff;
use lrp::model::{ElementId, Kind, Matching, Program};
use lrp::session::compile::Compiler;
use lrp::syntax::Source;
use lrp::syntax::lua_tokens::{TokenKind, tokens};
use proptest::prelude::*;

use crate::plot::{Choices, Plot};

fn compiled(text: &str) -> Program {
    match Compiler::new(Vec::new()).compile(Source::new("case.lrp", text)) {
        Ok(program) => program,
        Err(rejected) => panic!("{:?}\n{text}", rejected.diagnostics),
    }
}

/// With one name changed wherever it stands as a word. The names of a plot have the form of Lua's.
fn renamed(text: &str, name: &str, new: &str) -> String {
    let mut changed = String::new();
    let mut copied = 0;
    for token in tokens(text).filter(|token| token.kind == TokenKind::Name && text[token.range.clone()] == *name) {
        changed += &text[copied..token.range.start];
        changed += new;
        copied = token.range.end;
    }
    changed + &text[copied..]
}

fn elements(program: &Program) -> Vec<ElementId> {
    [Kind::Machine, Kind::State, Kind::Event, Kind::Var].into_iter().flat_map(|kind| program.all(kind)).collect()
}

fn check(numbers: &[u32]) -> Result<(), TestCaseError> {
    let choices = &mut Choices::new(numbers);
    let plot = Plot::draw(choices);
    let old = compiled(&plot.text());
    let Some(&element) = choices.of(&elements(&old)) else { return Ok(()) };
    let name = old.name(element);
    let text = renamed(&plot.text(), name, "fresh");
    let new = compiled(&text);
    let matching = Matching::of(&old, &new);
    let changes = diff(&old, &new, &matching);
    prop_assert!(
        matches!(&*changes, [Change { op: Op::Renamed, path, .. }] if path == old.path(element)),
        "{name}: {changes:?}\n{}\n{text}",
        plot.text()
    );
    prop_assert!(elements(&old).into_iter().all(|was| matching.now(was).is_some()));
    prop_assert!(
        (0..old.transitions.len() as u32).all(|id| matching.transition(lrp::model::TransitionId(id)).is_some())
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_name_changed_throughout_is_one_rename(numbers in prop::collection::vec(any::<u32>(), 40..300)) {
        check(&numbers)?;
    }
}

/// 50 machines of 20 states with three blocks each, and a ring of transitions.
fn large() -> String {
    let mut text = String::new();
    for machine in 0..50 {
        let _ = writeln!(text, "(machine machine{machine} (var count{machine} := [0])");
        for state in 0..20 {
            let next = (state + 1) % 20;
            let _ = writeln!(
                text,
                "(state s{machine}_{state} (onentry [count{machine} = {state}]) (running [count{machine} = count{machine} + 1])
                (onexit [log.info(count{machine}, 'leaves', {state})]))
                (on [count{machine} > 10] s{machine}_{state} -> s{machine}_{next})"
            );
        }
        let _ = writeln!(text, ") (spawn machine{machine} s{machine}_0)");
    }
    text
}

/// Many ways between two states, half of them equal.
fn crowded(limit: usize) -> Program {
    let ways: String = (0..4000).map(|way| format!("(on [n > {}] a -> b)\n", way / 2 * limit)).collect();
    compiled(&format!("(var n := [0]) (machine m (state a) (state b)\n{ways}) (spawn m a)"))
}

#[test]
fn many_transitions_of_one_machine_are_named_in_no_time() {
    let (old, new) = (crowded(1), crowded(3));
    let start = Instant::now();
    let changes = diff(&old, &new, &Matching::of(&old, &new));
    let names = lrp::model::transition_names::TransitionNames::of(&new);
    assert_eq!(names.called("m: on [n > 3] a -> b #2"), Some(lrp::model::TransitionId(3)));
    // Every third limit stays.
    assert_eq!(changes.len(), 2 * (4000 - 1334));
    assert!(start.elapsed() < Duration::from_millis(500), "{:?}", start.elapsed());
}

#[test]
fn a_first_program_is_compared_with_nothing() {
    let (before, program) = (std::sync::Arc::default(), crowded(1));
    let edit = lrp::model::Edit::of(&before, program);
    assert_eq!(edit.comparison(&before).changes, []);
}

#[test]
fn a_large_program_is_compared_in_no_time() {
    let text = large();
    let old = compiled(&text);
    let mut everything = text.clone();
    for machine in 0..50 {
        everything = renamed(&everything, &format!("machine{machine}"), &format!("robot{machine}"));
        everything = renamed(&everything, &format!("count{machine}"), &format!("number{machine}"));
    }
    for (what, text, changes) in [
        ("nothing", text.clone(), 0),
        ("one state", renamed(&text, "s7_3", "elsewhere"), 1),
        ("all machines and variables", everything, 100),
        ("all layout", text.replace(" = ", "="), 0),
    ] {
        let new = compiled(&text);
        let times = (0..5).map(|_| {
            let start = Instant::now();
            let matching = Matching::of(&old, &new);
            let found = diff(&old, &new, &matching);
            assert_eq!(found.len(), changes, "{what}: {:?}", found.first());
            start.elapsed()
        });
        let best = times.min().unwrap_or_default();
        assert!(best < Duration::from_millis(250), "{what}: {best:?}");
    }
}
