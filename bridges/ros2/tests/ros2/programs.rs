//! Whole programs: lrp itself, with this bridge, and a robot of rclpy.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use serde_json::Value;

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

/// lrp, running a program.
fn run(program: &Path) -> Command {
    let mut command = Command::new(lrp());
    command.arg("run").arg(program).arg("--bridge-path").arg(library().with_file_name(""));
    command.args(["--trace", "-", "--for", "90s"]);
    command
}

#[test]
fn the_line_follower_of_the_simulator_finishes_on_a_robot_of_ros() {
    let Some(()) = enter("programs::the_line_follower_of_the_simulator_finishes_on_a_robot_of_ros") else { return };
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../behaviors/line_follower.lrp");
    let source = std::fs::read_to_string(source).expect("the line follower");
    let form = r#"(bridge robot ros2 [
        subscribe = { light = "/light", bumper = "/bumper" },
        publish = { move = "/cmd_vel geometry_msgs/msg/Twist" },
        stale = 500 ])"#;
    let ours = source.replace(r#"(bridge robot sim [ world = "worlds/curve.world" ])"#, form);
    assert_ne!(ours, source);
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("line_follower.lrp");
    std::fs::write(&program, &ours).expect("a program");
    let _robot = Running(peers::python("robot.py").expect("a robot").spawn().expect("python"));
    let mut lrp = Running(run(&program).stdout(Stdio::piped()).spawn().expect("lrp"));
    let records = BufReader::new(lrp.0.stdout.take().expect("its records")).lines();
    let (mut bumps, mut is_edited) = (0, false);
    for record in records.map_while(Result::ok) {
        let record: Value = serde_json::from_str(&record).expect("a record");
        assert_ne!(record["kind"], "error", "{record}");
        match record["state"].as_str().filter(|_| record["kind"] == "enter") {
            Some("follower/bumpback") => {
                bumps += 1;
                // Edited on the way: faster from here on.
                std::fs::write(&program, ours.replace("forward := [0.2]", "forward := [0.3]")).expect("an edit");
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
