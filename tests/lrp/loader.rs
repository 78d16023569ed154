//! What can stand in the way of a program's text, and how it is said.

use std::fs;
use std::path::Path;

use lrp::session::loader::{LIMIT, Unreadable, nearest_name, read, read_file};

fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// The message, without the temporary folder's name.
fn complaint(folder: &Path, name: &str) -> String {
    let error = read(&folder.join(name)).unwrap_err();
    error.to_string().replace(&format!("{}/", folder.display()), "")
}

#[test]
fn a_text_comes_as_it_stands_under_the_name_the_user_gave() {
    let dir = folder(&[("a.lrp", "(var x := [1])\r\n; \u{e9}\0\n".as_bytes())]);
    let path = dir.path().join("./a.lrp");
    let source = read(&path).unwrap();
    assert_eq!(&*source.text, "(var x := [1])\r\n; \u{e9}\0\n");
    assert_eq!(&*source.name, path.to_str().unwrap());
}

#[test]
fn a_missing_file_suggests_its_neighbour() {
    let dir = folder(&[("behaviour.lrp", b"x"), ("other.lrp", b"x")]);
    let message = complaint(dir.path(), "behavior.lrp");
    assert_eq!(message, "behavior.lrp: no such file; did you mean `behaviour.lrp`?");
    assert_eq!(complaint(dir.path(), "zzzzzzzz.txt"), "zzzzzzzz.txt: no such file");
}

#[test]
fn the_extension_is_no_likeness() {
    let names = ["a.lrp", "arm.lrp", "walker.lua"];
    let cases = [
        ("nn.lrp", None),
        ("b.lrp", None),
        ("amr.lrp", Some("arm.lrp")),
        ("arm.lpr", Some("arm.lrp")),
        ("walker.lrp", None),
        ("wakler.lua", Some("walker.lua")),
        ("arms.lua", None),
        ("walker.l", None),
        ("walkerlua", Some("walker.lua")),
    ];
    for (wanted, expected) in cases {
        assert_eq!(nearest_name(wanted, &names), expected, "{wanted}");
    }
}

#[test]
fn a_folder_is_never_suggested() {
    let dir = folder(&[]);
    fs::create_dir(dir.path().join("robots")).unwrap();
    assert_eq!(complaint(dir.path(), "robot"), "robot: no such file");
}

#[test]
fn a_missing_folder_is_named() {
    let dir = folder(&[]);
    let path = dir.path().join("nowhere/a.lrp");
    let expected = Unreadable::NoFolder { path: path.clone(), folder: dir.path().join("nowhere") };
    assert_eq!(read(&path), Err(expected));
    assert!(read(Path::new("surely-not-here.lrp")).unwrap_err().to_string().ends_with("no such file"));
}

#[test]
fn a_folder_is_no_program() {
    let dir = folder(&[]);
    fs::create_dir(dir.path().join("robots")).unwrap();
    assert_eq!(complaint(dir.path(), "robots"), "robots: this is a folder; name a file in it");
}

#[test]
fn white_space_is_as_good_as_nothing() {
    let dir = folder(&[("none.lrp", b""), ("blank.lrp", b" \r\n\t\n")]);
    assert_eq!(complaint(dir.path(), "none.lrp"), "none.lrp: the file is empty");
    assert_eq!(complaint(dir.path(), "blank.lrp"), "blank.lrp: the file is empty");
}

#[test]
fn a_byte_that_is_not_utf8_has_its_place() {
    let dir = folder(&[("latin.lrp", b"; one\r; \xC3\xA9t\xE9\n")]);
    let message = complaint(dir.path(), "latin.lrp");
    assert_eq!(message, "latin.lrp:2:5: not UTF-8 (byte 0xE9); save the file as UTF-8");
}

#[test]
fn the_limit_is_sharp_and_a_giant_is_not_read() {
    let dir = folder(&[("full.lrp", &vec![b';'; LIMIT as usize])]);
    assert_eq!(read(&dir.path().join("full.lrp")).unwrap().text.len() as u64, LIMIT);
    let over = fs::File::create(dir.path().join("over.lrp")).unwrap();
    over.set_len(LIMIT + 1).unwrap();
    assert_eq!(complaint(dir.path(), "over.lrp"), "over.lrp: larger than 8 MiB; is this a program?");
    let endless = read(Path::new("/dev/zero"));
    assert_eq!(endless, Err(Unreadable::TooLarge { path: "/dev/zero".into() }));
}

#[test]
fn a_path_through_a_file_is_explained() {
    let dir = folder(&[("a.lrp", b"x")]);
    assert!(complaint(dir.path(), "a.lrp/b.lrp").starts_with("a.lrp/b.lrp: Not a directory"));
}

/// Nobody writes to it: to open it would take for ever.
#[test]
fn a_pipe_is_not_waited_for_where_a_file_should_be() {
    let dir = folder(&[("a.lrp", b"(var x := [1])")]);
    let path = dir.path().join("pipe.lrp");
    assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    assert_eq!(read_file(&path), Err(Unreadable::NotAFile { path }));
    assert!(read_file(&dir.path().join("a.lrp")).is_ok());
    assert_eq!(read_file(dir.path()), Err(Unreadable::Directory { path: dir.path().into() }));
}
