//! Where bridges are found, and which are refused.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use super::{Run, examples, lrp_binary, plugins};

fn script(folder: &Path, kind: &str, lines: &str) {
    let path = folder.join(format!("lrp-bridge-{kind}.sh"));
    fs::write(&path, format!("#!/bin/sh\n{lines}\n")).expect("a script");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("a script to run");
}

/// Why a bridge that is this script isn't used.
fn refused(lines: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    script(folder.path(), "odd", lines);
    let mut run = Run::prepare("(bridge robot odd)", ".".into(), plugins(vec![folder.path().into()]));
    run.until("its loss", |run| !run.losses().is_empty());
    run.losses().remove(0)
}

#[test]
fn another_version_of_the_protocol_is_refused() {
    let why = refused(r#"echo '{"event":"hello","protocol":2,"kind":"odd","version":"9","summary":""}'; cat"#);
    assert!(why.ends_with("speaks version 2 of the protocol, this lrp version 1: update lrp"), "{why}");
}

#[test]
fn what_does_not_speak_the_protocol_is_refused() {
    assert_eq!(refused("echo Hello; cat"), "it doesn't speak lrp's protocol: `Hello`");
    let why = refused(r#"echo '{"event":"stopped"}'; cat"#);
    assert_eq!(why, "it doesn't begin with `hello`");
}

#[test]
fn what_ends_at_once_says_its_last_words() {
    let why = refused("echo 'no such module' >&2; exit 1");
    assert!(why.starts_with("ended with code 1: no such module; started again in"), "{why}");
}

/// What is said of a library that is made of the good one's bytes.
fn unusable(make: impl FnOnce(Vec<u8>) -> Vec<u8>, temporary: &Path) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let good = fs::read(examples().join("liblrp_bridge_echo.so")).expect("a library");
    fs::write(folder.path().join("liblrp_bridge_echo.so"), make(good)).expect("a library");
    let mut lrp = Command::new(lrp_binary());
    lrp.args(["bridges", "echo", "--bridge-path"]).arg(folder.path()).env("TMPDIR", temporary);
    let said = lrp.output().expect("lrp");
    assert_eq!(said.status.code(), Some(1));
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    said.split_once("echo.so: ").expect("the library's name").1.trim_end().to_string()
}

#[test]
fn a_library_that_can_not_be_loaded_says_why() {
    let temporary = tempfile::tempdir().expect("a folder");
    let here = temporary.path();
    let cut = "it can't be loaded: it is cut short; is it still being written, or was the disk full?";
    assert_eq!(unusable(|good| good[..good.len() / 2].to_vec(), here), cut);
    let other = |words: &str| {
        format!("it can't be loaded from {}: {words}; is it whole, and built for this computer?", here.display())
    };
    assert_eq!(unusable(|_| Vec::new(), here), other("file too short"));
    assert_eq!(unusable(|_| b"text ".repeat(99), here), other("invalid ELF header"));
    let of_another_machine = |mut good: Vec<u8>| {
        // Where ELF has the machine: one that there isn't.
        good[18..20].copy_from_slice(&[0xee, 0xee]);
        good
    };
    let why = unusable(of_another_machine, here);
    assert!(why.ends_with("; is it whole, and built for this computer?"), "{why}");
    assert_eq!(fs::read_dir(here).expect("a folder").count(), 0, "copies are removed");
    let nowhere = here.join("nowhere");
    let why = unusable(|good| good, &nowhere);
    let begins = format!("it can't be copied to {} to be loaded: ", nowhere.display());
    assert!(why.starts_with(&begins) && why.ends_with("; is there room? TMPDIR names another folder"), "{why}");
}

#[test]
fn they_are_listed_with_what_they_offer() {
    let folder = tempfile::tempdir().expect("a folder");
    script(folder.path(), "odd", "echo Hello; cat");
    let bridges = |kind: &[&str]| {
        let said = Command::new(lrp_binary())
            .arg("bridges")
            .args(kind)
            .arg("--bridge-path")
            .arg(examples())
            .arg("--bridge-path")
            .arg(folder.path())
            .output()
            .expect("lrp");
        (
            said.status.code(),
            String::from_utf8_lossy(&said.stdout).into_owned(),
            String::from_utf8_lossy(&said.stderr).into_owned(),
        )
    };
    let (code, list, _) = bridges(&[]);
    assert_eq!(code, Some(0));
    for line in [
        "sim        0.1.0    a robot with two driven wheels",
        "echo       0.1.0    hears what is said to it",
        "odd        -        can't be used: it doesn't speak lrp's protocol: `Hello`",
        "looked for in",
    ] {
        assert!(list.contains(line), "{line}: {list}");
    }
    let (code, told, _) = bridges(&["echo"]);
    assert_eq!(code, Some(0));
    for line in ["settings: (bridge NAME echo [ .. ])", "  .repeat_it(what) gives back what it is given", "device horn"]
    {
        assert!(told.contains(line), "{line}: {told}");
    }
    let (code, _, error) = bridges(&["ecoh"]);
    assert_eq!((code, &*error), (Some(1), "lrp: there is no bridge of kind `ecoh`; did you mean `echo`?\n"));
}

#[test]
fn a_check_asks_the_bridge() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = "(bridge robot echo [puase = 1])\n(machine m (state s (running [robot.say{}])))\n(spawn m s)\n";
    fs::write(folder.path().join("p.lrp"), program).expect("a program");
    let said = Command::new(lrp_binary())
        .args(["check", "p.lrp", "--bridge-path"])
        .arg(examples())
        .current_dir(folder.path())
        .output()
        .expect("lrp");
    let text = String::from_utf8_lossy(&said.stdout);
    assert!(text.contains("error[bad-bridge]: an echo has no setting `puase`"), "{text}");
}

#[test]
fn virtual_time_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = "(bridge robot echo)\n(machine m (state s (running [robot.say{}])))\n(spawn m s)\n";
    fs::write(folder.path().join("p.lrp"), program).expect("a program");
    let said = Command::new(lrp_binary())
        .args(["run", "--virtual", "--for", "1s", "p.lrp", "--bridge-path"])
        .arg(examples())
        .current_dir(folder.path())
        .output()
        .expect("lrp");
    let text = String::from_utf8_lossy(&said.stderr);
    assert!(text.contains("`echo` is a real robot: it can't follow virtual time"), "{text}");
    assert_eq!(said.status.code(), Some(1));
}
