//! While lrp's own process is stopped, as by Ctrl-Z, nobody steers the robot: it stands still.

use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::{PATIENCE, examples, lrp_binary};

/// `lrp run` with a robot that writes down what it is told.
struct Lrp {
    process: Child,
    folder: TempDir,
    says: Arc<Mutex<String>>,
}

impl Lrp {
    /// Drives with each step, from the moment its robot is there.
    fn drives(rate: &str) -> Lrp {
        let program = "(bridge robot unruly [diary = \"diary\"])
            (machine m (state s (running [robot.misdo{ what = \"drive\" }])))
            (spawn m s)";
        let lrp = Lrp::run(program, rate, |_| {});
        lrp.until("it to drive", |lrp| lrp.diary().last().is_some_and(|last| last == "drive"));
        lrp
    }

    fn run(program: &str, rate: &str, prepare: impl FnOnce(&TempDir)) -> Lrp {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("p.lrp"), program).expect("a program");
        prepare(&folder);
        let mut lrp = Command::new(lrp_binary());
        lrp.args(["run", "p.lrp", "--rate", rate, "--bridge-path"]).arg(examples()).arg("--bridge-path");
        lrp.arg(folder.path()).current_dir(folder.path()).stderr(Stdio::piped());
        // As a shell does it: only then Ctrl-Z stops it.
        let mut process = lrp.process_group(0).spawn().expect("lrp");
        let (says, errors) = (Arc::<Mutex<String>>::default(), process.stderr.take().expect("a pipe"));
        let hears = Arc::clone(&says);
        thread::spawn(move || {
            for line in BufReader::new(errors).lines().map_while(Result::ok) {
                hears.lock().expect("a test that goes on").push_str(&(line + "\n"));
            }
        });
        Lrp { process, folder, says }
    }

    fn diary(&self) -> Vec<String> {
        let text = fs::read_to_string(self.folder.path().join("diary")).unwrap_or_default();
        text.lines().map(ToString::to_string).collect()
    }

    fn says(&self, what: &str) -> bool {
        self.says.lock().expect("a test that goes on").contains(what)
    }

    fn until(&self, what: &str, holds: impl Fn(&Lrp) -> bool) {
        let end = Instant::now() + PATIENCE;
        while !holds(self) {
            let (says, diary) = (self.says.lock().expect("a test that goes on"), self.diary());
            assert!(Instant::now() < end, "waited for {what}: {says}{:?}", &diary[diary.len().saturating_sub(9)..]);
            thread::park_timeout(Duration::from_millis(1));
        }
    }

    fn signal(&self, signal: i32) {
        // SAFETY: no memory is involved; the process is our child and not waited for yet.
        assert_eq!(unsafe { libc::kill(self.process.id() as i32, signal) }, 0);
    }

    fn is_stopped(&self) -> bool {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.process.id())).expect("a process");
        stat.rsplit(')').next().is_some_and(|fields| fields.starts_with(" T"))
    }
}

#[test]
fn a_program_whose_lrp_was_stopped_sees_what_is_now() {
    let program = "(bridge robot unruly [diary = \"diary\"])
        (machine m (state s (running [log.info(\"beat \" .. robot.beat.count)])))
        (spawn m s)";
    let lrp = Lrp::run(program, "50", |_| {});
    let beats = |lrp: &Lrp| -> Vec<u64> {
        let says = lrp.says.lock().expect("a test that goes on");
        says.lines().filter_map(|line| line.strip_prefix("info: beat ")?.parse().ok()).collect()
    };
    lrp.until("its first ping, from which on it is missed", |lrp| beats(lrp).last() > Some(&20));
    let stops = lrp.diary().len();
    lrp.signal(libc::SIGSTOP);
    lrp.until("three seconds of silence", |lrp| lrp.diary().len() > stops);
    let before = beats(&lrp);
    lrp.signal(libc::SIGCONT);
    lrp.until("a step", |lrp| beats(lrp).len() > before.len());
    let (last, next) = (before[before.len() - 1], beats(&lrp)[before.len()]);
    assert!(next > last + 20, "ten a second, and it was stopped for about three: {last}, then {next}");
}

/// Answers its first ping after four and a half seconds.
const SLOW: &str = r#"#!/bin/sh
echo '{"event":"hello","protocol":1,"kind":"slow","version":"1","summary":""}'
while read -r line; do
  case $line in
    *describe*) echo '{"event":"offer"}' ;;
    *configure*) echo '{"event":"offer"}'; echo '{"event":"state","state":"up"}' ;;
    *ping*)
      test -e pinged || { touch pinged; sleep 4; touch late; sleep 0.5; }
      echo '{"event":"pong","id":1}'
      test -e answered && touch "answered again"
      touch answered ;;
  esac
done
"#;

#[test]
fn a_bridge_is_not_blamed_for_what_lrp_was_too_late_to_hear() {
    let program = "(bridge robot slow) (machine m (state s)) (spawn m s)";
    let lrp = Lrp::run(program, "10", |folder| {
        let path = folder.path().join("lrp-bridge-slow.sh");
        fs::write(&path, SLOW).expect("a script");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("a script to run");
    });
    let exists = |name: &str| lrp.folder.path().join(name).exists();
    lrp.until("a ping", |_| exists("pinged"));
    lrp.signal(libc::SIGSTOP);
    lrp.until("more than a bridge's time to answer", |_| exists("late"));
    lrp.signal(libc::SIGCONT);
    lrp.until("two answers", |_| exists("answered again"));
    assert!(!lrp.says("lost"));
}

impl Drop for Lrp {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[test]
fn the_robot_stands_still_before_ctrl_z_stops_lrp() {
    let lrp = Lrp::drives("200");
    for _ in 0..10 {
        let before = lrp.diary().len();
        lrp.signal(libc::SIGTSTP);
        lrp.until("it to be stopped", Lrp::is_stopped);
        let diary = lrp.diary();
        assert_eq!(diary.last().map(String::as_str), Some("stop"), "{:?}", &diary[before..]);
        lrp.signal(libc::SIGCONT);
        lrp.until("it to drive again", |lrp| lrp.diary().last().is_some_and(|last| last == "drive"));
    }
}

#[test]
fn the_robot_is_stopped_when_lrp_is_stopped_unheard() {
    let lrp = Lrp::drives("10");
    // Only from its first ping on it is missed.
    lrp.until("some seconds of driving", |lrp| lrp.diary().len() > 15);
    lrp.signal(libc::SIGSTOP);
    lrp.until("it to stop", |lrp| lrp.diary().last().is_some_and(|last| last == "stop"));
    lrp.signal(libc::SIGCONT);
    lrp.until("it to drive again", |lrp| lrp.diary().last().is_some_and(|last| last == "drive"));
    lrp.until("why it was stopped", |lrp| {
        lrp.says("warn: the robot was stopped: lrp was held up, and said nothing for 3 s")
    });
    assert!(!lrp.says("lost"), "the bridge wasn't held up");
}
