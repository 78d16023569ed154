//! Whatever a bridge does, the program goes on, and the bridge is brought back with its robot stopped.

use std::fs;
use std::path::Path;

use lrp::runtime::What;
use lrp::runtime::record::Health;
use lrp::runtime::{Command, Record};
use tempfile::TempDir;

use super::{Run, examples, plugins};

fn program(form: &str) -> String {
    format!(
        "(bridge robot unruly [diary = \"diary\" {form}])
         (var steps := [0])
         (var what := [\"\"])
         (machine m (state s (running [steps = steps + 1; if what ~= \"\" then robot.misdo{{ what = what }} what = \"\" end])))
         (spawn m s)"
    )
}

/// In a folder of its own, where its stops are written down.
fn run(form: &str) -> (Run, TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let run = Run::start(&program(form), folder.path().into(), plugins(vec![examples()]));
    (run, folder)
}

fn diary(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("diary")).unwrap_or_default();
    text.lines().map(ToString::to_string).collect()
}

fn misbehave(run: &mut Run, how: &str) {
    run.command(Command::Set { var: "what".into(), value: format!("{how:?}") });
    run.step();
}

/// It is lost with this report, comes back stopped, and the program made its steps all the while.
fn is_brought_back(how: &str, says: &str) {
    let (mut run, folder) = run("");
    misbehave(&mut run, how);
    run.step_until("its loss and return", |run| run.is_up_after(1));
    assert!(run.losses()[0].contains(says), "{how}: {:?}", run.losses());
    let diary = diary(folder.path());
    let back = diary.iter().rposition(|line| line == "connect").expect("a second connection");
    run.step_until("a stop first thing", |_| {
        self::diary(folder.path()).get(back + 1).is_some_and(|line| line == "stop")
    });
    assert!(run.value("steps").and_then(|steps| steps.as_u64()) > Some(1));
}

#[test]
fn a_crash() {
    is_brought_back("segv", "crashed (SIGSEGV)");
}

#[test]
fn an_abort() {
    is_brought_back("abort", "crashed (SIGABRT)");
}

#[test]
fn a_panic() {
    is_brought_back("panic", "panicked");
}

#[test]
fn an_exit() {
    is_brought_back("exit", "ended with code 3");
}

#[test]
fn a_hang() {
    is_brought_back("hang", "it hangs: it hasn't answered for 3 s");
}

#[test]
fn a_bridge_that_crashes_again_and_again_is_tried_ever_less() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut run = Run::prepare(&program(", first = \"abort\""), folder.path().into(), plugins(vec![examples()]));
    run.until("three losses", |run| run.losses().len() >= 3);
    let again: Vec<String> =
        run.losses().iter().filter_map(|why| Some(why.split_once("again in ")?.1.to_string())).collect();
    assert_eq!(again[..3], ["0.5 s", "1 s", "2 s"]);
}

#[test]
fn what_a_library_prints_is_no_event() {
    let (mut run, _folder) = run("");
    misbehave(&mut run, "print");
    misbehave(&mut run, "complain");
    run.step_until("its complaints", |run| run.logs().iter().any(|line| line.starts_with("complaint")));
    assert!(run.losses().is_empty(), "{:?}", run.losses());
}

#[test]
fn a_flood_is_taken_as_far_as_there_is_room() {
    let (mut run, _folder) = run("");
    misbehave(&mut run, "log");
    misbehave(&mut run, "flood");
    let is_last = |record: &Record| matches!(&record.what, What::Input { name, .. } if **name == *"other999");
    run.step_until("the flood's end", |run| run.records.iter().any(is_last));
    assert!(run.losses().is_empty(), "{:?}", run.losses());
    let lost = |line: &String| line.contains("were lost, as they came too fast");
    assert!(run.logs().iter().any(lost), "{:?}", run.logs().last());
    let inputs = run.records.iter().filter(|record| matches!(record.what, What::Input { .. }));
    let longest = inputs.map(|record| serde_json::to_string(record).expect("JSON").len()).max();
    assert!(longest < Some(2000), "records show the beginning of what is large: {longest:?}");
}

#[test]
fn a_robot_that_is_lost_fails_its_calls_and_takes_nothing_later() {
    let (mut run, _folder) = run("");
    misbehave(&mut run, "lose");
    run.step_until("the loss", |run| run.health().last().is_some_and(|last| last.0 == Health::Lost));
    assert_eq!(run.losses(), ["the cable is out"]);
}

#[test]
fn a_robot_is_stopped_when_the_program_stops_it_and_at_the_end() {
    let (mut run, folder) = run("");
    let before = diary(folder.path()).len();
    run.command(Command::Runstop);
    run.until("a stop", |_| diary(folder.path()).len() > before);
    drop(run);
    let diary = diary(folder.path());
    assert!(diary[before..].iter().filter(|line| *line == "stop").count() >= 2, "{diary:?}");
}

#[test]
fn a_bridge_whose_lrp_is_killed_stops_its_robot() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("p.lrp"), program("")).expect("a program");
    let mut lrp = std::process::Command::new(super::lrp_binary())
        .args(["run", "p.lrp", "--bridge-path"])
        .arg(examples())
        .current_dir(folder.path())
        .spawn()
        .expect("lrp");
    let until = |what: &str, holds: &dyn Fn(&[String]) -> bool| {
        let end = std::time::Instant::now() + super::PATIENCE;
        while !holds(&diary(folder.path())) {
            assert!(std::time::Instant::now() < end, "waited for {what}: {:?}", diary(folder.path()));
            std::thread::park_timeout(std::time::Duration::from_millis(2));
        }
    };
    until("it to be up", &|diary| diary.len() >= 2);
    let before = diary(folder.path()).len();
    lrp.kill().expect("a signal");
    lrp.wait().expect("its end");
    until("a stop", &|diary| diary.len() > before && diary.last().is_some_and(|line| line == "stop"));
}

#[test]
fn a_plugin_that_is_built_anew_is_taken_up() {
    let (here, folder) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let library = here.path().join("liblrp_bridge_unruly.so");
    fs::copy(examples().join("liblrp_bridge_unruly.so"), &library).expect("a copy");
    let mut run = Run::start(&program(""), folder.path().into(), plugins(vec![here.path().into()]));
    let built = here.path().join("new");
    fs::copy(examples().join("liblrp_bridge_unruly.so"), &built).expect("a copy");
    fs::rename(&built, &library).expect("a new file in its place");
    run.step_until("a second process", |_| diary(folder.path()).iter().filter(|line| *line == "connect").count() == 2);
    assert!(run.losses().is_empty(), "{:?}", run.losses());
}
