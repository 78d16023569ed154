//! The port's thread: opens it, hears what comes until it is gone, and opens it again, ever more slowly.

use std::io::{ErrorKind, Read};
use std::time::Duration;

use serialport::TTYPort;

use crate::port::{self, Opened};
use crate::settings::Line;
use crate::shared::{End, Shared};
use crate::wire::Wire;

const FIRST_PAUSE: Duration = Duration::from_millis(100);
const LONGEST_PAUSE: Duration = Duration::from_secs(2);

/// One visit after the other, until it is over.
pub fn all(shared: &Shared) {
    let (mut pause, mut told) = (FIRST_PAUSE, None);
    while let Some(line) = shared.line() {
        match visit(shared, &line) {
            (End::Over, _) => return,
            (End::Moved, _) => (pause, told) = (FIRST_PAUSE, None),
            (End::Lost(why), was_up) => {
                if was_up {
                    (pause, told) = (FIRST_PAUSE, None);
                }
                if told.as_ref() != Some(&why) {
                    shared.robot.lost(&*why);
                    shared.tell_found(port::found());
                    told = Some(why);
                }
                shared.pause(pause);
                pause = LONGEST_PAUSE.min(pause * 2);
            }
        }
    }
}

/// Why it ended, and whether the robot was up in it.
fn visit(shared: &Shared, line: &Line) -> (End, bool) {
    let Opened { port, file } = match port::open(line) {
        Ok(opened) => opened,
        Err(why) => return (End::Lost(why), false),
    };
    let wire = match port.try_clone_native() {
        Ok(same) => Wire::new(file, same, line.baud),
        Err(error) => return (End::Lost(format!("the port can't be written to: {error}")), false),
    };
    shared.robot.connecting(match &line.port {
        Some(name) => format!("{name} is open: waiting for the robot"),
        None => "the port is open: waiting for the robot".to_string(),
    });
    shared.opened(wire);
    let end = listen(shared, port);
    let was_up = shared.is_up();
    shared.closed();
    (end, was_up)
}

fn listen(shared: &Shared, mut port: TTYPort) -> End {
    let mut bytes = [0; 4096];
    loop {
        let count = match port.read(&mut bytes) {
            Ok(0) => return End::Lost("the port is gone: unplugged?".into()),
            Ok(count) => count,
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => 0,
            Err(error) => return End::Lost(format!("the port is gone: unplugged? ({error})")),
        };
        if let Some(end) = shared.hear(&bytes[..count]) {
            return end;
        }
    }
}
