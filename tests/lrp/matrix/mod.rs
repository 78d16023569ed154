//! Every kind of edit, wherever it may hit, in both modes: each done in the middle of a run by the engine and by a
//! small model of live edits that was written from the design alone, step by step beside each other.

mod base;
mod cell;
mod comparison;
mod edit;
mod operation;
mod outline;
mod pair;
mod renames;
mod running;
mod text;
mod tree;
mod uses;

use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use lrp::model::Program;
use lrp::runtime::OnEdit;

use cell::Cell;
use pair::{Pair, compiled};
use tree::Tree;

/// The edit comes at this time, ms.
const EDIT: i64 = 1000;
/// As long as it is watched afterwards.
const END: i64 = 2000;

fn run(cell: &Cell) -> Result<(), String> {
    let before = cell.before();
    let after = cell.after(before.clone());
    static BASE: OnceLock<Arc<Program>> = OnceLock::new();
    let program = match cell.begins_as_all() {
        true => Arc::clone(BASE.get_or_init(|| compiled(&before))),
        false => compiled(&before),
    };
    for mode in [OnEdit::Restart, OnEdit::Keep] {
        let one = run_one(cell, Pair::new(before.clone(), &program, mode)?, after.clone());
        one.map_err(|wrong| format!("{mode:?}: {wrong}"))?;
    }
    Ok(())
}

fn run_one(cell: &Cell, mut pair: Pair, after: Tree) -> Result<(), String> {
    pair.until(400)?;
    pair.go("solo/solo_off")?;
    pair.until(800)?;
    for machine in [cell.site.machine, "main", "side"] {
        pair.tune(&format!("{machine}_b"), 7000);
        pair.tune(&format!("g_{machine}"), 500);
    }
    pair.until(EDIT)?;
    pair.save(after)?;
    pair.until(EDIT + pair::PERIOD)?;
    pair.pause()?;
    pair.until(END)
}

#[test]
fn the_whole_matrix() {
    let (cells, senseless): (Vec<Cell>, Vec<Cell>) = cell::all().partition(|cell| cell.senseless().is_none());
    let next = AtomicUsize::new(0);
    let work = || {
        let mut failed = Vec::new();
        while let Some(cell) = cells.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(wrong) = run(cell) {
                failed.push((cell, wrong));
            }
        }
        failed
    };
    let failed: Vec<(&Cell, String)> = std::thread::scope(|scope| {
        let threads = [(); 2].map(|()| scope.spawn(work));
        threads.into_iter().flat_map(|thread| thread.join().expect("a cell panics")).collect()
    });
    let mut report = String::new();
    for (cell, wrong) in &failed {
        let wrong = wrong.split("\nbefore:").next().unwrap_or_default();
        let _ = writeln!(report, "{cell}: {wrong}");
    }
    if let Some((cell, wrong)) = failed.first() {
        panic!("{} of {} cells fail:\n{report}\nthe first: {cell}: {wrong}", failed.len(), cells.len());
    }
    // Each in both modes; none may vanish unseen.
    assert_eq!((cells.len(), senseless.len()), (1229, 1291));
}
