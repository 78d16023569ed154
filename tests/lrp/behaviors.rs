//! Behaviour tests run by the library: those beside the behaviours, and the runner's own, whose reports are kept as text.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use lrp::session::test_runner::{LIMIT, Report, run_file, test_files};

/// A test for each file beside the behaviours, and the list of them.
macro_rules! behaviors {
    ($($name:ident)*) => {
        const BEHAVIORS: &[&str] = &[$(stringify!($name),)*];

        $(
            #[test]
            fn $name() {
                let file = format!("behaviors/{}_test.lua", stringify!($name));
                let report = Report { outcomes: run_file(Path::new(&file), LIMIT, |_| ()) };
                assert_eq!(report.failed(), 0, "{}", report.end());
            }
        )*
    };
}

behaviors!(concurrent escapement exit forcing line_follower line_keeper live_scenario resettable_timer stopwatch);

/// Behaviours of robots whose bridges are plugins: lrp itself runs them, with the robots' descriptions.
const OF_PLUGINS: [(&str, &str); 3] = [
    ("behaviors/ev3/line_follower_test.lua", "liblrp_bridge_ev3.so"),
    ("behaviors/ros2/deliver_test.lua", "liblrp_bridge_ros2.so"),
    ("behaviors/ros2/greet_test.lua", "liblrp_bridge_ros2.so"),
];

#[test]
fn behaviors_of_plugins() {
    let lrp = Path::new(env!("CARGO_BIN_EXE_lrp"));
    for (file, plugin) in OF_PLUGINS {
        // Where the tests of a plugin's package leave it.
        let plugin = lrp.with_file_name("deps").join(plugin);
        assert!(plugin.exists(), "{} is missing: run the tests by `cargo test --workspace`", plugin.display());
        let ran = Command::new(lrp).args(["test", file]).output().unwrap();
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stdout));
    }
}

#[test]
fn no_behavior_test_is_left_out() {
    let mut files = test_files(&["behaviors".into()]).unwrap();
    files.sort();
    let listed = BEHAVIORS.iter().map(|name| PathBuf::from(format!("behaviors/{name}_test.lua")));
    let mut listed: Vec<PathBuf> = listed.chain(OF_PLUGINS.map(|(file, _)| file.into())).collect();
    listed.sort();
    assert_eq!(files, listed);
}

/// The report of a file in the corpus, without times.
fn reported(name: &str) -> String {
    let mut outcomes = run_file(Path::new(&format!("tests/corpus/runner/{name}.lua")), LIMIT, |_| ());
    outcomes.iter_mut().for_each(|outcome| outcome.took = Duration::ZERO);
    let lines: Vec<String> = outcomes.iter().map(|outcome| outcome.line()).collect();
    format!("{}\n{}\n", lines.join("\n"), Report { outcomes }.end())
}

/// Compares with the kept report; `UPDATE=1` keeps a new one.
#[track_caller]
fn check(name: &str) {
    let kept = format!("tests/corpus/runner/{name}.txt");
    let seen = reported(name);
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&kept, &seen).unwrap();
    }
    let wanted = std::fs::read_to_string(&kept).unwrap_or_default();
    assert!(seen == wanted, "not as in {kept}:\n{seen}");
}

#[test]
fn each_function_works() {
    check("functions");
}

#[test]
fn faults_go_when_they_are_mended() {
    check("faults");
}

#[test]
fn breakpoints_work() {
    check("breaks");
}

#[test]
fn a_test_can_ask_why_not() {
    check("why");
}

#[test]
fn failed_expectations_tell_what_was_seen() {
    check("expectations");
}

#[test]
fn mistakes_in_tests_are_told_with_their_line() {
    check("mistakes");
}

#[test]
fn files_that_are_no_tests_fail() {
    for name in ["syntax", "empty", "outside"] {
        check(name);
    }
}

#[test]
fn endless_tests_are_stopped() {
    let outcomes = run_file(Path::new("tests/corpus/runner/endless.lua"), Duration::from_millis(100), |_| ());
    let failed: Vec<bool> = outcomes.iter().map(|outcome| outcome.failure.is_some()).collect();
    assert_eq!(failed, [true, true, true, true, false]);
    for failure in outcomes.iter().filter_map(|outcome| outcome.failure.as_ref()) {
        assert_eq!(failure.complaint.message, "stopped, as the test ran for more than 0.1 s of real time");
    }
}

