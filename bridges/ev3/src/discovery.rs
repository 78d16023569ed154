//! Bricks on the network: each says every five seconds that it is there, and is answered when it is to be connected.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use lrp_bridge::Found;

use crate::settings::Wanted;

/// Where bricks are heard.
pub const PORT: u16 = 3015;

/// A brick that wasn't heard for so long is gone: four beacons.
const GONE: Duration = Duration::from_secs(20);

const ANSWER: &[u8] = b" ";

/// More bricks than any room has, and datagrams than they could send between two looks: whoever floods the port doesn't hold
/// up the robot.
const MANY: usize = 64;

/// What a brick says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Brick {
    pub name: String,
    pub serial: String,
    pub address: SocketAddr,
}

pub struct Discovery {
    socket: UdpSocket,
    heard: Vec<Heard>,
    /// The one that was answered: it may say nothing more while it is connected.
    answered: Option<String>,
    changed: bool,
}

struct Heard {
    brick: Brick,
    from: SocketAddr,
    last: Instant,
}

impl Discovery {
    pub fn open(port: u16) -> io::Result<Discovery> {
        let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, port))?;
        Ok(Discovery { socket, heard: Vec::new(), answered: None, changed: false })
    }

    /// Hears what came, and waits for a beacon if nothing did.
    pub fn listen(&mut self, wait: Duration) -> io::Result<()> {
        self.answered = None;
        self.socket.set_nonblocking(false)?;
        self.socket.set_read_timeout(Some(wait))?;
        self.hear()?;
        self.catch_up()
    }

    /// Hears what came.
    pub fn catch_up(&mut self) -> io::Result<()> {
        self.socket.set_nonblocking(true)?;
        let mut left = MANY;
        while left > 0 && self.hear()? {
            left -= 1;
        }
        let before = self.heard.len();
        let answered = self.answered.as_ref();
        self.heard.retain(|heard| heard.last.elapsed() < GONE || Some(&heard.brick.serial) == answered);
        self.changed |= self.heard.len() != before;
        Ok(())
    }

    /// The brick that is wanted, if it was heard.
    pub fn find(&self, wanted: &Wanted) -> Option<&Brick> {
        self.heard.iter().map(|heard| &heard.brick).find(|brick| wanted.fits(brick))
    }

    pub fn answer(&mut self, brick: &Brick) {
        self.answered = Some(brick.serial.clone());
        // Where it doesn't come through, the connection will fail and be tried again.
        for heard in self.heard.iter().filter(|heard| heard.brick == *brick) {
            let _ = self.socket.send_to(ANSWER, heard.from);
        }
    }

    pub fn names(&self) -> Vec<&str> {
        self.heard.iter().map(|heard| &*heard.brick.name).collect()
    }

    /// All bricks that are there, if that is news.
    pub fn news(&mut self) -> Option<Vec<Found>> {
        let found = |heard: &Heard| Found {
            name: heard.brick.name.clone(),
            what: "brick".to_string(),
            type_name: "EV3".to_string(),
            doc: format!("serial number {}, at {}", heard.brick.serial, heard.brick.address),
            setting: Some("name".to_string()),
        };
        std::mem::take(&mut self.changed).then(|| self.heard.iter().map(found).collect())
    }

    /// Whether something came; it may have been anything.
    fn hear(&mut self) -> io::Result<bool> {
        let mut bytes = [0; 512];
        let (length, from) = match self.socket.recv_from(&mut bytes) {
            Ok(received) => received,
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                return Ok(false);
            }
            // An answer that went nowhere comes back as an error of the next read.
            Err(error) if matches!(error.kind(), io::ErrorKind::ConnectionRefused | io::ErrorKind::Interrupted) => {
                return Ok(true);
            }
            Err(error) => return Err(error),
        };
        if let Some(brick) = beacon(&bytes[..length], from) {
            self.note(Heard { brick, from, last: Instant::now() });
        }
        Ok(true)
    }

    fn note(&mut self, heard: Heard) {
        let serial = &heard.brick.serial;
        if let Some(known) = self.heard.iter_mut().find(|known| known.brick.serial == *serial) {
            self.changed |= known.brick != heard.brick;
            *known = heard;
        } else if self.heard.len() < MANY {
            self.changed = true;
            self.heard.push(heard);
        }
    }
}

impl Wanted {
    fn fits(&self, brick: &Brick) -> bool {
        self.name.as_ref().is_none_or(|name| *name == brick.name)
            && self.serial.as_ref().is_none_or(|serial| *serial == brick.serial)
    }
}

/// Reads a beacon. None: it is none, or of something else than an EV3.
pub fn beacon(bytes: &[u8], from: SocketAddr) -> Option<Brick> {
    let text = std::str::from_utf8(bytes).ok()?;
    let field = |name: &str| {
        let mut fields = text.lines().filter_map(|line| line.split_once(':'));
        fields.find(|(field, _)| field.trim() == name).map(|(_, value)| value.trim())
    };
    if field("Protocol") != Some("EV3") {
        return None;
    }
    let port = field("Port")?.parse().ok()?;
    let serial = field("Serial-Number")?.to_ascii_uppercase();
    Some(Brick { name: field("Name")?.to_string(), serial, address: SocketAddr::new(from.ip(), port) })
}
