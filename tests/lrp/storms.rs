//! Files of a running program as careless hands and strange disks treat them: what wins, what is said, what is lost.

use std::cell::RefCell;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::binary::Running;

struct Folder {
    folder: tempfile::TempDir,
    running: Running,
}

impl Folder {
    /// `a.lrp` runs at 100 Hz.
    fn start(files: &[(&str, &str)]) -> Folder {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("lib")).unwrap();
        files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
        let running = Running::start(folder.path(), &["a.lrp", "--rate", "100"]);
        let folder = Folder { folder, running };
        folder.loads();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn remove(&self, name: &str) {
        fs::remove_file(self.path(name)).unwrap();
    }

    fn rename(&self, name: &str, to: &str) {
        fs::rename(self.path(name), self.path(to)).unwrap();
    }

    fn loads(&self) -> Value {
        self.running.wait_for_kind("load")
    }

    fn says(&self, words: &str) {
        self.running.wait_for(words, |record| record["kind"] == "log" && record["message"] == words);
    }

    /// The first finding of the next save that isn't taken over: its file and message.
    fn complains(&self) -> (String, String) {
        let finding = self.running.wait_for_kind("reject")["findings"][0].clone();
        let said = |key: &str| finding[key].as_str().unwrap_or_default().to_string();
        (said("file"), said("message"))
    }

    fn ends(self) {
        self.running.signal(libc::SIGTERM);
        let (code, records, _) = self.running.end();
        assert_eq!((code, &records.last().unwrap()["kind"]), (Some(0), &"stop".into()));
    }
}

/// Counts its steps beside what differs in each version.
fn version(number: usize) -> String {
    format!(
        "(machine m (var n := [0]) (state s (running [n = n + 1])))\n(spawn m s)\n\
         (machine other (state s{number} (running [log.info('{number}')])))\n(var w{number} := [{number}])\n"
    )
}

/// As editors do it, and as programs do that write in pieces.
fn save(file: &Path, text: &str, way: usize) {
    let beside = file.with_extension("tmp");
    match way % 4 {
        0 => fs::write(file, text).unwrap(),
        1 => {
            fs::write(&beside, text).unwrap();
            fs::rename(beside, file).unwrap();
        }
        2 => {
            fs::rename(file, &beside).unwrap();
            fs::write(file, text).unwrap();
            fs::remove_file(beside).unwrap();
        }
        _ => {
            let mut file = fs::File::create(file).unwrap();
            text.as_bytes().chunks(50).for_each(|piece| file.write_all(piece).unwrap());
        }
    }
}

/// Every other save is half a text. Each step is seen to be made, whatever is saved between two of them.
#[test]
fn a_thousand_saves_disturb_nothing() {
    let folder = Folder::start(&[("a.lrp", &version(0))]);
    let file = folder.path("a.lrp");
    let memory = folder.running.memory();
    let counted = RefCell::new(Vec::new());
    let follow = |record: &Value| {
        if record["kind"] == "load" {
            assert_eq!(record["restarted"], false, "{record}");
        }
        if record["var"] == "m/n" {
            counted.borrow_mut().push(record["value"].as_u64().unwrap());
        }
    };
    for round in 0..100 {
        for number in round * 10 + 1..=round * 10 + 10 {
            let text = version(number);
            save(&file, if number % 2 == 1 { &text[..text.len() / 2] } else { &text }, number / 2);
        }
        folder.running.wait_for("a step", |record| {
            follow(record);
            record["var"] == "m/n"
        });
    }
    folder.running.wait_for("the last save", |record| {
        follow(record);
        record["kind"] == "load" && record["files"][0]["text"] == version(1000)
    });
    let counted = counted.into_inner();
    assert!(counted.windows(2).all(|pair| pair[1] == pair[0] + 1), "{counted:?}");
    if let (Some(before), Some(after)) = (memory, folder.running.memory()) {
        assert!(after < before + (4 << 20), "{before} bytes, then {after}");
    }
    folder.ends();
}

