//! Signals sent to this very process reach the callback.

use std::sync::mpsc;
use std::time::Duration;

use lrp::session::signals::{Signal, Signals};

#[test]
fn each_signal_is_handed_on_by_name() {
    let (tell, told) = mpsc::channel();
    let signals = Signals::watch(move |signal| tell.send(signal).unwrap()).unwrap();
    for (number, name) in [
        (libc::SIGINT, Signal::Interrupt),
        (libc::SIGTERM, Signal::Terminate),
        (libc::SIGHUP, Signal::HangUp),
        (libc::SIGTSTP, Signal::Suspend),
        (libc::SIGCONT, Signal::Continue),
    ] {
        signal_hook::low_level::raise(number).unwrap();
        assert_eq!(told.recv_timeout(Duration::from_secs(10)), Ok(name));
    }
    drop(signals);
    assert!(told.recv().is_err(), "the thread is gone, and the callback with it");
}
