//! What stands between bytes and messages. A codec touches no port and no clock: bytes and times go in, what they mean
//! comes out.

use std::time::Instant;

use lrp_bridge::{Call, Description, Found, Level};
use serde_json::Value;

use crate::settings::Protocol;

pub trait Codec: Send {
    fn offer(&self) -> Description;

    /// The port was just opened. Gives what is to be sent first.
    fn open(&mut self, now: Instant) -> Vec<u8>;

    fn hear(&mut self, bytes: &[u8], now: Instant) -> Vec<Heard>;

    /// Time passed.
    fn tick(&mut self, now: Instant) -> Vec<Heard>;

    fn send(&mut self, output: &str, message: &Value) -> Result<Vec<u8>, String>;

    fn call(&mut self, call: &Call, now: Instant) -> Result<Begun, String>;

    fn cancel(&mut self, id: u64);

    /// The calls that wait for a reply: they are over.
    fn forget_calls(&mut self) -> Vec<u64>;

    /// Brings the robot to a halt.
    fn stop(&mut self) -> Vec<u8>;

    /// What ends a message that was cut off.
    fn end_of_message(&self) -> Vec<u8>;

    /// The form was edited. Gives what is to be sent for it; none: it takes another codec.
    fn adopt(&mut self, protocol: &Protocol) -> Option<Vec<u8>>;
}

/// A call's bytes, and whether a reply is waited for.
#[derive(Debug, PartialEq)]
pub struct Begun {
    pub bytes: Vec<u8>,
    pub waits: bool,
}

/// What bytes, or the time, came to.
#[derive(Clone, Debug, PartialEq)]
pub enum Heard {
    /// The robot listens: for the first time, or again, as it began anew.
    Ready,
    Input(String, Value),
    Reply(u64, Result<Value, String>),
    /// What couldn't be read, as a person would like to see it.
    Unreadable(String),
    /// All fields that come in and that no input takes.
    Fields(Vec<Found>),
    Log(Level, String),
    /// To be sent back.
    Send(Vec<u8>),
    /// Nothing is to be hoped for from this connection.
    Lost(String),
}
