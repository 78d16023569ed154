//! Lends the terminal to another program until it ends, as a shell does: Ctrl-C and Ctrl-Z there are its own affair.
//! Knows nothing of what program it is.

use std::io;
use std::mem::MaybeUninit;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Command, ExitStatus};
use std::ptr;

use libc::pid_t;

/// Runs it to its end in a process group of its own. There is no shell to come back from, so if it stops itself it is
/// continued at once.
pub fn run(command: &mut Command) -> io::Result<ExitStatus> {
    let child = command.process_group(0).spawn()?;
    let group = child.id() as pid_t;
    // Where it has ended already, nothing is to be lent.
    let _ = lend_terminal(group);
    let status = wait(group);
    // SAFETY: no memory is involved.
    let own = unsafe { libc::getpgrp() };
    lend_terminal(own)?;
    status
}

fn wait(group: pid_t) -> io::Result<ExitStatus> {
    loop {
        let mut status = 0;
        // SAFETY: the status is ours to write to; the process is our child and not waited for elsewhere.
        if unsafe { libc::waitpid(group, &mut status, libc::WUNTRACED) } < 0 {
            let error = io::Error::last_os_error();
            if error.kind() == io::ErrorKind::Interrupted {
                continue;
            }
            return Err(error);
        }
        if !libc::WIFSTOPPED(status) {
            return Ok(ExitStatus::from_raw(status));
        }
        // It may have stopped for want of the terminal, having been faster than we.
        lend_terminal(group)?;
        // SAFETY: no memory is involved; the group is our child's.
        unsafe { libc::killpg(group, libc::SIGCONT) };
    }
}

/// Makes this process group the one that the terminal listens to.
fn lend_terminal(group: pid_t) -> io::Result<()> {
    // A process that isn't in front would be stopped for this, unless it blocks the signal.
    // SAFETY: both sets are ours, and initialised before they are read.
    unsafe {
        let mut blocked = MaybeUninit::uninit();
        let mut before = MaybeUninit::uninit();
        libc::sigemptyset(blocked.as_mut_ptr());
        libc::sigaddset(blocked.as_mut_ptr(), libc::SIGTTOU);
        libc::pthread_sigmask(libc::SIG_BLOCK, blocked.as_ptr(), before.as_mut_ptr());
        let lent = libc::tcsetpgrp(libc::STDIN_FILENO, group);
        let error = io::Error::last_os_error();
        libc::pthread_sigmask(libc::SIG_SETMASK, before.as_ptr(), ptr::null_mut());
        if lent == 0 { Ok(()) } else { Err(error) }
    }
}
