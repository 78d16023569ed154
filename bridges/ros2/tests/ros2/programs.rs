//! Whole programs: lrp itself, with this bridge, and a robot of rclpy.

use std::io::{BufRead, BufReader, Lines};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use crate::peers;
use crate::world::enter;

/// Ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Where cargo builds.
fn target() -> PathBuf {
    let deps = std::env::current_exe().expect("this program");
    deps.parent().and_then(Path::parent).expect("a target folder").to_path_buf()
}

fn built(path: PathBuf) -> PathBuf {
    assert!(path.exists(), "{} is missing: run the tests by `cargo test --workspace`", path.display());
    path
}

pub fn lrp() -> PathBuf {
    built(target().join("lrp"))
}

/// Where the tests of this package leave it.
pub fn library() -> PathBuf {
    built(target().join("deps/liblrp_bridge_ros2.so"))
}

/// lrp, running a program with this bridge.
pub struct Program {
    lrp: Running,
    records: Lines<BufReader<ChildStdout>>,
    file: PathBuf,
    _folder: TempDir,
}

impl Program {
    /// Written into a folder of its own.
    pub fn start(text: &str) -> Program {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("program.lrp");
        std::fs::write(&file, text).expect("a program");
        let mut lrp = Command::new(lrp())
            .arg("run")
            .arg(&file)
            .arg("--bridge-path")
            .arg(library().with_file_name(""))
            .args(["--trace", "-", "--for", "90s"])
            .stdout(Stdio::piped())
            .spawn()
            .expect("lrp");
        let records = BufReader::new(lrp.stdout.take().expect("its records")).lines();
        Program { lrp: Running(lrp), records, file, _folder: folder }
    }

    /// What happens next, which is no error. None: lrp has ended.
    pub fn record(&mut self) -> Option<Value> {
        let record: Value = serde_json::from_str(&self.records.next()?.ok()?).expect("a record");
        assert_ne!(record["kind"], "error", "{record}");
        Some(record)
    }

    /// The next record of a kind that fits.
    pub fn until(&mut self, kind: &str, fits: impl Fn(&Value) -> bool) -> Value {
        let mut seen = Vec::new();
        while let Some(record) = self.record() {
            if record["kind"] == kind && fits(&record) {
                return record;
            }
            seen.push(record.to_string());
        }
        panic!("there was no such `{kind}`, but at last\n{}", seen[seen.len().saturating_sub(20)..].join("\n"));
    }

    pub fn until_in(&mut self, state: &str) {
        self.until("enter", |record| record["state"] == state);
    }

    /// A save while it runs.
    pub fn save(&self, text: &str) {
        std::fs::write(&self.file, text).expect("an edit");
    }

    pub fn id(&self) -> u32 {
        self.lrp.0.id()
    }
}

#[test]
fn the_line_follower_of_the_simulator_finishes_on_a_robot_of_ros() {
    let Some(()) = enter("programs::the_line_follower_of_the_simulator_finishes_on_a_robot_of_ros") else { return };
    let source = std::fs::read_to_string(peers::behavior("line_follower.lrp")).expect("the line follower");
    let form = r#"(bridge robot ros2 [
        subscribe = { light = "/light", bumper = "/bumper" },
        publish = { move = "/cmd_vel geometry_msgs/msg/Twist" },
        stale = 500 ])"#;
    let ours = source.replace(r#"(bridge robot sim [ world = "worlds/curve.world" ])"#, form);
    assert_ne!(ours, source);
    let _robot = Running(peers::python("robot.py").expect("a robot").spawn().expect("python"));
    let mut lrp = Program::start(&ours);
    let (mut bumps, mut is_edited) = (0, false);
    while let Some(record) = lrp.record() {
        match record["state"].as_str().filter(|_| record["kind"] == "enter") {
            Some("follower/bumpback") => {
                bumps += 1;
                // Edited on the way: faster from here on.
                lrp.save(&ours.replace("forward := [0.2]", "forward := [0.3]"));
            }
            Some("follower/finished") => {
                assert!(bumps == 1 && is_edited, "{bumps} bumps, edited: {is_edited}");
                return;
            }
            _ => is_edited |= bumps == 1 && record["kind"] == "load",
        }
    }
    panic!("it never finished: {bumps} bumps");
}
