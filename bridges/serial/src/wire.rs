//! The way to the robot: what waits to be written to an open port, never more than the robot takes in a fifth of a
//! second, and never waited for.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, ErrorKind, Write};

use serialport::{ClearBuffer, SerialPort, TTYPort};

/// What may wait, in bytes, whatever the speed: some messages.
const LEAST: usize = 512;
/// Bits that a byte takes on the line.
const BITS: usize = 10;
/// Parts of a second that may wait.
const PARTS: usize = 5;

pub struct Wire {
    file: File,
    /// The same port, to ask it.
    port: TTYPort,
    limit: usize,
    queue: VecDeque<Frame>,
    /// How much of the first frame is written.
    written: usize,
    /// Frames that were dropped since that was last asked.
    dropped: u64,
}

struct Frame {
    /// A later one of the same name takes its place.
    name: Option<String>,
    bytes: Vec<u8>,
}

impl Wire {
    pub fn new(file: File, port: TTYPort, baud: u32) -> Wire {
        let limit = LEAST.max(baud as usize / BITS / PARTS);
        Wire { file, port, limit, queue: VecDeque::new(), written: 0, dropped: 0 }
    }

    /// Takes the place of an output of that name that still waits.
    pub fn output(&mut self, name: &str, bytes: Vec<u8>) {
        self.drop_where(|frame| frame.name.as_deref() == Some(name));
        if !self.put(Some(name.to_string()), bytes) {
            self.dropped += 1;
        }
    }

    /// Whether there was room for it.
    pub fn put(&mut self, name: Option<String>, bytes: Vec<u8>) -> bool {
        let waiting: usize = self.queue.iter().map(|frame| frame.bytes.len()).sum();
        let room = waiting == 0 || waiting + bytes.len() <= self.limit;
        if room {
            self.push(name, bytes);
        }
        room
    }

    /// Without asking for room: what belongs to the connection itself.
    pub fn push(&mut self, name: Option<String>, bytes: Vec<u8>) {
        if !bytes.is_empty() {
            self.queue.push_back(Frame { name, bytes });
        }
    }

    /// Drops the outputs that wait.
    pub fn forget_outputs(&mut self) {
        self.drop_where(|frame| frame.name.is_some());
    }

    /// But for one that has begun.
    fn drop_where(&mut self, wanted: impl Fn(&Frame) -> bool) {
        let begun = usize::from(self.written > 0);
        let before = self.queue.len();
        let mut at = 0;
        self.queue.retain(|frame| {
            at += 1;
            at <= begun || !wanted(frame)
        });
        self.dropped += (before - self.queue.len()) as u64;
    }

    /// Before all that waits, which is dropped. `cut`: what ends a message of which a part is out.
    pub fn stop(&mut self, cut: Vec<u8>, bytes: Vec<u8>) -> io::Result<()> {
        let waits_in_system = self.port.bytes_to_write().is_ok_and(|count| count > 0);
        if waits_in_system {
            let _ = self.port.clear(ClearBuffer::Output);
        }
        let cut = if waits_in_system || self.written > 0 { cut } else { Vec::new() };
        self.dropped += self.queue.len() as u64;
        self.queue.clear();
        self.written = 0;
        self.queue.push_back(Frame { name: None, bytes: [cut, bytes].concat() });
        self.write()
    }

    /// Writes what the robot takes now.
    pub fn write(&mut self) -> io::Result<()> {
        while let Some(frame) = self.queue.front() {
            let left = &frame.bytes[self.written..];
            let in_system = self.port.bytes_to_write().map_or(0, |count| count as usize);
            if in_system > 0 && in_system + left.len() > self.limit {
                return Ok(());
            }
            match self.file.write(left) {
                Ok(count) => self.written += count,
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
            if self.written >= frame.bytes.len() {
                self.queue.pop_front();
                self.written = 0;
            }
        }
        Ok(())
    }

    pub fn is_idle(&self) -> bool {
        self.queue.is_empty()
    }

    pub fn take_dropped(&mut self) -> u64 {
        std::mem::take(&mut self.dropped)
    }
}
