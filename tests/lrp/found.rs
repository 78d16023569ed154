//! What fuzzing has found so far stays mended: every file of tests/fuzz/found goes through its target's check.

use std::path::Path;

use lrp::lua::Checker;

use crate::syntax::{any_block, any_text};
use crate::walk::walk_by_bytes;

fn each(target: &str, mut check: impl FnMut(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/found").join(target);
    let mut files = 0;
    for entry in folder.read_dir().expect("the folder is there") {
        let path = entry.expect("it can be read").path();
        check(&std::fs::read(&path).expect("it can be read"));
        files += 1;
    }
    assert!(files > 0, "{} is empty", folder.display());
}

#[test]
fn texts() {
    each("texts", |bytes| any_text::check(&String::from_utf8_lossy(bytes)));
}

#[test]
fn blocks() {
    let mut checker = Checker::default();
    each("blocks", |bytes| any_block::check(&String::from_utf8_lossy(bytes), &mut checker));
}

#[test]
fn edits() {
    each("edits", |bytes| {
        walk_by_bytes(bytes).unwrap_or_else(|wrong| panic!("{wrong}"));
    });
}
