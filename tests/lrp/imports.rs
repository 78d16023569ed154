//! A program of several files, as a process: which of them are watched, what is said of which, what checks and drawings
//! make of them.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::binary::{Running, lrp};

struct Files(tempfile::TempDir);

impl Files {
    fn with(files: &[(&str, &str)]) -> Files {
        let folder = Files(tempfile::tempdir().unwrap());
        files.iter().for_each(|(name, text)| folder.write(name, text));
        folder
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn remove(&self, name: &str) {
        fs::remove_file(self.path().join(name)).unwrap();
    }
}

/// A machine of this name, which says its name and a version in each step.
fn machine(name: &str, version: u32) -> String {
    format!("(export {name})\n(machine {name} (state s (running [log.info('{name} {version}')])))\n")
}

fn says(running: &Running, message: &str) -> Value {
    running.wait_for(message, |record| record["kind"] == "log" && record["message"] == message)
}

fn rejected(running: &Running) -> Value {
    running.wait_for_kind("reject")["findings"].get(0).cloned().unwrap_or_default()
}

fn names(load: &Value) -> Vec<&str> {
    load["files"].as_array().unwrap().iter().map(|file| file["name"].as_str().unwrap()).collect()
}

fn ends(running: Running) -> String {
    running.signal(libc::SIGTERM);
    let (code, _, err) = running.end();
    assert_eq!(code, Some(0), "{err}");
    err
}

const MAIN: &str = "(import \"../lib/one.lrp\")\n(spawn one s)\n";

#[test]
fn imported_files_are_watched_as_long_as_they_are_imported() {
    let two = "(import \"deep/two.lrp\")\n(export two)\n";
    let files = Files::with(&[
        ("robot/main.lrp", MAIN),
        ("lib/one.lrp", &machine("one", 0)),
        ("lib/deep/two.lrp", &machine("two", 0)),
    ]);
    let running = Running::start(files.path(), &["robot/main.lrp"]);
    assert_eq!(names(&running.wait_for_kind("load")), ["robot/main.lrp", "lib/one.lrp"]);
    assert_eq!(says(&running, "one 0")["file"], "lib/one.lrp");
    files.write("lib/one.lrp", &machine("one", 1));
    says(&running, "one 1");
    files.write("lib/one.lrp", &(two.to_string() + &machine("one", 1)));
    let load = running.wait_for_kind("load");
    assert_eq!(
        (&load["restarted"], names(&load)),
        (&false.into(), vec!["robot/main.lrp", "lib/one.lrp", "lib/deep/two.lrp"])
    );
    files.write("robot/main.lrp", &format!("{MAIN}(spawn two s)\n"));
    assert_eq!(says(&running, "two 0")["file"], "lib/deep/two.lrp");
    files.write("lib/deep/two.lrp", &machine("two", 1));
    says(&running, "two 1");
    // No longer imported, it is no longer anybody's business.
    files.write("robot/main.lrp", MAIN);
    files.write("lib/one.lrp", &machine("one", 2));
    says(&running, "one 2");
    files.write("lib/deep/two.lrp", "(machine");
    files.write("lib/one.lrp", &machine("one", 3));
    let told = running.wait_for("the next edit", |record| matches!(record["kind"].as_str(), Some("load" | "reject")));
    assert_eq!(told["kind"], "load");
    ends(running);
}

#[test]
fn a_missing_file_is_told_at_its_import_and_taken_over_once_it_is_there() {
    let files = Files::with(&[("main.lrp", &machine("one", 0)), ("lib/two.lrp", &machine("two", 0))]);
    files.write("main.lrp", &(machine("one", 0) + "(spawn one s)\n"));
    let running = Running::start(files.path(), &["main.lrp"]);
    says(&running, "one 0");
    files.write("main.lrp", &(machine("one", 0) + "(spawn one s)\n(import \"lib/too.lrp\")\n"));
    let finding = rejected(&running);
    assert_eq!(
        (&finding["code"], &finding["file"], &finding["line"], &finding["help"]),
        (&"unreadable-import".into(), &"main.lrp".into(), &4.into(), &"did you mean `lib/two.lrp`?".into())
    );
    says(&running, "one 0");
    files.write("lib/too.lrp", "(export three) (machine three");
    assert_eq!(rejected(&running)["file"], "lib/too.lrp");
    files.write("lib/too.lrp", &machine("three", 0));
    assert_eq!(names(&running.wait_for_kind("load")), ["main.lrp", "lib/too.lrp"]);
    ends(running);
}

#[test]
fn of_a_file_that_goes_it_is_said_once_and_the_program_goes_on() {
    let files = Files::with(&[("robot/main.lrp", MAIN), ("lib/one.lrp", &machine("one", 0))]);
    let running = Running::start(files.path(), &["robot/main.lrp"]);
    says(&running, "one 0");
    files.remove("lib/one.lrp");
    let finding = rejected(&running);
    assert_eq!((&finding["file"], &finding["severity"]), (&"lib/one.lrp".into(), &"warning".into()));
    says(&running, "one 0");
    // Its importer can't be taken over without it, not even unchanged in meaning.
    files.write("robot/main.lrp", &format!("{MAIN}; a comment\n"));
    assert_eq!(rejected(&running)["code"], "unreadable-import");
    says(&running, "one 0");
    files.write("lib/one.lrp", &machine("one", 0));
    assert_eq!(running.wait_for_kind("load")["restarted"], false);
    files.write("lib/one.lrp", &machine("one", 1));
    says(&running, "one 1");
    let err = ends(running);
    assert_eq!(err.matches("the file is gone").count(), 1, "{err}");
}

#[test]
fn required_files_are_part_of_the_program() {
    let main =
        "(var x := [require('values').x])\n(machine m (state s (running [log.info('x is ' .. x)])))\n(spawn m s)\n";
    let files = Files::with(&[
        ("main.lrp", main),
        ("values.lua", "return { x = require('deep.down') }\n"),
        ("deep/down.lua", "return 1\n"),
    ]);
    let running = Running::start(files.path(), &["main.lrp"]);
    assert_eq!(names(&running.wait_for_kind("load")), ["main.lrp", "values.lua", "deep/down.lua"]);
    says(&running, "x is 1");
    files.write("deep/down.lua", "return 2\n");
    let load = running.wait_for_kind("load");
    assert_eq!((&load["restarted"], &load["changes"][0]["path"]), (&false.into(), &"x".into()));
    says(&running, "x is 2");
    files.write("values.lua", "return {\n  x = = 3\n}\n");
    let finding = rejected(&running);
    assert_eq!((&finding["file"], &finding["line"]), (&"values.lua".into(), &2.into()));
    says(&running, "x is 2");
    files.write("values.lua", "return { x = 3 }\n");
    says(&running, "x is 3");
    ends(running);
}

#[test]
fn a_file_reached_through_links_is_one_file() {
    let files = Files::with(&[
        ("robot/main.lrp", "(import \"../lib/one.lrp\")\n(import \"link/two.lrp\")\n(spawn one s)\n(spawn two s)\n"),
        ("lib/one.lrp", &(machine("one", 0) + "(machine own (state s))\n")),
        ("deep/lib/two.lrp", &("(import \"../one.lrp\")\n".to_string() + &machine("two", 0))),
        ("deep/one.lrp", "(import \"../other/one.lrp\")\n(export own)\n(machine own (state s))\n"),
    ]);
    for (target, link) in [("../deep/lib", "robot/link"), ("lib", "other")] {
        std::os::unix::fs::symlink(target, files.path().join(link)).unwrap();
    }
    let said = lrp(files.path(), &["run", "robot/main.lrp", "--virtual", "--for", "100ms", "--trace", "-"]);
    let load: Value = serde_json::from_str(said.out.lines().nth(1).unwrap()).unwrap();
    // What `..` means behind a link is for the system to say.
    assert_eq!(
        names(&load),
        ["robot/main.lrp", "lib/one.lrp", "robot/link/two.lrp", "robot/link/../one.lrp"],
        "{}",
        said.out
    );
    assert!(load.get("findings").is_none_or(|it| it == &Value::Array(Vec::new())), "{load}");
    let header: Value = serde_json::from_str(said.out.lines().next().unwrap()).unwrap();
    assert_eq!(header["files"], load["files"]);
    let drawn = lrp(files.path(), &["graph", "robot/main.lrp", "..:lib:one.lrp:own"]);
    assert_eq!(drawn.code, Some(0), "{drawn:?}");
}

#[test]
fn checks_and_drawings_see_all_files() {
    let files = Files::with(&[
        ("robot/main.lrp", MAIN),
        (
            "lib/one.lrp",
            "(export one)\n(machine one (state s (onentry (spawn two t))))\n(machine two (state t) (state u) (on [now() > 500] t -> u))\n",
        ),
    ]);
    let said = lrp(files.path(), &["check", "robot/main.lrp"]);
    assert_eq!((said.code, said.out.as_str()), (Some(0), "robot/main.lrp: no problems found\n"));
    for machine in ["..:lib:one.lrp:two", "two"] {
        let said = lrp(files.path(), &["graph", "robot/main.lrp", machine]);
        assert!(said.code == Some(0) && said.out.contains('u') && said.err.is_empty(), "{said:?}");
    }
    files.write("lib/one.lrp", "(export one)\n(machine one (state s (running [nothing = 1])) (on e s -> s))\n");
    let said = lrp(files.path(), &["check", "--format", "json", "robot/main.lrp"]);
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let places: Vec<_> = found.as_array().unwrap().iter().map(|it| (it["file"].clone(), it["line"].clone())).collect();
    assert_eq!(
        (said.code, places),
        (Some(1), vec![("lib/one.lrp".into(), 2.into()), ("lib/one.lrp".into(), 2.into())])
    );
    files.remove("lib/one.lrp");
    for command in ["check", "graph"] {
        let said = lrp(files.path(), &[command, "robot/main.lrp"]);
        let told = said.out + &said.err;
        assert!(said.code == Some(1) && told.contains("robot/main.lrp:1:10"), "{told}");
    }
}
