//! Random programs, edits, steps and commands, drawn from the bytes.
#![no_main]

#[path = "../../lrp/lines.rs"]
mod lines;
#[path = "../../lrp/picture.rs"]
mod picture;
#[path = "../../lrp/plot/mod.rs"]
mod plot;
#[path = "../../lrp/shelf.rs"]
mod shelf;
#[path = "../../lrp/stage.rs"]
mod stage;
#[path = "../../lrp/walk/mod.rs"]
mod walk;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(wrong) = walk::walk_by_bytes(bytes) {
        panic!("{wrong}");
    }
});
