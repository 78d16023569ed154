//! Programs that run, one file each in tests/corpus/run: what their head says happens is played, and the trace that
//! stands beside them is expected. `UPDATE=1` writes the traces anew.

use std::fs;
use std::path::{Path, PathBuf};

use crate::stage::{Head, lines};

pub fn corpus(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(folder)
}

/// Compares what each case gives with the text beside it.
pub fn compare(folder: &str, result: impl Fn(&str) -> String) {
    let mut cases: Vec<PathBuf> =
        fs::read_dir(corpus(folder)).expect("the corpus").flatten().map(|it| it.path()).collect();
    cases.retain(|path| path.extension().is_some_and(|it| it == "lrp"));
    cases.sort();
    let mut different = Vec::new();
    for case in &cases {
        let text = fs::read_to_string(case).expect("a case");
        let seen = result(&text);
        let expected = case.with_extension("txt");
        if std::env::var_os("UPDATE").is_some() {
            fs::write(&expected, seen).expect("the expectation is written");
            continue;
        }
        let wanted = fs::read_to_string(&expected).unwrap_or_default();
        if seen != wanted {
            different.push(format!("{}:\n{}", case.display(), difference(&wanted, &seen)));
        }
    }
    assert!(!cases.is_empty(), "no cases in {folder}");
    assert!(different.is_empty(), "UPDATE=1 writes them anew\n{}", different.join("\n"));
}

/// The first line that differs, with those before it.
fn difference(wanted: &str, seen: &str) -> String {
    let same = wanted.lines().zip(seen.lines()).take_while(|(a, b)| a == b).count();
    let before: Vec<&str> = seen.lines().take(same).skip(same.saturating_sub(5)).collect();
    let next = |text: &str| text.lines().nth(same).unwrap_or("(the end)").to_owned();
    format!("  {}\nwanted: {}\n  seen: {}", before.join("\n  "), next(wanted), next(seen))
}

#[test]
fn programs_run_as_written() {
    compare("run", |text| lines(&Head::read(text).play(text, Vec::new())));
}
