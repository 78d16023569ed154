//! The robot's end of a pseudo terminal, plugged in under a name that stays.

use std::io::{ErrorKind, Read, Write};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Health, Peer};
use lrp_bridge_serial::Serial;
use serde_json::{Value, json};
use serialport::{SerialPort, TTYPort};
use tempfile::TempDir;

const PATIENCE: Duration = Duration::from_secs(20);

/// Where robots are plugged in.
pub struct Socket {
    folder: TempDir,
}

/// A robot that is plugged in; dropped, it is unplugged.
pub struct Robot {
    ours: TTYPort,
    /// Keeps the terminal alive while nobody has it open.
    _theirs: TTYPort,
    path: PathBuf,
    heard: Vec<u8>,
}

impl Socket {
    pub fn new() -> Socket {
        Socket { folder: TempDir::new().expect("a folder") }
    }

    pub fn path(&self) -> PathBuf {
        self.folder.path().join("ttyROBOT0")
    }

    pub fn plug(&self) -> Robot {
        let (ours, theirs) = TTYPort::pair().expect("a pseudo terminal");
        symlink(theirs.name().expect("its name"), self.path()).expect("a free socket");
        Robot { ours, _theirs: theirs, path: self.path(), heard: Vec::new() }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

impl Robot {
    pub fn say(&mut self, bytes: impl AsRef<[u8]>) {
        self.ours.write_all(bytes.as_ref()).expect("a bridge that listens");
    }

    /// The next line that is sent to it.
    pub fn line(&mut self) -> String {
        let until = Instant::now() + PATIENCE;
        loop {
            if let Some(end) = self.heard.iter().position(|byte| *byte == b'\n') {
                let line: Vec<u8> = self.heard.drain(..=end).collect();
                return String::from_utf8(line).expect("a line of text").trim_end().to_string();
            }
            assert!(Instant::now() < until, "no line came, only {:?}", String::from_utf8_lossy(&self.heard));
            self.listen();
        }
    }

    /// Bytes as they come; none for a while: an empty list.
    pub fn bytes(&mut self) -> Vec<u8> {
        self.listen();
        std::mem::take(&mut self.heard)
    }

    fn listen(&mut self) {
        let mut bytes = [0; 1024];
        match self.ours.read(&mut bytes) {
            Ok(count) => self.heard.extend(&bytes[..count]),
            Err(error) if error.kind() == ErrorKind::TimedOut => {}
            Err(error) => panic!("the terminal fails: {error}"),
        }
    }
}

/// A configuration for a robot plugged in there.
pub fn config(port: &Path, rest: Value) -> Value {
    let mut config = json!({ "port": port, "codec": "lines" });
    for (key, value) in rest.as_object().expect("a table") {
        config[key] = value.clone();
    }
    config
}

/// A bridge that has opened the port and waits for the robot.
pub fn bridge(config: Value) -> Peer {
    let mut lrp = Peer::of::<Serial>();
    lrp.configure(config);
    until_open(&mut lrp);
    lrp
}

pub fn until_open(lrp: &mut Peer) {
    lrp.until("`connecting`", |event| matches!(event, Event::State { state: Health::Connecting, .. }).then_some(()));
}

pub fn until_log(lrp: &mut Peer, wanted: &str) -> String {
    lrp.until(&format!("log with `{wanted}`"), |event| match event {
        Event::Log { message, .. } if message.contains(wanted) => Some(message.clone()),
        _ => None,
    })
}
