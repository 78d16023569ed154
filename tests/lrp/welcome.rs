//! `lrp` without a file: what is found, how it looks, what keys choose; and the same at a terminal.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lrp::session::behaviours::{BOUNDS, Bounds, Found, find, first_comment};
use lrp::ui::key::Key;
use lrp::ui::settings::Settings;
use lrp::ui::welcome::{Choice, Options, Row, Welcome};
use portable_pty::CommandBuilder;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use crate::frames::{check_frame, text};
use crate::terminal::pty::Pty;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn welcome(width: u16, height: u16, tour: Option<&str>) -> Welcome {
    Welcome::new(Options {
        folder: "behaviors".into(),
        tour: tour.map(Into::into),
        settings: Settings::default(),
        size: Size::new(width, height),
    })
}

fn with_behaviors(width: u16, height: u16) -> Welcome {
    let mut welcome = welcome(width, height, None);
    welcome.found(find(&root().join("behaviors"), BOUNDS));
    welcome
}

fn press(welcome: &mut Welcome, keys: &str) -> Option<Choice> {
    keys.split_whitespace().find_map(|text| welcome.key(text.parse::<Key>().expect("a key").into()))
}

fn check(name: &str, welcome: &Welcome, width: u16, height: u16) {
    let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
    welcome.paint(buffer.area, &mut buffer);
    check_frame(&format!("welcome_{name}_{width}x{height}"), text(&buffer));
}

#[test]
fn it_offers_what_there_is() {
    for (width, height) in [(80, 24), (40, 24), (80, 12)] {
        check("behaviours", &with_behaviors(width, height), width, height);
    }
    let mut empty = welcome(80, 24, Some("4 of 14"));
    check("looking", &empty, 80, 24);
    empty.found(Found::default());
    check("empty", &empty, 80, 24);
    let mut gone = welcome(80, 24, None);
    gone.found(find(Path::new("/no/such/folder"), BOUNDS));
    check("unreadable", &gone, 80, 24);
    let mut naming = with_behaviors(80, 24);
    assert_eq!(press(&mut naming, "n r o v e r"), None);
    check("naming", &naming, 80, 24);
    assert_eq!(press(&mut naming, "Enter"), Some(Choice::Make("rover".into())));
    naming.refuse("rover.lrp exists already and stays as it is; choose another name");
    check("refused", &naming, 80, 24);
    for (width, height) in [(1, 1), (20, 5), (0, 0), (300, 3)] {
        let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
        with_behaviors(width, height).paint(buffer.area, &mut buffer);
    }
}

#[test]
fn keys_choose() {
    let mut welcome = with_behaviors(80, 12);
    assert_eq!(welcome.selected(), Row::Behaviour(0));
    let file = |name: &str| Some(Choice::Open(PathBuf::from(name)));
    assert_eq!(press(&mut welcome, "Enter"), file("concurrent.lrp"));
    assert_eq!(press(&mut welcome, "Down j Enter"), file("exit.lrp"));
    assert_eq!(press(&mut welcome, "Home Enter"), file("concurrent.lrp"));
    assert_eq!(press(&mut welcome, "End Up Enter"), Some(Choice::Tour));
    assert_eq!(press(&mut welcome, "Down Down Down Enter q Esc"), None, "q is part of a name");
    assert_eq!(press(&mut welcome, "t"), Some(Choice::Tour));
    assert_eq!(press(&mut welcome, "q"), Some(Choice::Quit));
    assert_eq!(press(&mut welcome, "n Ctrl-C"), Some(Choice::Quit));
    assert_eq!(press(&mut welcome, "Esc x"), None);
}

#[test]
fn a_choice_made_while_it_is_looked_for_stays() {
    let mut welcome = welcome(80, 24, None);
    press(&mut welcome, "Down");
    welcome.found(find(&root().join("behaviors"), BOUNDS));
    assert_eq!(welcome.selected(), Row::New);
}

