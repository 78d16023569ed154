//! Firmata over a pseudo terminal, with a board of our own that also does what boards shouldn't.

use std::time::{Duration, Instant};

use lrp_bridge::{Event, Order, Peer};
use lrp_bridge_serial::firmata::{Decoder, From, Message};
use serde_json::{Value, json};

use crate::terminal::{Robot, Socket, bridge, until_log};

struct Board {
    robot: Robot,
    decoder: Decoder,
    heard: Vec<Message>,
}

impl Board {
    fn new(socket: &Socket) -> Board {
        Board { robot: socket.plug(), decoder: Decoder::of(From::Computer), heard: Vec::new() }
    }

    fn say(&mut self, messages: &[Message]) {
        let mut bytes = Vec::new();
        messages.iter().for_each(|message| message.encode(&mut bytes));
        self.robot.say(bytes);
    }

    /// All up to this one, beats left out.
    fn until(&mut self, wanted: &Message) -> Vec<Message> {
        let end = Instant::now() + Duration::from_secs(20);
        loop {
            if let Some(at) = self.heard.iter().position(|message| message == wanted) {
                return self.heard.drain(..=at).filter(|message| *message != Message::AskVersion).collect();
            }
            assert!(Instant::now() < end, "no {wanted:?} came, only {:?}", self.heard);
            let bytes = self.robot.bytes();
            self.heard.extend(self.decoder.take(&bytes));
        }
    }

    fn answer(&mut self) {
        self.until(&Message::AskFirmware);
        self.say(&[version(), firmware()]);
        self.until(&Message::AskAnalogMapping);
        self.say(&[Message::Capabilities(capabilities()), Message::AnalogMapping(channels())]);
    }
}

fn version() -> Message {
    Message::Version { major: 2, minor: 5 }
}

fn firmware() -> Message {
    Message::Firmware { major: 2, minor: 5, name: "a b\u{f6}ard".into() }
}

/// An Uno's, with PWM on 20 as well.
fn capabilities() -> Vec<Vec<(u8, u8)>> {
    let digital = [(0, 1), (11, 1), (1, 1)];
    let pin = |pin: u8| match pin {
        0 | 1 => vec![],
        3 | 5 | 6 | 20 => [&digital[..], &[(3, 8)]].concat(),
        9 => [&digital[..], &[(3, 8), (4, 14)]].concat(),
        14..20 => [&digital[..], &[(2, 10)]].concat(),
        _ => digital.to_vec(),
    };
    (0..21).map(pin).collect()
}

fn channels() -> Vec<Option<u8>> {
    (0..21).map(|pin: u8| pin.checked_sub(14).filter(|channel| *channel < 6)).collect()
}

fn form(socket: &Socket, pins: Value) -> Value {
    json!({ "port": socket.path(), "codec": "firmata", "pins": pins })
}

fn up(pins: Value) -> (Peer, Board, Socket) {
    let socket = Socket::new();
    let mut board = Board::new(&socket);
    let mut lrp = bridge(form(&socket, pins));
    board.answer();
    lrp.until_up();
    (lrp, board, socket)
}

fn mode(pin: u8, mode: u8) -> Message {
    Message::PinMode { pin, mode }
}

#[test]
fn pins_are_set_up_and_stopped_first() {
    let (_lrp, mut board, _socket) = up(
        json!({ "light": "analog A2", "left": "pwm 5", "bumper": "pullup 7", "led": "output 13", "arm": "servo 9" }),
    );
    let last = Message::Digital { port: 1, pins: 0 };
    assert_eq!(
        board.until(&last)[..],
        [
            Message::SamplingInterval(20),
            mode(9, 4),
            mode(7, 11),
            Message::ReportDigital { port: 0, on: true },
            mode(13, 1),
            mode(5, 3),
            mode(16, 2),
            Message::ReportAnalog { channel: 2, on: true },
            last,
        ][..]
    );
    board.until(&Message::Analog { channel: 5, value: 0 });
}

