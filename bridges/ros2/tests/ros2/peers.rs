//! The real rclpy and Cyclone DDS: the Python programs of `tests/peers`, where these are installed.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A program of the peers' folder.
pub fn python(program: &str) -> Option<Command> {
    let mut command = Command::new(lrp_peers::python("ros2")?);
    command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers").join(program));
    Some(command)
}

/// A behaviour of those that come with lrp, or what is there with them.
pub fn behavior(name: &str) -> PathBuf {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the workspace");
    workspace.join("behaviors").join(name)
}

/// The robot that is driven as Nav2 does it. Nav2's interfaces are in no package of Python's: they are made of ours.
pub fn navigation() -> Option<Command> {
    lrp_peers::python_with("ros2", &behavior("ros2/interfaces"))?;
    python("navigation.py")
}

/// The `share` folder of the ROS that the peers are.
pub fn share() -> Option<PathBuf> {
    let python = lrp_peers::python("ros2")?;
    Some(python.parent()?.parent()?.join("share"))
}

/// What a program says that is given this text.
pub fn feed(command: &mut Command, text: &str) -> String {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("python");
    let mut stdin = child.stdin.take().expect("its input");
    let text = text.to_string();
    let writer = std::thread::spawn(move || stdin.write_all(text.as_bytes()));
    let said = child.wait_with_output().expect("its end");
    assert!(said.status.success());
    writer.join().expect("a writer").expect("all read");
    String::from_utf8(said.stdout).expect("text")
}
