//! A mistake in one block costs that block alone, also among others that are called together with it.

use std::time::Duration;

use lrp::lua::{Checker, Limits};
use lrp::model::resolve;
use lrp::runtime::{Command, Engine, Options, Time, What};
use lrp::syntax::{FileId, Source, parse};

/// A program in which blocks may run for 20 ms.
fn started(text: &str) -> Engine {
    let source = Source::new("isolation.lrp", text);
    let parsed = parse(&source, FileId(0));
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    let program = resolve(&parsed.tree, source, &[], &mut Checker::default());
    let limits = Limits { time: Duration::from_millis(20), ..Limits::default() };
    let mut engine = Engine::new(Options { limits, ..Options::default() });
    engine.command(Command::Load(program.into())).expect("it loads");
    engine
}

fn step(engine: &mut Engine) {
    engine.step(engine.now() + Time(100_000), &[]);
}

/// What went wrong since the last call, as code and line, and what was logged, in order.
fn said(engine: &mut Engine) -> Vec<String> {
    let mut said = Vec::new();
    engine.drain(|record| match record.what {
        What::Error(fault) => said.push(format!("{}:{}", fault.code, fault.line)),
        What::Log(log) => said.push(format!("{}:{}", log.message, log.line)),
        _ => {}
    });
    said
}

#[test]
fn a_guard_behind_one_that_fails_is_tried() {
    let mut engine = started(
        "(machine m (state a) (state b)
           (on [log.info('first') return false] a -> a)
           (on [log.info('second') error('bad')] a -> a)
           (on [3] a -> a)
           (on [true] a -> b)
           (on [error('not reached')] a -> b))
         (spawn m a)",
    );
    step(&mut engine);
    assert_eq!(engine.active(), ["m/b"]);
    assert_eq!(said(&mut engine), ["first:2", "second:3", "runtime-error:3", "not-boolean:4"]);
}

#[test]
fn an_action_behind_one_that_fails_is_run() {
    let mut engine = started(
        "(var n := [0])
         (machine m
           (state a (onentry [n = 1]) (onentry [n = n + 10 error('bad')]) (onentry [n = n + 100])
                    (running [error('one')])
                    (running [error('two')])))
         (spawn m a)",
    );
    assert_eq!(engine.value("n"), Some(111.into()));
    assert_eq!(said(&mut engine), ["runtime-error:3", "runtime-error:4", "runtime-error:5"]);
}

#[test]
fn a_runaway_is_stopped_and_left_out_where_others_go_on() {
    let mut engine = started(
        "(var n := [0])
         (machine m
           (event slow [while true do end])
           (state a (running [n = n + 1]) (running [while true do end]) (running [n = n + 1]))
           (state b)
           (on slow a -> b) (on [false] a -> b) (on slow a -> b) (on [n == 6] a -> b))
         (spawn m a)",
    );
    assert_eq!(engine.value("n"), Some(2.into()));
    assert_eq!(said(&mut engine), ["over-time:3", "over-time:4"]);
    step(&mut engine);
    step(&mut engine);
    assert_eq!((engine.value("n"), engine.active()), (Some(6.into()), vec!["m/a".to_owned()]));
    step(&mut engine);
    assert_eq!(engine.active(), ["m/b"]);
    assert_eq!(said(&mut engine), [""; 0]);
}

#[test]
fn an_outer_event_counts_from_its_own_machine_among_the_inner_ones_guards() {
    let mut engine = started(
        "(machine outer
           (event late [elapsed() >= 300])
           (state o
             (machine inner (state i) (state j) (state k)
               (on [elapsed() >= 200] i -> j)
               (on [elapsed() >= 1000] j -> i) (on late j -> k) (on [elapsed() >= 100] j -> i))
             (onentry (spawn inner i))))
         (spawn outer o)",
    );
    for active in ["i", "j", "k"] {
        step(&mut engine);
        assert_eq!(engine.active(), ["outer/o".to_owned(), format!("outer/o/inner/{active}")]);
    }
}
