//! Every program in tests/corpus: those in `ok` with the tree beside them, those in `err` with what is said of them.
//! `UPDATE=1 cargo test` writes the expectations anew.

use std::fs;
use std::path::{Path, PathBuf};

use lrp::syntax::render::{Style, render};
use lrp::syntax::{Code, FileId, Source, parse};

use super::dump::dump;

pub fn programs(folder: &str) -> Vec<(PathBuf, Source)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(folder);
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "lrp"));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), read(&path))).collect()
}

fn read(path: &Path) -> Source {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    Source::new(name, fs::read_to_string(path).unwrap())
}

/// Compares each program's outcome with the file beside it.
fn compare(folder: &str, extension: &str, outcome: fn(&Source) -> String) {
    let mut wrong = String::new();
    for (path, source) in programs(folder) {
        let expectation = path.with_extension(extension);
        let found = outcome(&source);
        if std::env::var_os("UPDATE").is_some() {
            fs::write(&expectation, &found).unwrap();
            continue;
        }
        let expected = fs::read_to_string(&expectation).unwrap_or_default();
        if expected != found {
            wrong += &format!("--- {}\n{}\n", source.name, difference(&expected, &found));
        }
    }
    assert!(wrong.is_empty(), "these came out differently (UPDATE=1 accepts them):\n{wrong}");
}

/// The lines that differ: those expected and those found, after what both begin and before what both end with.
fn difference(expected: &str, found: &str) -> String {
    let (a, b): (Vec<&str>, Vec<&str>) = (expected.lines().collect(), found.lines().collect());
    let head = a.iter().zip(&b).take_while(|(a, b)| a == b).count();
    let tail = a[head..].iter().rev().zip(b[head..].iter().rev()).take_while(|(a, b)| a == b).count();
    let gone = a[head..a.len() - tail].iter().map(|line| format!("-{line}\n"));
    let new = b[head..b.len() - tail].iter().map(|line| format!("+{line}\n"));
    format!("@ line {}\n{}", head + 1, gone.chain(new).collect::<String>())
}

#[test]
fn good_programs_give_their_trees() {
    compare("ok", "tree", |source| {
        let parsed = parse(source, FileId(0));
        render(&parsed.diagnostics, std::slice::from_ref(source), Style::Plain) + &dump(&parsed.tree, source)
    });
}

#[test]
fn good_programs_have_no_diagnostics() {
    for (_, source) in programs("ok") {
        assert_eq!(parse(&source, FileId(0)).diagnostics, [], "{}", source.name);
    }
}

#[test]
fn bad_programs_say_what_is_wrong() {
    compare("err", "txt", |source| {
        let diagnostics = parse(source, FileId(0)).diagnostics;
        render(&diagnostics, std::slice::from_ref(source), Style::Plain)
    });
}

#[test]
fn every_code_of_this_layer_has_a_case() {
    let mut seen: Vec<Code> = programs("err")
        .iter()
        .flat_map(|(_, source)| parse(source, FileId(0)).diagnostics)
        .map(|diagnostic| diagnostic.code)
        .collect();
    seen.sort();
    seen.dedup();
    let wanted = [
        Code::UnclosedBracket,
        Code::StrayBracket,
        Code::UnclosedBlock,
        Code::UnclosedString,
        Code::StrayCharacter,
        Code::NestedTooDeep,
        Code::BadForm,
        Code::UnknownForm,
        Code::MisplacedForm,
        Code::BadName,
        Code::BadTimeout,
    ];
    assert_eq!(seen, wanted);
}
