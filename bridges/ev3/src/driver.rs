//! The brick's thread: finds the brick, connects, visits it, and does so again when it is lost.

use std::fmt::{self, Display, Formatter};
use std::io;
use std::net::{SocketAddr, ToSocketAddrs};
use std::sync::Arc;
use std::time::{Duration, Instant};

use lrp_bridge::{Level, Robot};

use crate::desk::Desk;
use crate::discovery::Discovery;
use crate::link::{Link, Trouble};
use crate::moves::Modes;
use crate::settings::{Place, Settings, Wanted};
use crate::visit::Visit;

/// Pauses between attempts: each is twice the last.
const FIRST_PAUSE: Duration = Duration::from_millis(250);
const LONGEST_PAUSE: Duration = Duration::from_secs(4);

/// How long a brick may not be heard before that is said: two beacons.
const HEARING: Duration = Duration::from_secs(11);

/// How long one look for beacons takes.
const LOOK: Duration = Duration::from_millis(200);

pub struct Driver {
    desk: Arc<Desk>,
    robot: Robot,
    settings: Settings,
    modes: Modes,
    discovery: Option<Discovery>,
    /// The brick that was taken because it was the only one heard: it stays that one.
    taken: Option<String>,
    /// What was said last of a connection that is not there.
    said: String,
}

/// Why there is no connection.
struct Lost {
    why: String,
    was_up: bool,
}

/// Where a brick is, and what it is called.
struct Target {
    address: SocketAddr,
    serial: String,
    name: String,
}

impl Driver {
    pub fn new(desk: Arc<Desk>, robot: Robot) -> Driver {
        let settings = desk.settings();
        let mut modes = Modes::default();
        modes.settle(&[const { None }; 4], &settings.modes);
        Driver { desk, robot, settings, modes, discovery: None, taken: None, said: String::new() }
    }

    pub fn run(mut self) {
        let mut pause = Duration::ZERO;
        while self.desk.rest(pause) {
            self.take_settings();
            pause = match self.visit() {
                Ok(()) => Duration::ZERO,
                Err(Lost { why, was_up }) => {
                    self.tell_lost(why);
                    if was_up { FIRST_PAUSE } else { (pause * 2).clamp(FIRST_PAUSE, LONGEST_PAUSE) }
                }
            };
        }
    }

    fn take_settings(&mut self) {
        let settings = self.desk.settings();
        if settings.place != self.settings.place {
            (self.discovery, self.taken) = (None, None);
            self.said.clear();
        }
        self.modes.settle(&self.settings.modes, &settings.modes);
        self.settings = settings;
    }

    /// Connects and stays until it is lost, or there are other settings, or it is over.
    fn visit(&mut self) -> Result<(), Lost> {
        let Some(target) = self.target().map_err(Lost::before)? else { return Ok(()) };
        let link = Link::open(target.address, &target.serial)
            .map_err(|trouble| Lost::before(format!("{trouble}; tried {}", target.address)))?;
        let mut visit = Visit::new(&self.desk, &self.robot, &mut self.settings, &mut self.modes, link);
        visit.discovery = self.discovery.as_mut();
        if let Err(trouble) = visit.begin() {
            let why = trouble.to_string();
            visit.end(&why);
            return Err(Lost::before(why));
        }
        self.said.clear();
        self.desk.reached();
        self.robot.log(Level::Info, format!("connected to {target}"));
        self.robot.up();
        let served = visit.serve();
        let why = served.as_ref().map_or_else(Trouble::to_string, |()| "the connection was closed".to_string());
        visit.end(&why);
        served.map_err(|_| Lost { why, was_up: true })
    }

    /// The brick that the form names. None: there is something new to do.
    fn target(&mut self) -> Result<Option<Target>, String> {
        match self.settings.place.clone() {
            Place::Address { host, port } => {
                if self.said.is_empty() {
                    self.robot.connecting(format!("connecting to {host}:{port}"));
                }
                let mut addresses = (&*host, port).to_socket_addrs().map_err(|error| format!("`{host}`: {error}"))?;
                let address = addresses.next().ok_or_else(|| format!("`{host}` has no address"))?;
                Ok(Some(Target { address, name: "the brick".to_string(), serial: String::new() }))
            }
            Place::Heard { port, wanted } => self.listen(port, wanted),
        }
    }

    fn listen(&mut self, port: u16, mut wanted: Wanted) -> Result<Option<Target>, String> {
        let any = wanted == Wanted::default();
        wanted.serial = wanted.serial.or_else(|| self.taken.clone());
        let mut discovery = match self.discovery.take() {
            Some(discovery) => discovery,
            None => Discovery::open(port).map_err(|error| not_listening(port, &error))?,
        };
        if self.said.is_empty() {
            self.robot.connecting(format!("listening for {wanted} on UDP port {port}"));
        }
        let begun = Instant::now();
        while self.desk.is_quiet() {
            discovery.listen(LOOK).map_err(|error| not_listening(port, &error))?;
            discovery.news().into_iter().for_each(|found| self.robot.found(found));
            if let Some(brick) = discovery.find(&wanted).cloned() {
                discovery.answer(&brick);
                if any && self.taken.is_none() && discovery.names().len() > 1 {
                    let heard = discovery.names().join(", ");
                    self.robot.log(Level::Warn, format!("taking {} of {heard}; say which with `name`", brick.name));
                }
                self.taken = Some(brick.serial.clone());
                self.discovery = Some(discovery);
                return Ok(Some(Target { address: brick.address, serial: brick.serial, name: brick.name }));
            }
            if begun.elapsed() >= HEARING {
                self.tell_lost(not_heard(port, &wanted, &discovery));
            }
        }
        self.discovery = Some(discovery);
        Ok(None)
    }

    fn tell_lost(&mut self, why: String) {
        if self.said != why {
            self.robot.lost(&*why);
            self.said = why;
        }
    }
}

impl Lost {
    fn before(why: String) -> Lost {
        Lost { why, was_up: false }
    }
}

impl Display for Target {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {}", self.name, self.address)
    }
}

fn not_listening(port: u16, error: &io::Error) -> String {
    format!("can't listen for bricks on UDP port {port}: {error}; give the brick's `address` instead")
}

fn not_heard(port: u16, wanted: &Wanted, discovery: &Discovery) -> String {
    let others = match discovery.names() {
        names if names.is_empty() => String::new(),
        names => format!("; heard: {}", names.join(", ")),
    };
    format!(
        "{wanted} isn't heard on UDP port {port}{others}; is it on, in this network, and does the firewall let it through? \
         Its `address` may do"
    )
}
