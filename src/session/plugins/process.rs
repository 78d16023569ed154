//! One process of a bridge: its pipes, and what is heard of it. Whoever holds it decides when it has to go.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::thread::{Builder, sleep};
use std::time::{Duration, Instant};

use lrp_bridge::{End, Event, Orders};

use super::folders::{Plugin, PluginForm};

/// A longer line is no message.
const LINE: u64 = 16 << 20;
/// Bytes a second that are read; a bridge that says more waits.
const FLOW: usize = 64 << 20;
/// Of a line that is shown: one that should have been an event, or a complaint, which may name files.
const GARBAGE: usize = 120;
const COMPLAINT: usize = 400;

pub struct Process {
    child: Child,
    orders: Arc<Orders>,
}

/// What is heard of a process, from its threads.
#[derive(Debug)]
pub enum Heard {
    /// With the length of its line.
    Event(Event, usize),
    /// A line that is no event.
    Garbage(String),
    /// A line without an end.
    TooLong,
    /// A line on standard error.
    Complaint(String),
    /// It has closed its standard error.
    Mute,
    /// It has closed its standard output.
    Closed,
}

impl Process {
    /// `heard` is called from the process's threads; it may wait, and then the process does.
    pub fn start(plugin: &Plugin, host: &Path, heard: impl Fn(Heard) + Clone + Send + 'static) -> io::Result<Process> {
        let mut command = match plugin.form {
            PluginForm::Program => Command::new(&plugin.path),
            PluginForm::Library => {
                let mut command = Command::new(host);
                command.arg("bridge-host").arg(&plugin.path);
                command
            }
        };
        // A group of its own: Ctrl-C in the terminal is lrp's to answer, which stops the robot first.
        command.process_group(0).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let process = Process { child, orders: Arc::default() };
        let (Some(input), Some(output), Some(errors)) = pipes else { return Ok(process) };
        let (orders, tell) = (Arc::clone(&process.orders), heard.clone());
        spawn("bridge orders", move || write(input, &orders))?;
        spawn("bridge events", move || read(output, &tell))?;
        spawn("bridge errors", move || complaints(errors, &heard))?;
        Ok(process)
    }

    pub fn orders(&self) -> &Arc<Orders> {
        &self.orders
    }

    /// Closes the conversation: what was put before a moment ago may still be said.
    pub fn close(&self) {
        self.orders.end(End::Closed);
    }

    /// Waits for its end, but no longer than that.
    pub fn ended_within(&mut self, patience: Duration) -> Option<ExitStatus> {
        let end = Instant::now() + patience;
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if Instant::now() < end => sleep(Duration::from_millis(5)),
                _ => return None,
            }
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.close();
        // It may have ended already; its remains are cleared away in either case.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn spawn(name: &str, body: impl FnOnce() + Send + 'static) -> io::Result<()> {
    Builder::new().name(name.to_string()).stack_size(256 << 10).spawn(body).map(drop)
}

fn write(mut input: ChildStdin, orders: &Orders) {
    let mut line = Vec::new();
    while let Ok(order) = orders.take() {
        line.clear();
        // Names as keys and plain data: it can't fail to be written.
        if serde_json::to_writer(&mut line, &order).is_err() {
            continue;
        }
        line.push(b'\n');
        if input.write_all(&line).is_err() {
            return;
        }
    }
    // The input closes with the pipe: the bridge stops its robot and ends.
}

fn read(output: impl Read, heard: &dyn Fn(Heard)) {
    let mut output = BufReader::with_capacity(64 << 10, output);
    let mut flow = Flow::new();
    let mut line = Vec::new();
    loop {
        line.clear();
        match output.by_ref().take(LINE).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return heard(Heard::Closed),
            Ok(length) if length as u64 == LINE && !line.ends_with(b"\n") => return heard(Heard::TooLong),
            Ok(length) => flow.take(length),
        }
        heard(match serde_json::from_slice(&line) {
            Ok(event) => Heard::Event(event, line.len()),
            Err(_) => Heard::Garbage(shown(&line, GARBAGE)),
        });
    }
}

fn complaints(errors: impl Read, heard: &dyn Fn(Heard)) {
    let mut errors = BufReader::new(errors);
    let mut flow = Flow::new();
    let mut line = Vec::new();
    loop {
        line.clear();
        match errors.by_ref().take(4096).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return heard(Heard::Mute),
            Ok(length) => flow.take(length),
        }
        heard(Heard::Complaint(shown(&line, COMPLAINT)));
    }
}

fn shown(line: &[u8], most: usize) -> String {
    let text = String::from_utf8_lossy(line);
    let text = text.trim_end();
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

/// Keeps what is read to so much a second.
struct Flow {
    since: Instant,
    bytes: usize,
}

impl Flow {
    fn new() -> Flow {
        Flow { since: Instant::now(), bytes: 0 }
    }

    fn take(&mut self, bytes: usize) {
        self.bytes += bytes;
        let second = Duration::from_secs(1);
        let passed = self.since.elapsed();
        if passed < second && self.bytes > FLOW {
            sleep(second - passed);
        }
        if passed >= second || self.bytes > FLOW {
            *self = Flow::new();
        }
    }
}

/// `crashed (SIGSEGV)`, `ended with code 3`
pub fn how_it_ended(status: ExitStatus) -> String {
    let signal = |signal| match signal {
        libc::SIGSEGV => "SIGSEGV".to_string(),
        libc::SIGBUS => "SIGBUS".to_string(),
        libc::SIGABRT => "SIGABRT".to_string(),
        libc::SIGILL => "SIGILL".to_string(),
        libc::SIGFPE => "SIGFPE".to_string(),
        libc::SIGKILL => "SIGKILL".to_string(),
        libc::SIGTERM => "SIGTERM".to_string(),
        other => format!("signal {other}"),
    };
    match (status.code(), status.signal()) {
        (Some(101), _) => "panicked".to_string(),
        (Some(0), _) => "ended".to_string(),
        (Some(code), _) => format!("ended with code {code}"),
        (None, Some(number)) => format!("crashed ({})", signal(number)),
        (None, None) => "ended".to_string(),
    }
}
