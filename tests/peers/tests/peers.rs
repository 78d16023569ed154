//! What is found of the peers, and what a missing one means.

use std::fs::{copy, create_dir_all, write};
use std::path::{Path, PathBuf};

use lrp_peers::{Places, Wanted};
use tempfile::{TempDir, tempdir};

fn places() -> (Places, TempDir) {
    let folder = tempdir().expect("a folder");
    (Places { path: vec!["/nowhere".into(), folder.path().into()], folder: folder.path().into() }, folder)
}

#[test]
fn a_program_is_found_on_the_path() {
    let (places, folder) = places();
    assert_eq!(places.program("socat"), None);
    write(folder.path().join("socat"), "").expect("a program");
    assert_eq!(places.program("socat"), Some(folder.path().join("socat")));
}

#[test]
fn python_is_there_once_it_has_what_the_list_says_now() {
    let (places, folder) = places();
    let home = folder.path().join("serial");
    create_dir_all(&home).expect("a folder");
    assert_eq!(places.python("serial"), None);
    copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("serial.txt"), home.join("installed.txt")).expect("a list");
    assert_eq!(places.python("serial"), Some(home.join("bin/python")));
    write(home.join("installed.txt"), "pyserial==1.0\n").expect("a list");
    assert_eq!(places.python("serial"), None);
    assert_eq!(places.python("no such list"), None);
}

#[test]
fn interfaces_are_there_once_they_are_made_of_what_is_defined_now() {
    let (places, folder) = places();
    let (home, defined) = (folder.path().join("serial"), folder.path().join("defined"));
    let made = home.join("interfaces");
    for root in [&defined, &made] {
        create_dir_all(root.join("nav/action")).expect("a folder");
        write(root.join("nav/action/Go.action"), "float32 x").expect("a definition");
    }
    assert_eq!(places.python_with("serial", &defined), None);
    copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("serial.txt"), home.join("installed.txt")).expect("a list");
    assert_eq!(places.python_with("serial", &defined), Some(home.join("bin/python")));
    write(defined.join("nav/action/Go.action"), "float64 x").expect("a definition");
    assert_eq!(places.python_with("serial", &defined), None);
    copy(made.join("nav/action/Go.action"), defined.join("nav/action/Go.action")).expect("a definition");
    write(defined.join("nav/action/Come.action"), "").expect("a definition");
    assert_eq!(places.python_with("serial", &defined), None);
    assert_eq!(places.python_with("serial", &folder.path().join("nowhere")), None);
}

#[test]
fn one_that_is_here_is_used_unless_none_is_wanted() {
    let socat = Some(PathBuf::from("/usr/bin/socat"));
    assert_eq!(Wanted::IfHere.accept("socat", socat.clone()), socat);
    assert_eq!(Wanted::Required.accept("socat", socat.clone()), socat);
    assert_eq!(Wanted::None.accept("socat", socat), None);
}

#[test]
#[should_panic(expected = "a peer is missing: socat; tests/peers/setup installs it")]
fn a_missing_one_fails_where_it_is_required() {
    Wanted::Required.accept("socat", None);
}
