//! What a codec waits for, and for how long; in virtual time.

use std::time::{Duration, Instant};

use lrp_bridge_serial::codec::{Codec, Heard};
use lrp_bridge_serial::firmata::{Decoder, From, Message};
use lrp_bridge_serial::settings::Settings;
use serde_json::{Value, json};

struct Waiting {
    codec: Box<dyn Codec>,
    opened: Instant,
}

impl Waiting {
    fn on(config: Value) -> Waiting {
        let mut codec = Settings::read(&config).expect("a good form").protocol.codec();
        let opened = Instant::now();
        codec.open(opened);
        Waiting { codec, opened }
    }

    fn hear(&mut self, ms: u64, bytes: &[u8]) -> Vec<Heard> {
        self.codec.hear(bytes, self.opened + Duration::from_millis(ms))
    }

    fn tick(&mut self, ms: u64) -> Vec<Heard> {
        self.codec.tick(self.opened + Duration::from_millis(ms))
    }
}

fn lost(why: &str) -> Vec<Heard> {
    vec![Heard::Lost(why.into())]
}

fn light(value: i64) -> Heard {
    Heard::Input("light".into(), json!({ "data": value }))
}

#[test]
fn by_default_the_first_line_or_two_seconds_make_it_ready() {
    let mut robot = Waiting::on(json!({ "inputs": { "light": 0 } }));
    assert_eq!(robot.hear(100, b"ght=1\nlight=2\n"), [Heard::Ready, light(2)], "the first line may lack its beginning");
    let mut robot = Waiting::on(json!({ "inputs": { "light": 0 } }));
    assert_eq!(robot.tick(1999), []);
    assert_eq!(robot.tick(2000), [Heard::Ready]);
    assert_eq!(robot.hear(2001, b"light=3\n"), [light(3)]);
}

#[test]
fn a_line_cut_by_the_end_of_the_wait_is_nobodys() {
    let mut robot = Waiting::on(json!({ "inputs": { "light": 0 }, "ready": 500 }));
    assert_eq!(robot.hear(499, b"light=12"), []);
    assert_eq!(robot.tick(500), [Heard::Ready]);
    assert_eq!(robot.hear(501, b"3\nlight=4\n"), [light(4)]);
    let mut robot = Waiting::on(json!({ "inputs": { "light": 0 }, "ready": 500 }));
    assert_eq!(robot.hear(499, b"light=1\nlight=2"), []);
    assert_eq!(robot.tick(500), [Heard::Ready]);
    assert_eq!(robot.hear(501, b"3\n"), [light(23)], "this one began in sight");
}

#[test]
fn a_robot_that_never_says_it_is_ready_is_lost() {
    let mut robot = Waiting::on(json!({ "ready": "ready" }));
    assert_eq!(robot.hear(100, b"hello\n"), []);
    assert_eq!(robot.tick(9_999), []);
    assert_eq!(robot.tick(10_000), lost("the robot hasn't said `ready` in 10 s: is `ready` or `baud` wrong?"));
}

#[test]
fn a_robot_without_a_stop_is_warned_of() {
    let mut robot = Waiting::on(json!({ "outputs": { "go": "G" }, "ready": 0 }));
    let [Heard::Log(_, warning), Heard::Ready] = &robot.tick(0)[..] else { panic!("no warning") };
    assert_eq!(warning, "the form has no `stop`: nothing halts this robot when the program stops");
}

fn board(pins: Value) -> Waiting {
    Waiting::on(json!({ "codec": "firmata", "pins": pins }))
}

fn encoded(messages: &[Message]) -> Vec<u8> {
    let mut bytes = Vec::new();
    messages.iter().for_each(|message| message.encode(&mut bytes));
    bytes
}

fn version() -> Vec<u8> {
    encoded(&[Message::Version { major: 2, minor: 5 }])
}

fn sent(heard: &[Heard]) -> Vec<Message> {
    let mut decoder = Decoder::of(From::Computer);
    let bytes = heard.iter().filter_map(|heard| match heard {
        Heard::Send(bytes) => Some(bytes.clone()),
        _ => None,
    });
    bytes.flat_map(|bytes| decoder.take(&bytes)).collect()
}

#[test]
fn a_port_without_firmata_is_asked_until_it_is_given_up() {
    let mut board = board(json!({}));
    board.hear(100, b"light=230\n");
    assert_eq!(board.tick(499), []);
    assert_eq!(sent(&board.tick(500)), [Message::AskVersion, Message::AskFirmware]);
    assert_eq!(board.tick(8_000), lost("no Firmata answers within 8 s: is it on the board, and `baud` right?"));
}

#[test]
fn a_board_that_does_not_tell_its_pins_is_taken_for_an_uno() {
    let mut board = board(json!({ "light": "analog A1" }));
    assert_eq!(sent(&board.hear(100, &version())), [Message::AskCapabilities, Message::AskAnalogMapping]);
    assert_eq!(board.tick(1_500), []);
    let heard = board.tick(1_600);
    let mode = Message::PinMode { pin: 15, mode: 2 };
    assert_eq!(sent(&heard), [Message::SamplingInterval(20), mode, Message::ReportAnalog { channel: 1, on: true }]);
    assert_eq!(heard.last(), Some(&Heard::Ready));
}

#[test]
fn a_board_that_falls_silent_is_lost() {
    let mut board = board(json!({}));
    board.hear(0, &version());
    board.tick(1_500);
    assert_eq!(sent(&board.tick(1_600)), [Message::AskVersion], "a beat");
    assert_eq!(board.hear(2_000, &version()), []);
    assert_eq!(sent(&board.tick(4_999)), [Message::AskVersion]);
    assert_eq!(board.tick(5_000), lost("the board has said nothing for 3 s"));
}
