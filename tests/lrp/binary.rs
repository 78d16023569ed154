//! The real program as a child process, started as a user starts it: what it says, how it ends, whether in good time.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

/// Far more than anything here takes; what takes longer hangs.
pub const AMPLE: Duration = Duration::from_secs(30);

/// How a run ended, and what it said.
#[derive(Debug)]
pub struct Said {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

pub fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lrp"));
    command.args(args).current_dir(folder).env("NO_COLOR", "1").stdin(Stdio::null());
    command
}

/// Runs it to its end.
pub fn lrp(folder: &Path, args: &[&str]) -> Said {
    let mut child = command(folder, args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let (out, err) = (collect(child.stdout.take().unwrap()), collect(child.stderr.take().unwrap()));
    let status = end(&mut child).unwrap_or_else(|| panic!("lrp {args:?} doesn't end"));
    Said { code: status.code(), out: out.recv().unwrap(), err: err.recv().unwrap() }
}

fn collect(mut pipe: impl Read + Send + 'static) -> Receiver<String> {
    let (tell, told) = channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        pipe.read_to_end(&mut bytes).unwrap();
        tell.send(String::from_utf8_lossy(&bytes).into_owned())
    });
    told
}

/// None: it had to be killed.
fn end(child: &mut Child) -> Option<ExitStatus> {
    let begun = Instant::now();
    while begun.elapsed() < AMPLE {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    None
}

/// A run in real time that writes its trace to standard output.
pub struct Running {
    child: Child,
    lines: Receiver<String>,
    err: Receiver<String>,
}

impl Running {
    pub fn start(folder: &Path, args: &[&str]) -> Running {
        let mut command = command(folder, &["run"]);
        command.args(args).args(["--trace", "-"]).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let (tell, lines) = channel();
        let out = BufReader::new(child.stdout.take().unwrap());
        thread::spawn(move || out.lines().map_while(Result::ok).try_for_each(|line| tell.send(line)));
        let err = collect(child.stderr.take().unwrap());
        Running { child, lines, err }
    }

    /// The next record that is as wanted; those before it are gone.
    pub fn wait_for(&self, what: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let left = AMPLE.saturating_sub(begun.elapsed());
            let line = self.lines.recv_timeout(left).unwrap_or_else(|_| panic!("no record: {what}"));
            let record: Value = serde_json::from_str(&line).unwrap();
            if wanted(&record) {
                return record;
            }
        }
    }

    pub fn wait_for_kind(&self, kind: &str) -> Value {
        self.wait_for(kind, |record| record["kind"] == kind)
    }

    /// The memory it takes now, in bytes, where the system tells.
    pub fn memory(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
        Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
    }

    pub fn signal(&self, signal: i32) {
        // SAFETY: a signal to a child that hasn't been waited for.
        assert_eq!(unsafe { libc::kill(self.child.id() as i32, signal) }, 0);
    }

    /// Its exit code, the records that were left, and what it said.
    pub fn end(mut self) -> (Option<i32>, Vec<Value>, String) {
        let status = end(&mut self.child).expect("it ends");
        let records = self.lines.iter().map(|line| serde_json::from_str(&line).unwrap()).collect();
        (status.code(), records, self.err.recv().unwrap())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
