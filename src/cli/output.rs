//! How commands speak: what was asked for on standard output, the rest on standard error. Either may have been closed by
//! a reader that has seen enough, as in `| head`: that is no fault.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;

/// Prints what was asked for; the exit code is `code` unless it can't be written.
pub fn finish(text: &str, code: ExitCode) -> ExitCode {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            fail(format_args!("standard output can't be written: {error}"))
        }
        _ => code,
    }
}

/// Says what went wrong.
pub fn complain(what: impl Display) {
    // There is nowhere else to say it.
    let _ = writeln!(io::stderr(), "lrp: {what}");
}

/// Says what went wrong; the exit code for that.
pub fn fail(what: impl Display) -> ExitCode {
    complain(what);
    ExitCode::FAILURE
}
