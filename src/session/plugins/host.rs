//! The process that a library bridge lives in: loads the library and lets it speak over standard input and output. Knows
//! nothing of programs and engines.

use std::fmt::Display;
use std::io::{Write, stderr, stdout};
use std::os::fd::RawFd;
use std::path::Path;
use std::process::ExitCode;

use libloading::{Library, Symbol};
use lrp_bridge::{About, Event, PROTOCOL};

use super::copy::Copy;

type Main = extern "C" fn(RawFd, RawFd) -> i32;

/// Until lrp closes the conversation.
pub fn host(path: &Path) -> ExitCode {
    share_one_heap();
    match load(path).and_then(|library| speak(&library)) {
        Ok(code) => ExitCode::from(code),
        Err(why) => {
            // Whoever started this process reads it there.
            let _ = writeln!(stderr(), "{}: {why}", path.display());
            ExitCode::FAILURE
        }
    }
}

/// Of a heap for each of a bridge's threads, most would be holes.
fn share_one_heap() {
    #[cfg(target_env = "gnu")]
    // SAFETY: there is no other thread yet.
    unsafe {
        libc::mallopt(libc::M_ARENA_MAX, 1);
    }
}

fn load(path: &Path) -> Result<Library, String> {
    let copy = Copy::of(path)?;
    // SAFETY: the library's own initialisers run; that is what a user who puts it into a bridge folder asks for.
    unsafe { Library::new(&copy.0) }.map_err(|error| copy.explain(&error))
}

fn speak(library: &Library) -> Result<u8, String> {
    let not_a_bridge = |_| "it is a library, but no bridge: does it say `bridge!`?".to_string();
    // SAFETY: both symbols are exported by the author crate's macro, with these types.
    let (protocol, main): (Symbol<*const u32>, Symbol<Main>) = unsafe {
        (
            library.get(b"LRP_BRIDGE_PROTOCOL\0").map_err(not_a_bridge)?,
            library.get(b"lrp_bridge_main\0").map_err(not_a_bridge)?,
        )
    };
    // SAFETY: it points to a static number.
    let protocol = unsafe { **protocol };
    if protocol != PROTOCOL {
        // Says it in the one event that every version has.
        let hello = Event::Hello { protocol, about: About::default() };
        let line = serde_json::to_string(&hello).map_err(|error| error.to_string())?;
        writeln!(stdout(), "{line}").map_err(failed)?;
        return Ok(2);
    }
    let (input, output) = own_descriptors()?;
    Ok(main(input, output) as u8)
}

/// The conversation on descriptors of its own: what a library prints by mistake goes to standard error.
fn own_descriptors() -> Result<(RawFd, RawFd), String> {
    let fine = |result: RawFd| if result < 0 { Err(failed(std::io::Error::last_os_error())) } else { Ok(result) };
    // SAFETY: plain system calls on descriptors that this process was started with.
    unsafe {
        let (input, output) = (fine(libc::dup(0))?, fine(libc::dup(1))?);
        fine(libc::dup2(2, 1))?;
        Ok((input, output))
    }
}

fn failed(error: impl Display) -> String {
    format!("the conversation can't begin: {error}")
}
