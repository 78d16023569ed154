//! `lrp test`: behaviour tests in virtual time. Each `*_test.lua` is run in an interpreter of its own; what it found is told
//! line by line, and how each failure came about after them.

mod api;
mod bench;
mod calls;
mod deadline;
mod failure;
mod functions;
mod lua;
mod message;
mod options;
mod readable;
mod report;
mod search;
mod suite;
mod value;
mod why;
mod written;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

pub use report::{Outcome, Report};
pub use search::{NoTests, test_files};

/// How long a test may take in real time before it is stopped.
pub const LIMIT: Duration = Duration::from_secs(30);

/// Runs the tests of files and folders, of the current folder where none is named. Exit code 1: a test failed, or there is none.
pub fn run(paths: &[PathBuf]) -> ExitCode {
    let files = match test_files(paths) {
        Ok(files) => files,
        Err(why) => {
            let _ = writeln!(io::stderr(), "lrp: {why}");
            return ExitCode::FAILURE;
        }
    };
    let mut report = Report::default();
    for file in &files {
        report.outcomes.extend(run_file(file, LIMIT, |outcome| say(&outcome.line())));
    }
    say(&report.end());
    ExitCode::from(u8::from(report.failed() > 0))
}

/// Runs the tests of one file, telling of each as it ends. `limit`: how long each may take in real time.
pub fn run_file(file: &Path, limit: Duration, on: impl FnMut(&Outcome)) -> Vec<Outcome> {
    suite::run(file, limit, on)
}

/// To standard output, which may have been closed by a reader that has seen enough.
fn say(text: &str) {
    let mut out = io::stdout().lock();
    let _ = writeln!(out, "{text}").and_then(|()| out.flush());
}