#[test]
fn two_programs_take_turns() {
    let texts = ["one", "two"].map(|name| {
        format!("(machine {name} (state s{name} (running [log.info('{name}')])))\n(spawn {name} s{name})\n")
    });
    let folder = Folder::start(&[("a.lrp", &texts[0])]);
    for (round, name) in ["two", "one"].into_iter().cycle().take(12).enumerate() {
        save(&folder.path("a.lrp"), &texts[(round + 1) % 2], round);
        assert_eq!(folder.loads()["restarted"], true);
        folder.says(name);
    }
    folder.ends();
}

const IMPORTS: &str = "(import \"lib/b.lrp\")\n(machine m (state s (onentry (spawn sub x))))\n(spawn m s)\n";

fn imported(words: &str) -> String {
    format!("(export sub)\n(machine sub (state x (running [log.info({words})])))\n")
}

#[test]
fn what_a_program_is_made_of_may_go_and_come_back() {
    let required = imported("require('words')");
    let folder = Folder::start(&[("a.lrp", IMPORTS), ("lib/b.lrp", &required), ("words.lua", "return 'first'\n")]);
    folder.says("first");
    folder.remove("lib/b.lrp");
    folder.remove("words.lua");
    folder.remove("a.lrp");
    let mut gone = [folder.complains(), folder.complains(), folder.complains()];
    gone.sort();
    let file = |name: &str| (name.to_string(), "the file is gone; the program goes on".to_string());
    assert_eq!(gone, [file("a.lrp"), file("lib/b.lrp"), file("words.lua")]);
    folder.says("first");
    folder.write("a.lrp", IMPORTS);
    folder.write("lib/b.lrp", &required);
    folder.write("words.lua", "return 'second'\n");
    folder.says("second");
    folder.write("lib/b.lrp", &required[..required.len() / 2]);
    assert_eq!(folder.complains().0, "lib/b.lrp");
    folder.says("second");
    folder.write("lib/b.lrp", &imported("'third'"));
    folder.says("third");
    folder.ends();
}

#[test]
fn an_import_may_be_made_later_and_its_folder_renamed() {
    let folder = Folder::start(&[("a.lrp", IMPORTS), ("lib/b.lrp", &imported("'first'"))]);
    folder.says("first");
    folder.write("a.lrp", &IMPORTS.replace("lib/b", "lib/later"));
    assert_eq!(folder.complains(), ("a.lrp".into(), "there is no file `lib/later.lrp` to import".into()));
    folder.says("first");
    folder.write("lib/later.lrp", &imported("'second'"));
    folder.says("second");
    folder.rename("lib", "away");
    folder.write("away/later.lrp", &imported("'third'"));
    folder.says("second");
    folder.rename("away", "lib");
    folder.says("third");
    folder.ends();
}

/// Its writer takes its time, and what is there meanwhile is no program, or another one.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_grows_counts_when_it_is_whole() {
    let folder = Folder::start(&[("a.lrp", &version(0))]);
    let text =
        (1..=9).map(|number| format!("(var w{number} := [{number}])\n")).fold(version(0), |all, line| all + &line);
    let mut file = fs::File::create(folder.path("a.lrp")).unwrap();
    for piece in text.as_bytes().chunks(11) {
        file.write_all(piece).unwrap();
        folder.running.wait_for("a step", |record| {
            assert!(record["kind"] != "load" && record["kind"] != "reject", "{record}");
            record["var"] == "m/n"
        });
    }
    drop(file);
    let taken = folder.running.wait_for("it", |record| record["kind"] == "load" || record["kind"] == "reject");
    assert_eq!(taken["files"][0]["text"], text);
    folder.ends();
}

/// To open a pipe that nobody writes to takes for ever.
#[test]
fn a_pipe_in_its_place_holds_nothing_up() {
    let folder = Folder::start(&[("a.lrp", IMPORTS), ("lib/b.lrp", &imported("'first'"))]);
    for (name, text) in
        [("lib/b.lrp", imported("'second'")), ("a.lrp", IMPORTS.replace("(state s", "(state t) (state s"))]
    {
        folder.remove(name);
        let made = std::process::Command::new("mkfifo").arg(folder.path(name)).status().unwrap();
        assert!(made.success());
        let why = "this is a pipe or a device, not a file; the program goes on";
        assert_eq!(folder.complains(), (name.into(), why.into()));
        folder.remove(name);
        folder.write(name, &text);
        folder.loads();
        folder.says("second");
    }
    folder.ends();
}
