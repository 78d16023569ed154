//! A connection to a brick: unlocked, one request at a time, each answered within a second or the connection is given up.

use std::fmt::{self, Display, Formatter};
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use crate::command::Command;
use crate::frame::{self, LONGEST, Verdict};

const CONNECT: Duration = Duration::from_secs(3);

/// How long the brick may take to accept a client. It doesn't answer a second one at all.
const ACCEPT: Duration = Duration::from_secs(2);

const ANSWER: Duration = Duration::from_secs(1);

pub struct Link {
    stream: TcpStream,
    counter: u16,
}

/// Why a request came to nothing.
#[derive(Debug)]
pub enum Trouble {
    /// The brick answered that it couldn't. The connection is good.
    Refused,
    InUse,
    Silent,
    Closed,
    Garbled,
    Broken(io::Error),
}

impl Link {
    /// Connects and unlocks. What is sent together with the unlock is lost, so this waits for its answer.
    pub fn open(address: SocketAddr, serial: &str) -> Result<Link, Trouble> {
        let stream = TcpStream::connect_timeout(&address, CONNECT)?;
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(ANSWER))?;
        let mut link = Link { stream, counter: 0 };
        link.stream.write_all(&unlock(serial))?;
        let mut answer = Vec::new();
        let end = Instant::now() + ACCEPT;
        while !answer.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            link.read(&mut byte, end).map_err(|trouble| match trouble {
                Trouble::Silent | Trouble::Closed => Trouble::InUse,
                trouble => trouble,
            })?;
            answer.extend(byte);
            if answer.len() > LONGEST {
                return Err(Trouble::Garbled);
            }
        }
        if answer.starts_with(b"Accept:") { Ok(link) } else { Err(Trouble::Garbled) }
    }

    /// Sends a command and waits for what the brick answers.
    pub fn ask(&mut self, command: &Command) -> Result<Vec<u8>, Trouble> {
        self.send(command)?;
        let end = Instant::now() + ANSWER;
        loop {
            let bytes = self.receive(end)?;
            let reply = frame::reply(&bytes).ok_or(Trouble::Garbled)?;
            match reply.verdict {
                _ if reply.counter != self.counter => {}
                Verdict::Done => return Ok(reply.answer.to_vec()),
                Verdict::Refused => return Err(Trouble::Refused),
            }
        }
    }

    /// Sends a command that nobody waits for. In one write: a brick that gets half of a length never recovers.
    pub fn send(&mut self, command: &Command) -> Result<(), Trouble> {
        self.counter = self.counter.wrapping_add(1);
        self.stream.write_all(&frame::command(self.counter, command))?;
        Ok(())
    }

    fn receive(&mut self, end: Instant) -> Result<Vec<u8>, Trouble> {
        let mut length = [0; 2];
        self.read(&mut length, end)?;
        let length = usize::from(u16::from_le_bytes(length));
        if length > LONGEST {
            return Err(Trouble::Garbled);
        }
        let mut bytes = vec![0; length];
        self.read(&mut bytes, end)?;
        Ok(bytes)
    }

    /// Fills the buffer before the end.
    fn read(&mut self, mut buffer: &mut [u8], end: Instant) -> Result<(), Trouble> {
        while !buffer.is_empty() {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(Trouble::Silent);
            }
            self.stream.set_read_timeout(Some(left))?;
            match self.stream.read(buffer) {
                Ok(0) => return Err(Trouble::Closed),
                Ok(read) => buffer = &mut buffer[read..],
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }
}

/// What a brick wants to hear first.
pub fn unlock(serial: &str) -> Vec<u8> {
    format!("GET /target?sn={serial}VMTP1.0\nProtocol: EV3").into_bytes()
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Trouble {
        match error.kind() {
            io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => Trouble::Silent,
            io::ErrorKind::ConnectionReset | io::ErrorKind::BrokenPipe => Trouble::Closed,
            _ => Trouble::Broken(error),
        }
    }
}

impl Display for Trouble {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Trouble::Refused => f.write_str("the brick refuses commands; close the dialog on its screen"),
            Trouble::InUse => f.write_str("the brick is in use by another client, or still busy with the last one"),
            Trouble::Silent => f.write_str("the brick doesn't answer"),
            Trouble::Closed => f.write_str("the brick closed the connection"),
            Trouble::Garbled => f.write_str("what answers there doesn't speak as an EV3 brick does"),
            Trouble::Broken(error) => write!(f, "{error}"),
        }
    }
}
