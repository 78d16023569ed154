//! Blocks called in one round: each on its own all the same.

use std::time::{Duration, Instant};

use lrp::lua::{Access, Block, FailureKind, Limits, Lua, Ran, Test};
use serde_json::json;

use super::{compile, lua};

fn blocks(lua: &mut Lua, texts: &[&str]) -> Vec<Block> {
    texts.iter().map(|text| compile(lua, text)).collect()
}

#[test]
fn the_first_condition_that_is_not_false_ends_a_round() {
    let mut lua = lua();
    for (texts, wanted) in [
        (&["false", "1 > 2", "nil == 1"][..], None),
        (&["false", "true", "error('not reached')"], Some((1, Test::True))),
        (&["true", "false"], Some((0, Test::True))),
        (&["false", "3", "true"], Some((1, Test::NotBoolean("number")))),
        (&["false", "nil"], Some((1, Test::NotBoolean("nil")))),
        (&["false", "nil + 1", "true"], Some((1, Test::Failed))),
        (&["true"], Some((0, Test::True))),
        (&["false"], None),
        (&[], None),
    ] {
        let blocks = blocks(&mut lua, texts);
        assert_eq!(lua.test_all(&blocks), wanted, "{texts:?}");
    }
}

#[test]
fn a_round_goes_on_behind_a_block_that_failed() {
    let mut lua = lua();
    let n = lua.cell();
    let texts = ["n = 1", "n = n + 10 error('second')", "n = n + 100"];
    let blocks: Vec<Block> = texts.iter().map(|text| lua.compile(text, &[("n", n)]).unwrap()).collect();
    assert_eq!(lua.run_all(&blocks), Some(1));
    let failure = lua.take_failure();
    assert_eq!((failure.block, failure.message.as_str()), (Some(blocks[1]), "second"));
    assert_eq!(lua.get(n), json!(11));
    assert_eq!(lua.run_all(&blocks[2..]), None);
    assert_eq!(lua.get(n), json!(111));
}

#[test]
fn a_round_may_be_long() {
    let mut lua = lua();
    let no = compile(&mut lua, "false");
    let yes = compile(&mut lua, "true");
    let bad = compile(&mut lua, "error('x')");
    for before in [31, 32, 33, 64, 1_000] {
        let mut blocks = vec![no; before];
        assert_eq!(lua.test_all(&blocks), None, "{before}");
        blocks.push(yes);
        assert_eq!(lua.test_all(&blocks), Some((before, Test::True)));
        blocks[before] = bad;
        assert_eq!(lua.run_all(&blocks), Some(before));
    }
}

#[test]
fn each_block_of_a_round_has_its_own_time() {
    let limit = Duration::from_millis(500);
    let mut lua = Lua::new(Limits { time: limit, ..Limits::default() }, Access::Sandboxed, 7);
    // Far shorter than the limit: other tests keep the machine busy.
    let busy = calibrated(&mut lua, limit / 10);
    let start = Instant::now();
    assert_eq!(lua.run_all(&[busy; 24]), None);
    assert!(start.elapsed() > limit, "the round is longer than one block's time");
}

/// A block that takes about so long.
fn calibrated(lua: &mut Lua, wanted: Duration) -> Block {
    let mut turns = 10_000;
    loop {
        let block = compile(lua, &format!("local n = 0 for i = 1, {turns} do n = n + i % 7 end"));
        let start = Instant::now();
        assert_eq!(lua.run(block), Ran::Done);
        if start.elapsed() >= wanted {
            return block;
        }
        turns *= 2;
    }
}

#[test]
fn a_runaway_in_a_round_is_stopped_and_named() {
    let mut lua = lua();
    let blocks = blocks(&mut lua, &["local x = 1", "local x = 2\nwhile true do x = x + 1 end", "local x = 3"]);
    for _ in 0..3 {
        assert_eq!(lua.run_all(&blocks), Some(1));
        let failure = lua.take_failure();
        assert_eq!((failure.kind, failure.block, failure.line), (FailureKind::OverTime, Some(blocks[1]), 2));
        assert_eq!(lua.run_all(&blocks[2..]), None);
    }
}

#[test]
fn a_condition_that_runs_away_is_stopped_wherever_it_hides() {
    let mut lua = lua();
    let blocks = blocks(&mut lua, &["false", "while true do pcall(function() while true do end end) end", "true"]);
    assert_eq!(lua.test_all(&blocks), Some((1, Test::Failed)));
    assert_eq!(lua.take_failure().kind, FailureKind::OverTime);
    assert_eq!(lua.test_all(&blocks[2..]), Some((0, Test::True)));
}
