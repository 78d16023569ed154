//! The bridge that docs/bridges.md shows, run as it is printed there.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::{Run, plugins};

fn example(folder: &Path) {
    let page = fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/bridges.md")).expect("the page");
    let (_, text) = page.split_once("```python\n").expect("an example");
    let (script, _) = text.split_once("```").expect("its end");
    assert!(script.lines().count() <= 60, "an example is short");
    let path = folder.join("lrp-bridge-lamp.py");
    fs::write(&path, script).expect("a script");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("a script to run");
}

#[test]
fn a_bridge_in_python() {
    if lrp_peers::program("python3").is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    example(folder.path());
    let program = "(bridge robot lamp)
        (var blinked := [0])
        (var call := [robot.blink(3)])
        (machine m
          (state dark (onentry [robot.switch{ on = true }]))
          (state light (running [if call.done then blinked = call.value end]))
          (on [robot.lamp ~= nil and robot.lamp.on] dark -> light))
        (spawn m dark)";
    let mut run = Run::start(program, folder.path().into(), plugins(vec![folder.path().into()]));
    run.step_until("light", |run| run.driver.engine().active() == ["m/light"]);
    run.step_until("an answer", |run| run.value("blinked") == Some(json!(6)));
    assert!(run.losses().is_empty(), "{:?}", run.losses());
}
