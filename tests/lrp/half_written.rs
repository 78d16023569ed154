//! Files that are being written while another file of the program is saved, on a real disk: the program is never left
//! with a half.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use serde_json::Value;

use crate::binary::Running;

/// A file in its writer's hands.
struct Open(File);

impl Open {
    /// Cuts the file off and writes the beginning of its new text.
    fn begin(folder: &Path, name: &str, text: &str) -> Open {
        let open = Open(File::create(folder.join(name)).unwrap());
        open.write(text);
        open
    }

    fn write(&self, text: &str) {
        (&self.0).write_all(text.as_bytes()).unwrap();
    }

    /// The next load, with more written at every record until then: the writer is never still.
    fn load_meanwhile(&self, running: &Running, more: &str) -> Value {
        running.wait_for("load", |record| {
            self.write(more);
            record["kind"] == "load"
        })
    }
}

fn save(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

fn text<'r>(load: &'r Value, name: &str) -> &'r str {
    let file = load["files"].as_array().unwrap().iter().find(|file| file["name"] == name);
    file.unwrap_or_else(|| panic!("{name} in {load}"))["text"].as_str().unwrap()
}

fn loads_with(running: &Running, name: &str, wanted: &str) {
    running.wait_for(wanted, |record| record["kind"] == "load" && text(record, name) == wanted);
}

fn ends(running: Running) {
    running.signal(libc::SIGTERM);
    let (code, _, err) = running.end();
    assert_eq!(code, Some(0), "{err}");
}

const MAIN: &str = "(import \"lib.lrp\")\n(machine m (state a (running [log.info('goes on')])))\n(spawn m a)\n";
const OTHER: &str = "(machine other (state q)) (export other)\n";

#[test]
fn of_a_file_that_is_being_written_its_last_text_counts() {
    let lua = "(var x := [require('lib').x])\n(machine m (state a (running [log.info(x)])))\n(spawn m a)\n";
    let sub = format!("{OTHER}(machine sub (var k := [0]) (state s (running [k = k + 1]))) (export sub)\n");
    let sub_main = format!("{MAIN}(spawn sub s)\n");
    let cases = [
        ("lib.lrp", sub_main.as_str(), sub.as_str(), OTHER, "; more\n"),
        ("lib.lua", lua, "return { x = 1 }\n", "return { x = 2 }\n", "-- more\n"),
    ];
    for (name, main, whole, half, more) in cases {
        let folder = tempfile::tempdir().unwrap();
        save(folder.path(), name, whole);
        save(folder.path(), "p.lrp", main);
        let running = Running::start(folder.path(), &["p.lrp"]);
        running.wait_for_kind("log");
        let open = Open::begin(folder.path(), name, half);
        save(folder.path(), "p.lrp", &format!("{main}; saved too\n"));
        let load = open.load_meanwhile(&running, more);
        assert_eq!((text(&load, name), &load["restarted"]), (whole, &false.into()));
        open.write(if name == "lib.lrp" { "(machine third (state t)) (export third)\n" } else { "" });
        drop(open);
        let written = fs::read_to_string(folder.path().join(name)).unwrap();
        loads_with(&running, name, &written);
        // Written anew with the text it has.
        let open = Open::begin(folder.path(), name, half);
        save(folder.path(), "p.lrp", main);
        assert_eq!(text(&open.load_meanwhile(&running, more), name), written);
        save(folder.path(), name, &written);
        drop(open);
        save(folder.path(), "p.lrp", &format!("{main}; and again\n"));
        assert_eq!(text(&running.wait_for_kind("load"), name), written);
        ends(running);
    }
}

#[test]
fn a_file_that_is_first_read_while_it_is_written_is_followed_by_its_whole_text() {
    let folder = tempfile::tempdir().unwrap();
    let whole = format!("{OTHER}; the end\n");
    save(folder.path(), "lib.lrp", &whole);
    save(folder.path(), "p.lrp", MAIN);
    let running = Running::start(folder.path(), &["p.lrp"]);
    running.wait_for_kind("log");
    fs::remove_file(folder.path().join("lib.lrp")).unwrap();
    running.wait_for_kind("reject");
    let open = Open::begin(folder.path(), "lib.lrp", OTHER);
    save(folder.path(), "p.lrp", &format!("{MAIN}; saved too\n"));
    loads_with(&running, "lib.lrp", OTHER);
    // Whole, it is what it was before it went.
    open.write("; the end\n");
    drop(open);
    loads_with(&running, "lib.lrp", &whole);
    ends(running);
}
