//! Saves while the program runs, as editors make them: what arrives, and how soon.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::binary::Running;

struct Edited {
    folder: tempfile::TempDir,
    running: Running,
}

/// The number tells the versions apart, also in what the program says.
fn text(version: u32) -> String {
    format!("(machine m (state s (running [log.info('version {version}')])))\n(spawn m s)\n")
}

impl Edited {
    fn start() -> Edited {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.lrp"), text(0)).unwrap();
        let running = Running::start(folder.path(), &["a.lrp"]);
        let edited = Edited { folder, running };
        edited.runs(0);
        edited
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("a.lrp")
    }

    fn by_truncation(&self, text: &str) {
        fs::write(self.file(), text).unwrap();
    }

    fn by_rename(&self, text: &str) {
        let new = self.folder.path().join("a.lrp~");
        fs::write(&new, text).unwrap();
        fs::rename(new, self.file()).unwrap();
    }

    fn loads(&self) -> Value {
        self.running.wait_for_kind("load")
    }

    fn rejects(&self) -> Value {
        self.running.wait_for_kind("reject")["findings"].get(0).cloned().unwrap_or_default()
    }

    fn runs(&self, version: u32) {
        let message = format!("version {version}");
        self.running.wait_for(&message, |record| record["kind"] == "log" && record["message"] == message);
    }

    fn ends(self) {
        self.running.signal(libc::SIGTERM);
        let (code, records, _) = self.running.end();
        assert_eq!((code, &records.last().unwrap()["kind"]), (Some(0), &"stop".into()));
    }
}

#[test]
fn each_way_to_save_arrives() {
    let edited = Edited::start();
    type Save = fn(&Edited, &str);
    let ways = [("rename", Edited::by_rename as Save), ("truncation", Edited::by_truncation)];
    for (round, (way, save)) in ways.into_iter().cycle().take(10).enumerate() {
        let version = round as u32 + 1;
        let saved = Instant::now();
        save(&edited, &text(version));
        let load = edited.loads();
        println!("saved by {way}, loaded after {:.1} ms", saved.elapsed().as_secs_f64() * 1e3);
        assert_eq!((&load["restarted"], &load["files"][0]["text"]), (&true.into(), &text(version).into()));
        edited.runs(version);
    }
    edited.ends();
}

#[test]
fn a_broken_edit_disturbs_nothing() {
    let edited = Edited::start();
    edited.by_truncation(&text(1).replace(")))", "))"));
    let finding = edited.rejects();
    assert_eq!(
        (&finding["file"], &finding["line"], &finding["severity"]),
        (&"a.lrp".into(), &1.into(), &"error".into())
    );
    edited.runs(0);
    edited.by_truncation(&text(1).replace("'version 1'", "'version 1"));
    let finding = edited.rejects();
    assert_eq!(&finding["line"], 1);
    edited.runs(0);
    edited.by_truncation(&text(2));
    edited.loads();
    edited.runs(2);
    edited.ends();
}

#[test]
fn a_file_that_goes_comes_back() {
    let edited = Edited::start();
    fs::remove_file(edited.file()).unwrap();
    assert_eq!(edited.rejects()["message"], "the file is gone; the program goes on");
    edited.runs(0);
    edited.by_truncation(&text(0));
    assert_eq!(edited.rejects(), Value::Null, "nothing is wrong any more");
    edited.by_truncation("");
    assert_eq!(edited.rejects()["message"], "the file is empty; the program goes on");
    edited.runs(0);
    edited.by_rename(&text(1));
    edited.loads();
    edited.runs(1);
    let running = edited.running;
    running.signal(libc::SIGTERM);
    let (_, _, err) = running.end();
    let said: Vec<&str> = err.lines().filter(|line| line.contains("warning")).collect();
    let file = |what: &str| format!("a.lrp: warning: the file is {what}; the program goes on");
    assert_eq!(said, [file("gone"), file("empty")]);
}

#[test]
fn of_many_saves_the_last_one_counts() {
    let edited = Edited::start();
    let begun = Instant::now();
    for version in 1..=200 {
        if version % 3 == 0 {
            edited.by_rename(&text(version))
        } else {
            edited.by_truncation(&text(version))
        }
        std::thread::sleep((begun + Duration::from_millis(10) * version).saturating_duration_since(Instant::now()));
    }
    let saved = Instant::now();
    edited
        .running
        .wait_for("the last save", |record| record["kind"] == "load" && record["files"][0]["text"] == text(200));
    println!("the last of 200 saves, loaded after {:.1} ms", saved.elapsed().as_secs_f64() * 1e3);
    edited.runs(200);
    edited.ends();
}

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

#[test]
fn a_broken_world_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let program = |bridge: &str| {
        format!("(bridge robot {bridge})\n(machine m (state s (running [log.info('goes on')])))\n(spawn m s)\n")
    };
    write(folder.path(), "w.world", "size 4 3\nstart 2 1.5 heading 0\n");
    write(folder.path(), "a.lrp", &program("sim [world = 'w.world']"));
    let running = Running::start(folder.path(), &["a.lrp"]);
    let robot_is =
        |health: &str| running.wait_for(health, |record| record["kind"] == "bridge" && record["state"] == health);
    robot_is("up");
    write(folder.path(), "w.world", "sise 4 3\n");
    let finding = &running.wait_for_kind("reject")["findings"][0];
    assert_eq!((&finding["file"], &finding["line"], &finding["column"]), (&"w.world".into(), &1.into(), &1.into()));
    assert_eq!(
        (&finding["message"], &finding["help"]),
        (&"unknown word `sise`".into(), &"did you mean `size`?".into())
    );
    running.wait_for_kind("log");
    write(folder.path(), "w.world", "size 4 3\nstart 1 1 heading 90\n");
    robot_is("up");
    write(folder.path(), "a.lrp", &program("simm"));
    let fault = running.wait_for_kind("error");
    assert_eq!(
        (&fault["message"], &fault["help"]),
        (&"there is no bridge of kind `simm`".into(), &"did you mean `sim`?".into())
    );
    running.wait_for_kind("log");
    running.signal(libc::SIGTERM);
    assert_eq!(running.end().0, Some(0));
}

#[test]
fn a_required_file_whose_name_is_made_up_is_live_unless_it_is_broken() {
    let folder = tempfile::tempdir().unwrap();
    let program = "(machine m (state s (running [log.info(require('wo' .. 'rds').now)])))\n(spawn m s)\n";
    write(folder.path(), "a.lrp", program);
    write(folder.path(), "words.lua", "return { now = 'first' }\n");
    let running = Running::start(folder.path(), &["a.lrp"]);
    let says = |word: &str| {
        running.wait_for(word, |record| record["kind"] == "log" && record["message"] == word);
    };
    says("first");
    write(folder.path(), "words.lua", "return { now = 'broken'\n");
    let finding = running.wait_for_kind("reject")["findings"][0].clone();
    assert!(finding["file"].as_str().unwrap().ends_with("words.lua"), "{finding}");
    says("first");
    write(folder.path(), "words.lua", "return { now = 'second' }\n");
    says("second");
}