#[test]
fn names_may_hold_anything_and_others_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let odd = Path::new(OsStr::from_bytes(b"\xff\n.lrp"));
    fs::write(folder.path().join(odd), ";; \x1b[31mred").unwrap();
    fs::write(at("-x.lrp"), "(machine m)").unwrap();
    fs::write(at("empty.lrp"), "").unwrap();
    for hidden in [".git", "target", "deep/er", "z.lrp"] {
        fs::create_dir_all(at(hidden)).unwrap();
        fs::write(at(hidden).join("a.lrp"), "; inside").unwrap();
    }
    fs::write(at("notes.txt"), "").unwrap();
    std::os::unix::fs::symlink(folder.path(), at("round")).unwrap();
    std::os::unix::fs::symlink("nowhere", at("gone.lrp")).unwrap();
    let pipe = std::ffi::CString::new(at("pipe.lrp").as_os_str().as_bytes()).unwrap();
    // SAFETY: a path that ends with a zero.
    assert_eq!(unsafe { libc::mkfifo(pipe.as_ptr(), 0o600) }, 0);
    let found = find(folder.path(), BOUNDS);
    assert_eq!((found.cut, &found.trouble), (false, &None));
    let seen: Vec<(&Path, &str)> = found.all.iter().map(|behaviour| (&*behaviour.file, &*behaviour.about)).collect();
    let wanted = [
        (Path::new("-x.lrp"), ""),
        (Path::new("empty.lrp"), ""),
        (odd, " [31mred"),
        (Path::new("z.lrp/a.lrp"), "inside"),
        (Path::new("deep/er/a.lrp"), "inside"),
    ];
    assert_eq!(seen, wanted);
}

#[test]
fn a_first_comment_says_something() {
    assert_eq!(first_comment("\n;;; --- \n ; It drives.\n; More."), "It drives.");
    assert_eq!(first_comment("(machine m ; no line of its own\n"), "");
}

#[test]
fn ten_thousand_files_are_no_trouble() {
    let folder = tempfile::tempdir().unwrap();
    for i in 0..10_000 {
        fs::write(folder.path().join(format!("{i:05}.lrp")), "; one of many").unwrap();
    }
    let begun = Instant::now();
    let found = find(folder.path(), BOUNDS);
    println!("10,000 files: {:.0} ms", begun.elapsed().as_secs_f64() * 1e3);
    assert_eq!((found.all.len(), found.cut), (BOUNDS.behaviours, true));
    assert_eq!(found.all[7].file, Path::new("00007.lrp"));
    let few = find(folder.path(), Bounds { names: 10, ..BOUNDS });
    assert_eq!((few.all.len(), few.cut), (10, true));
    let now = find(folder.path(), Bounds { time: Duration::ZERO, ..BOUNDS });
    assert!(now.cut && now.all.is_empty());
}

fn alone(folder: &Path) -> (Pty, crate::terminal::pty::Running) {
    let pty = Pty::new();
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_lrp"));
    command.cwd(folder);
    command.env("TERM", "xterm-256color");
    let running = pty.run(command);
    pty.wait_for("the welcome", |screen| screen.contents().contains("Live Robot Programming"));
    (pty, running)
}

fn shows(pty: &Pty, words: &[&str]) {
    pty.wait_for(&words.join(", "), |screen| words.iter().all(|word| screen.contents().contains(word)));
}

#[test]
fn enter_runs_the_choice() {
    let (mut pty, running) = alone(&root().join("behaviors"));
    shows(&pty, &["escapement.lrp", "take the tour"]);
    pty.type_in("j\r");
    shows(&pty, &["escapement.lrp", "RUN", "tick", "STOP"]);
    pty.type_in("q");
    assert_eq!(running.wait().exit_code(), 0);
}

#[test]
fn a_new_behaviour_is_made_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("taken.lrp"), "mine").unwrap();
    let (mut pty, running) = alone(folder.path());
    shows(&pty, &["taken.lrp"]);
    pty.type_in("ntaken\r");
    shows(&pty, &["taken.lrp exists already"]);
    for _ in 0..5 {
        pty.type_in("\x7f");
    }
    pty.type_in("mine\r");
    shows(&pty, &["mine.lrp", "RUN", "driving"]);
    pty.type_in("q");
    assert_eq!(running.wait().exit_code(), 0);
    assert_eq!(fs::read_to_string(folder.path().join("taken.lrp")).unwrap(), "mine");
    let (mut pty, running) = alone(folder.path());
    pty.type_in("\x03");
    assert_eq!(running.wait().exit_code(), 130);
}
