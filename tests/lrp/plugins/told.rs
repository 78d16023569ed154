//! What bridges are told of the program that want to know, and what they may do to it.

use std::fs;
use std::path::Path;

use lrp::runtime::Command;
use serde_json::json;

use super::{Run, examples, plugins};

const PROGRAM: &str = "(bridge robot unruly [diary = \"diary\", watches = true])
    (var goal := [1])
    (var what := [\"\"])
    (machine m
      (var n := [0])
      (state s (running [if what ~= \"\" then robot.misdo{ what = what } what = \"\" end]))
      (state t (onentry [n = 5 log.warn(\"there\")]))
      (on [goal == 7] s -> t))
    (spawn m s)";

fn diary(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("diary")).unwrap_or_default();
    text.lines().map(ToString::to_string).collect()
}

#[test]
fn variables_and_states_as_they_change() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut run = Run::start(PROGRAM, folder.path().into(), plugins(vec![examples()]));
    let noted = |line: &str| diary(folder.path()).iter().any(|known| known == line);
    run.until("all of them", |_| noted("variables goal=1 what=\"\" m/n=0") && noted("states 0 m/s@0"));
    run.step();
    run.command(Command::Set { var: "goal".into(), value: "7".into() });
    run.until("what changed", |_| noted("variables goal=7"));
    run.step_until("what followed", |_| noted("variables m/n=5") && noted("states 200 m/t@200"));
    run.until("what it logged", |_| noted("log Warn there Some(\"m/t\")"));
}

#[test]
fn a_robot_may_set_a_variable_and_learns_what_came_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut run = Run::start(PROGRAM, folder.path().into(), plugins(vec![examples()]));
    run.command(Command::Set { var: "what".into(), value: "\"set\"".into() });
    run.step_until("its value", |run| run.value("goal") == Some(json!(7)));
    let answers = || diary(folder.path()).into_iter().filter(|line| line.starts_with("answer")).collect::<Vec<_>>();
    run.until("two answers", |_| answers().len() == 2);
    assert_eq!(answers()[0], "answer 1 ");
    assert!(answers()[1].contains("gaol"), "{:?}", answers());
}

#[test]
fn a_robots_clock_is_there_once_it_tells_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut run = Run::start(PROGRAM, folder.path().into(), plugins(vec![examples()]));
    assert_eq!(run.driver.robots_time(), None);
    run.command(Command::Set { var: "what".into(), value: "\"clock\"".into() });
    run.step_until("the clock", |run| run.driver.robots_time().is_some());
    assert_eq!(run.driver.robots_time().map(|time| time.as_millis()), Some(1000));
}
