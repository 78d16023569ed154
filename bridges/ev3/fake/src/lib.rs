//! A brick that isn't there: speaks TCP and UDP on 127.0.0.1 as a brick does, with its traps, and tells what it heard.

mod machine;

use std::io::{Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

pub use machine::Machine;

/// How often it says that it is there. A real one takes five seconds.
const BEACON: Duration = Duration::from_millis(50);

const TICK: Duration = Duration::from_millis(2);

/// How it answers commands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Mood {
    #[default]
    Good,
    /// Does what it is told after a while, and answers then.
    Slow(Duration),
    /// Does and answers nothing.
    Silent,
    /// Answers with an error, and does nothing.
    Dialog,
    /// Answers something before the answer.
    Chatty,
    /// Answers what no brick would.
    Garbage,
}

#[derive(Clone)]
pub struct Brick {
    pub address: SocketAddr,
    shared: Arc<Mutex<Shared>>,
}

pub struct Shared {
    pub machine: Machine,
    pub mood: Mood,
    /// Each frame that came, without its length, and when.
    pub frames: Vec<(Instant, Vec<u8>)>,
    /// Unlocks that were accepted.
    pub unlocked: usize,
    /// Datagrams that answered its beacon.
    pub answered: usize,
    /// Got half of a length once, and hears nothing any more.
    pub jammed: bool,
    client: Option<TcpStream>,
    over: bool,
}

impl Brick {
    /// Listens on a port; 0: any.
    pub fn start(port: u16) -> Brick {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).expect("a port");
        let address = listener.local_addr().expect("an address");
        let shared = Shared {
            machine: Machine::default(),
            mood: Mood::Good,
            frames: Vec::new(),
            unlocked: 0,
            answered: 0,
            jammed: false,
            client: None,
            over: false,
        };
        let brick = Brick { address, shared: Arc::new(Mutex::new(shared)) };
        let accepting = brick.clone();
        spawn(move || accepting.accept(&listener));
        brick
    }

    /// Says on a UDP port that it is there.
    pub fn call_out(&self, port: u16, name: &str, serial: &str) {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a socket");
        socket.set_nonblocking(true).expect("a socket");
        let beacon =
            format!("Serial-Number: {serial}\r\nPort: {}\r\nName: {name}\r\nProtocol: EV3\r\n", self.address.port());
        let brick = self.clone();
        spawn(move || {
            while !brick.state().over {
                let _ = socket.send_to(beacon.as_bytes(), (Ipv4Addr::LOCALHOST, port));
                sleep(BEACON);
                let mut answer = [0; 16];
                while socket.recv_from(&mut answer).is_ok() {
                    brick.state().answered += 1;
                }
            }
        });
    }

    pub fn state(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    pub fn mood(&self, mood: Mood) {
        self.state().mood = mood;
    }

    /// The connection breaks; the motors go on.
    pub fn hang_up(&self) {
        if let Some(client) = self.state().client.take() {
            let _ = client.shutdown(Shutdown::Both);
        }
    }

    fn accept(&self, listener: &TcpListener) {
        listener.set_nonblocking(true).expect("a socket");
        // Clients that came while there was one: connected, and never answered.
        let mut ignored = Vec::new();
        while !self.state().over {
            match listener.accept() {
                Ok((client, _)) if self.state().client.is_some() => ignored.push(client),
                Ok((client, _)) => {
                    client.set_nonblocking(false).expect("a socket");
                    self.state().client = client.try_clone().ok();
                    let brick = self.clone();
                    spawn(move || {
                        let _ = brick.serve(client);
                        brick.state().client = None;
                    });
                }
                Err(_) => sleep(TICK),
            }
        }
    }

    fn serve(&self, mut client: TcpStream) -> std::io::Result<()> {
        // One read, and what came with the unlock is gone.
        let mut unlock = [0; 100];
        let length = client.read(&mut unlock)?;
        if !unlock[..length].windows(14).any(|window| window == b"ET /target?sn=") {
            return Ok(());
        }
        self.state().unlocked += 1;
        client.write_all(b"Accept:EV340\r\n\r\n")?;
        loop {
            let mut length = [0; 2];
            match client.read(&mut length)? {
                2 => {}
                0 => return Ok(()),
                _ => {
                    self.state().jammed = true;
                    return std::io::copy(&mut client, &mut std::io::sink()).map(|_| ());
                }
            }
            let mut frame = vec![0; u16::from_le_bytes(length).into()];
            client.read_exact(&mut frame)?;
            self.state().frames.push((Instant::now(), frame.clone()));
            if let Some(answer) = self.answer(&frame) {
                client.write_all(&answer)?;
            }
        }
    }

    fn answer(&self, frame: &[u8]) -> Option<Vec<u8>> {
        let mood = self.state().mood;
        if let Mood::Slow(time) = mood {
            sleep(time);
        }
        let (&[low, high, kind, globals, header], ops) = frame.split_first_chunk()?;
        let mut answer = vec![0; usize::from(u16::from_le_bytes([globals, header]) & 0x3ff)];
        let done = match mood {
            Mood::Silent => return None,
            Mood::Dialog => false,
            _ => {
                let ran = self.state().machine.run(ops, &mut answer);
                // Whatever waits inside keeps it from reading.
                ran.map(sleep).is_ok()
            }
        };
        match (kind, mood) {
            (0x00, Mood::Garbage) => Some(b"\x05\x00HTTP!".to_vec()),
            (0x00, Mood::Chatty) => {
                Some([reply(low ^ 1, high, true, b"stale"), reply(low, high, done, &answer)].concat())
            }
            (0x00, _) => Some(reply(low, high, done, &answer)),
            _ => None,
        }
    }

    pub fn end(&self) {
        self.state().over = true;
        self.hang_up();
    }
}

fn reply(low: u8, high: u8, done: bool, answer: &[u8]) -> Vec<u8> {
    let answer = if done { answer } else { &[] };
    let mut bytes = (3 + answer.len() as u16).to_le_bytes().to_vec();
    bytes.extend([low, high, if done { 0x02 } else { 0x04 }]);
    bytes.extend(answer);
    bytes
}
