//! Frames as they go over the wire: a length, a counter that an answer repeats, a type, and what it is about.

use crate::command::Command;

/// A direct command that is to be answered.
const DIRECT: u8 = 0x00;

const OK: u8 = 0x02;
const REFUSED: u8 = 0x04;

/// The longest frame a brick takes or sends, without its length.
pub const LONGEST: usize = 1024;

/// Any frame, its length before it.
pub fn frame(counter: u16, kind: u8, body: &[u8]) -> Vec<u8> {
    let length = (3 + body.len()) as u16;
    let mut bytes = Vec::with_capacity(2 + usize::from(length));
    bytes.extend(length.to_le_bytes());
    bytes.extend(counter.to_le_bytes());
    bytes.push(kind);
    bytes.extend(body);
    bytes
}

/// A command as a frame; the brick answers it.
pub fn command(counter: u16, command: &Command) -> Vec<u8> {
    let mut body = command.globals().to_le_bytes().to_vec();
    body.extend(command.ops());
    frame(counter, DIRECT, &body)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reply<'a> {
    pub counter: u16,
    pub verdict: Verdict,
    /// What the command has the brick answer.
    pub answer: &'a [u8],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Done,
    Refused,
}

/// Reads a frame from the brick, its length taken off. None: it is not a reply to a direct command.
pub fn reply(bytes: &[u8]) -> Option<Reply<'_>> {
    let (&[low, high, kind], answer) = bytes.split_first_chunk()?;
    let verdict = match kind {
        OK => Verdict::Done,
        REFUSED => Verdict::Refused,
        _ => return None,
    };
    Some(Reply { counter: u16::from_le_bytes([low, high]), verdict, answer })
}
