//! A step in which nothing happens allocates nothing, however large the program. A binary of its own, as it counts what the whole process allocates.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fmt::Write;

use lrp::model::{Program, resolve};
use lrp::runtime::{Command, Engine, Options, Time};
use lrp::syntax::{FileId, Source, parse};

/// Counts what this thread allocates.
struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends allocates too, when nothing is left to count with.
    let _ = COUNT.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn started(text: &str) -> Engine {
    let source = Source::new("idle.lrp", text);
    let parsed = parse(&source, FileId(0));
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    let program: Program = resolve(&parsed.tree, source, &[], &mut lrp::lua::Checker::default());
    assert!(program.findings.iter().all(|finding| !finding.is_error()), "{:?}", program.findings);
    let mut engine = Engine::new(Options::default());
    engine.command(Command::Load(program.into())).expect("it loads");
    engine
}

/// Allocations of Rust and of Lua in 100 steps, after some to get going.
fn allocations(engine: &mut Engine) -> usize {
    let mut steps = |count: u32| {
        for _ in 0..count {
            let now = engine.now() + Time(100_000);
            engine.step(now, &[]);
            engine.drain(drop);
        }
    };
    steps(10);
    let before = COUNT.get();
    steps(100);
    COUNT.get() - before
}

/// Machines that wait: for a time, for a condition, nested, among many states that are not active.
fn waiting(others: usize) -> String {
    let mut text = String::from(
        "(var x := [1]) (var t := [{1, 2}])
         (machine timer (state a) (state b) (ontime 1000000000 a -> b))
         (machine tested
           (event never [x > 2])
           (state a (running [local y = x]) (running [t[1] = 1])
             (machine inner (state i) (state j) (on [t[1] == 2] i -> j) (on never i -> j) (exit [elapsed() < 0] i -> b))
             (onentry (spawn inner i)))
           (state b) (on never a -> b) (on [x == 3] a -> b) (ontime [1e9 + x] a -> a) (on [false] a -> b))
         (spawn timer a)\n",
    );
    text.push_str("(spawn tested a)\n(machine others\n");
    for state in 0..others {
        writeln!(text, "(state o{state} (running [x = {state}])) (on [x == {state}] o{state} -> o0)").expect("text");
    }
    text.push_str(")\n");
    text
}

#[test]
fn a_step_in_which_nothing_happens_allocates_nothing() {
    for others in [0, 1_000] {
        assert_eq!(allocations(&mut started(&waiting(others))), 0, "among {others} states");
    }
}

#[test]
fn what_allocates_is_counted() {
    let busy = "(var x := [0]) (machine m (state a (running [x = x + 1]))) (spawn m a)";
    assert!(allocations(&mut started(busy)) >= 100);
}
