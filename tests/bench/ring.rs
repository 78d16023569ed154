//! The ring benchmark of the language's documents: five states, each with four guards that are false and are tried first,
//! and one that goes round. The engine, headless and as fast as it can, against a plain Lua loop that calls the same
//! closures in the same order, in the same run. Prints nanoseconds for each change of state, and their ratio.

mod timing;

use std::fmt::Write;
use std::time::Duration;

use lrp::model::{Program, resolve};
use lrp::runtime::{Command, Engine, Options, Time};
use lrp::syntax::{FileId, Source, parse};

use timing::{best, median, timed};

const CHANGES: u32 = 200_000;
const ROUNDS: usize = 15;
const STATES: usize = 5;

fn main() {
    println!("ring: {STATES} states, 7 Lua calls a change; best and median of {ROUNDS} rounds of {CHANGES} changes\n");
    let mut plain = Vec::new();
    let mut isolated = Vec::new();
    let mut engine = Vec::new();
    let mut recorded = Vec::new();
    let lua = mlua::Lua::new();
    let loop_once: mlua::Function = lua.load(plain_loop(Calls::Bare)).eval().expect("the plain loop is Lua");
    let isolated_once: mlua::Function = lua.load(plain_loop(Calls::Isolated)).eval().expect("the plain loop is Lua");
    let mut bare = started(&ring(0));
    let mut told = started(&ring(0));
    // Side by side, so that a noisy machine disturbs all alike.
    for _ in 0..ROUNDS {
        plain.push(timed(|| loop_once.call::<()>(CHANGES).expect("the plain loop runs")));
        isolated.push(timed(|| isolated_once.call::<()>(CHANGES).expect("the plain loop runs")));
        engine.push(timed(|| steps(&mut bare, Engine::discard_records)));
        recorded.push(timed(|| steps(&mut told, |engine| engine.drain(|record| drop(std::hint::black_box(record))))));
    }
    let floor = best(&plain);
    report("plain Lua loop", &plain, floor);
    report("plain Lua loop, each call in pcall", &isolated, floor);
    report("engine, records dropped", &engine, floor);
    report("engine, records spelled out", &recorded, floor);
    println!();
    let mut large = started(&ring(1_000));
    let many: Vec<Duration> = (0..ROUNDS).map(|_| timed(|| steps(&mut large, Engine::discard_records))).collect();
    report("engine, among 1,000 other states", &many, floor);
    let mut idle = started(&idle());
    let idling: Vec<Duration> = (0..ROUNDS).map(|_| timed(|| steps(&mut idle, Engine::discard_records))).collect();
    report("engine, one timer, nothing happens", &idling, floor);
}

fn report(what: &str, rounds: &[Duration], floor: Duration) {
    let (best, median) = (best(rounds), median(rounds));
    let each = |time: Duration| time.as_nanos() as f64 / f64::from(CHANGES);
    let ratio = best.as_secs_f64() / floor.as_secs_f64();
    println!("{what:36} {:7.1} ns  (median {:7.1})   x{ratio:.2}", each(best), each(median));
}

fn steps(engine: &mut Engine, after: impl Fn(&mut Engine)) {
    for _ in 0..CHANGES {
        let now = engine.now() + Time(1000);
        engine.step(now, &[]);
        after(engine);
    }
}

fn started(program: &str) -> Engine {
    let mut engine = Engine::new(Options::default());
    engine.command(Command::Load(compiled(program).into())).expect("the ring loads");
    engine.discard_records();
    engine
}

fn compiled(text: &str) -> Program {
    let source = Source::new("ring.lrp", text);
    let parsed = parse(&source, FileId(0));
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    let program = resolve(&parsed.tree, source, &[], &mut lrp::lua::Checker::default());
    assert!(program.findings.iter().all(|finding| !finding.is_error()), "{:?}", program.findings);
    program
}

/// The ring, and beside it a machine of states that never run.
fn ring(others: usize) -> String {
    let mut text = String::from("(var laps := [0])\n(machine ring\n");
    for from in 0..STATES {
        let entry = if from == 0 { "laps = laps + 1".to_string() } else { format!("{from}") };
        writeln!(text, "  (state s{from} (onentry [{entry}]) (onexit [{from}]))").expect("a String takes text");
        for to in (0..STATES).filter(|&to| to != from) {
            writeln!(text, "  (on [false] s{from} -> s{to})").expect("a String takes text");
        }
        writeln!(text, "  (on [true] s{from} -> s{})", (from + 1) % STATES).expect("a String takes text");
    }
    text.push_str(")\n(spawn ring s0)\n");
    if others > 0 {
        text.push_str("(machine others\n");
        for state in 0..others {
            writeln!(text, "  (state o{state} (running [{state}])) (on [false] o{state} -> o0)")
                .expect("a String takes text");
        }
        text.push_str(")\n");
    }
    text
}

fn idle() -> String {
    "(machine m (state a) (state b) (ontime 1000000000 a -> b))\n(spawn m a)\n".to_string()
}

/// What a mistake in one closure costs.
#[derive(Clone, Copy)]
enum Calls {
    /// The whole loop.
    Bare,
    /// That one closure, as in the engine.
    Isolated,
}

/// The same closures as the ring's blocks, called in the same order.
fn plain_loop(calls: Calls) -> String {
    let mut text = String::from("local laps = 0\nlocal guards, onentry, onexit = {}, {}, {}\n");
    for state in 0..STATES {
        let entry = if state == 0 { "laps = laps + 1".to_string() } else { format!("return {state}") };
        let no = "function() return false end, ".repeat(STATES - 1);
        writeln!(text, "guards[{state}] = {{ {no}function() return true end }}").expect("a String takes text");
        writeln!(text, "onentry[{state}] = function() {entry} end").expect("a String takes text");
        writeln!(text, "onexit[{state}] = function() return {state} end").expect("a String takes text");
    }
    let (test, exit, enter) = match calls {
        Calls::Bare => ("if list[i]() then break end", "onexit[state]()", "onentry[state]()"),
        Calls::Isolated => (
            "local ok, holds = pcall(list[i]) if ok and holds then break end",
            "pcall(onexit[state])",
            "pcall(onentry[state])",
        ),
    };
    writeln!(
        text,
        "return function(changes)
           local state = 0
           for _ = 1, changes do
             local list = guards[state]
             for i = 1, #list do
               {test}
             end
             {exit}
             state = (state + 1) % {STATES}
             {enter}
           end
         end"
    )
    .expect("a String takes text");
    text
}