#[test]
fn inputs_and_outputs() {
    let (mut lrp, mut board, _socket) = up(json!({
        "light": "analog 16", "left": "pwm 5", "bumper": "pullup 7 inverted", "led": "output 13", "red": "output 12 inverted", "far": "pwm 20",
    }));
    board.say(&[Message::Analog { channel: 2, value: 700 }, Message::Digital { port: 0, pins: 0x80 }]);
    assert_eq!(lrp.input("light"), json!({ "data": 700 }));
    assert_eq!(lrp.input("bumper"), json!({ "data": 0 }));
    board.say(&[Message::Digital { port: 0, pins: 0 }]);
    assert_eq!(lrp.input("bumper"), json!({ "data": 1 }));
    lrp.send("led", json!({ "data": 1 }));
    board.until(&Message::Digital { port: 1, pins: 0x30 });
    lrp.send("red", json!({ "data": 1 }));
    board.until(&Message::Digital { port: 1, pins: 0x20 });
    lrp.send("left", json!({ "data": 999 }));
    board.until(&Message::Analog { channel: 5, value: 255 });
    lrp.send("far", json!({ "data": 199.6 }));
    board.until(&Message::ExtendedAnalog { pin: 20, value: 200 });
    lrp.order(Order::Stop);
    let stop = board.until(&Message::Digital { port: 1, pins: 0x10 });
    assert!(stop.contains(&Message::Analog { channel: 5, value: 0 }), "{stop:?}");
    lrp.send("left", json!({ "data": "fast" }));
    assert_eq!(until_log(&mut lrp, "wasn't sent"), "`left` wasn't sent: `data` should be a number");
}

#[test]
fn reports_that_nobody_asked_for() {
    let socket = Socket::new();
    let mut board = Board::new(&socket);
    let mut lrp = bridge(form(&socket, json!({ "light": "analog A0" })));
    // The board begins: noise, its report, and that again for each question that came meanwhile.
    board.robot.say([0x00, 0x55, 0xf0, 0x12, 0xff, 0xe0, 0x33]);
    board.say(&[version(), firmware(), Message::Analog { channel: 0, value: 1 }, version(), firmware()]);
    board.until(&Message::AskAnalogMapping);
    board.say(&[firmware(), Message::AnalogMapping(channels()), Message::Capabilities(capabilities()), version()]);
    lrp.until_up();
    board.say(&[Message::Analog { channel: 0, value: 9 }, Message::Text("l\u{f6}w".into())]);
    // A log line may come before an input that was there first.
    let (mut light, mut text) = (None, false);
    lrp.until("both", |event| {
        match event {
            Event::Input { name, value, .. } if name == "light" => light = Some(value.clone()),
            Event::Log { message, .. } => text |= message.contains("l\u{f6}w"),
            _ => {}
        }
        (light == Some(json!({ "data": 9 })) && text).then_some(())
    });
}

#[test]
fn an_edit_touches_only_the_pins_that_it_changes() {
    let (mut lrp, mut board, socket) = up(json!({ "left": "pwm 5", "led": "output 13" }));
    board.until(&Message::Analog { channel: 5, value: 0 });
    lrp.configure(form(&socket, json!({ "left": "pwm 5", "bumper": "pullup 7", "right": "pwm 6" })));
    let last = Message::Analog { channel: 6, value: 0 };
    let report = Message::ReportDigital { port: 0, on: true };
    let off = Message::Digital { port: 1, pins: 0 };
    let heard = board.until(&last);
    assert_eq!(heard, [off, Message::SamplingInterval(20), mode(7, 11), report, mode(6, 3), last]);
}

#[test]
fn digital_pins_do_not_grow_stale() {
    let (mut lrp, mut board, _socket) = up(json!({ "bumper": "input 7" }));
    board.say(&[Message::Digital { port: 0, pins: 0x80 }]);
    lrp.input("bumper");
    for _ in 0..3 {
        // All that it says to a beat.
        board.say(&[version()]);
        assert_eq!(lrp.input("bumper"), json!({ "data": 1 }));
    }
}