#[test]
fn a_missing_file_is_a_failure() {
    let outcomes = run_file(Path::new("tests/corpus/runner/nothing.lua"), LIMIT, |_| ());
    let report = Report { outcomes };
    assert_eq!(report.failed(), 1);
    assert!(report.end().contains("nothing.lua: no such file"), "{}", report.end());
}

#[test]
fn tests_are_told_of_as_they_end() {
    let mut told = Vec::new();
    run_file(Path::new("behaviors/escapement_test.lua"), LIMIT, |outcome| told.push(outcome.name.clone()));
    assert_eq!(told.len(), 5);
    assert_eq!(told[0].as_deref(), Some("ticks twice a second"));
}

#[test]
fn folders_are_searched() {
    let folder = tempfile::tempdir().unwrap();
    let made = [
        "b_test.lua",
        "a/z_test.lua",
        "a/helper.lua",
        "target/x_test.lua",
        ".git/x_test.lua",
        "a_test.lua",
        "test.lua",
    ];
    for file in made {
        let path = folder.path().join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, "").unwrap();
    }
    let found = |paths: &[&str]| {
        let paths: Vec<PathBuf> = paths.iter().map(|path| folder.path().join(path)).collect();
        let files =
            test_files(&paths).map_err(|why| why.to_string().replace(&*folder.path().to_string_lossy(), "FOLDER"))?;
        let names = files.iter().map(|file| file.strip_prefix(folder.path()).unwrap().display().to_string());
        Ok::<_, String>(names.collect::<Vec<_>>())
    };
    assert_eq!(found(&[""]).unwrap(), ["a/z_test.lua", "a_test.lua", "b_test.lua"]);
    assert_eq!(found(&["b_test.lua", "", "a"]).unwrap(), ["b_test.lua", "a/z_test.lua", "a_test.lua"]);
    assert_eq!(found(&["a/helper.lua"]).unwrap(), ["a/helper.lua"], "a file is taken whatever its name");
    assert_eq!(found(&["target"]).unwrap(), ["target/x_test.lua"], "a folder that is named is searched");
    assert_eq!(found(&["c"]).unwrap_err(), "FOLDER/c: no such file or folder");
    std::fs::remove_dir_all(folder.path().join("a")).unwrap();
    std::fs::create_dir(folder.path().join("a")).unwrap();
    assert_eq!(found(&["a"]).unwrap_err(), "no tests found: there is no `*_test.lua` in FOLDER/a");
}

#[test]
fn the_example_in_the_docs_passes() {
    let page = std::fs::read_to_string("docs/testing.md").unwrap();
    let example = page.split("```lua\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("blinker_test.lua");
    std::fs::write(&file, example).unwrap();
    let report = Report { outcomes: run_file(&file, LIMIT, |_| ()) };
    assert!(report.end().contains("2 passed, 0 failed"), "{}", report.end());
}

/// Exit code and standard output of `lrp test`.
fn lrp_test(folder: &Path, paths: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_lrp")).arg("test").args(paths).current_dir(folder).output().unwrap();
    (output.status.code(), String::from_utf8(output.stdout).unwrap())
}

#[test]
fn the_exit_code_tells_of_failures() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(lrp_test(folder.path(), &[]), (Some(1), String::new()), "no tests");
    std::fs::write(folder.path().join("a_test.lua"), "test('a', function(t) t:expect(true) end)").unwrap();
    let (code, out) = lrp_test(folder.path(), &[]);
    assert_eq!((code, out.lines().last()), (Some(0), Some("1 passed, 0 failed")));
    std::fs::write(folder.path().join("b_test.lua"), "test('b', function(t) t:expect(false) end)").unwrap();
    let (code, out) = lrp_test(folder.path(), &["."]);
    assert_eq!((code, out.lines().last()), (Some(1), Some("1 passed, 1 failed")));
    assert!(out.contains("b_test.lua:1: expected this"), "{out}");
}
