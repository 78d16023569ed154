//! What always holds: no bytes make a codec fail, in whatever pieces they come; what is written can be read back.

use std::time::{Duration, Instant};

use lrp_bridge_serial::codec::{Codec, Heard};
use lrp_bridge_serial::firmata::{Decoder, From, Message};
use lrp_bridge_serial::lines::{Columns, Fields, Framer, Piece, Template};
use lrp_bridge_serial::settings::Settings;
use proptest::prelude::*;
use serde_json::{Value, json};

fn codec(config: Value) -> Box<dyn Codec> {
    Settings::read(&config).expect("a good form").protocol.codec()
}

fn codecs() -> Vec<Box<dyn Codec>> {
    let inputs = json!({ "light": 0, "on": false, "pose": { "x": 0, "name": "" }, "any": {} });
    let columns = json!(["light", "", "on", "pose.x", "pose.name"]);
    vec![
        codec(json!({ "inputs": inputs, "ready": 0 })),
        codec(json!({ "inputs": inputs, "fields": "csv", "columns": columns, "ready": 0 })),
        codec(json!({ "inputs": inputs, "fields": "nmea", "columns": { "GP": columns }, "ready": "ready" })),
        codec(json!({ "inputs": inputs, "fields": "json" })),
        codec(
            json!({ "codec": "firmata", "pins": { "a": "analog A0", "b": "input 3", "c": "pwm 40", "d": "output 126" } }),
        ),
    ]
}

/// Bytes like those that robots send, and others.
fn noise() -> impl Strategy<Value = Vec<u8>> {
    let words = prop_oneof![
        Just(b"light=23 on:yes".to_vec()),
        Just(b"{\"pose\":{\"x\":1}}".to_vec()),
        Just(b"1,2,3,4,5".to_vec()),
        Just(b"$GP,1,2*00".to_vec()),
        Just(b"\"".to_vec()),
        Just(b"\r\n".to_vec()),
        Just(vec![0xf0, 0x79, 2, 5, 0xf7]),
        Just(vec![0xf0, 0x6c, 1, 1, 0x7f, 0x7f, 0xf7]),
        Just(vec![0xf0, 0x6a, 0, 0x7f, 0xf7]),
        Just(vec![0xf9, 2, 5]),
        prop::collection::vec(any::<u8>(), 0..20),
    ];
    prop::collection::vec(words, 0..20).prop_map(|words| words.concat())
}

/// What a codec makes of some pieces.
fn heard(codec: &mut dyn Codec, pieces: &[&[u8]], now: Instant) -> Vec<Heard> {
    codec.open(now);
    let mut all = codec.tick(now);
    for piece in pieces {
        all.extend(codec.hear(piece, now));
    }
    all
}

fn message() -> impl Strategy<Value = Message> {
    let half = || 0u8..0x80;
    let text =
        || prop::collection::vec(any::<char>(), 0..10).prop_map(|letters| letters.into_iter().collect::<String>());
    let pins = prop::collection::vec(prop::collection::vec((0u8..0x7f, 0u8..0x7f), 0..4), 0..10);
    let channels = prop::collection::vec(prop::option::of(0u8..0x7f), 0..20);
    prop_oneof![
        (half(), half()).prop_map(|(major, minor)| Message::Version { major, minor }),
        // A name without letters can't be told from a question.
        (half(), half(), text()).prop_map(|(major, minor, name)| Message::Firmware { major, minor, name }),
        Just(Message::AskFirmware),
        pins.prop_map(Message::Capabilities),
        Just(Message::AskCapabilities),
        channels.prop_map(Message::AnalogMapping),
        Just(Message::AskAnalogMapping),
        (half(), half()).prop_map(|(pin, mode)| Message::PinMode { pin, mode }),
        (0u8..16, any::<bool>()).prop_map(|(channel, on)| Message::ReportAnalog { channel, on }),
        (0u8..16, any::<bool>()).prop_map(|(port, on)| Message::ReportDigital { port, on }),
        (0u8..16, any::<u8>()).prop_map(|(port, pins)| Message::Digital { port, pins }),
        (0u8..16, 0u16..1 << 14).prop_map(|(channel, value)| Message::Analog { channel, value }),
        (half(), 0u32..1 << 28).prop_map(|(pin, value)| Message::ExtendedAnalog { pin, value }),
        text().prop_map(Message::Text),
        (0u16..1 << 14).prop_map(Message::SamplingInterval),
        (half(), 0u16..1 << 14, 0u16..1 << 14).prop_map(|(pin, min, max)| Message::ServoConfig { pin, min, max }),
        Just(Message::Reset),
    ]
}

/// What a robot can send without getting into the way of what is around it.
fn word() -> impl Strategy<Value = String> {
    "[a-z][a-z0-9_]{0,8}"
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_make_a_codec_fail_and_pieces_make_no_difference(bytes in noise(), cut in any::<prop::sample::Index>()) {
        let now = Instant::now();
        let cut = cut.index(bytes.len() + 1);
        for (mut whole, mut pieces) in codecs().into_iter().zip(codecs()) {
            let at_once = heard(&mut *whole, &[&bytes], now);
            let in_two = heard(&mut *pieces, &[&bytes[..cut], &bytes[cut..]], now);
            let of_interest = |all: Vec<Heard>| all.into_iter().filter(|heard| !matches!(heard, Heard::Unreadable(_))).collect::<Vec<_>>();
            prop_assert_eq!(of_interest(at_once), of_interest(in_two));
            whole.tick(now + Duration::from_secs(1));
        }
    }

    #[test]
    fn after_garbage_lines_are_read_again(garbage in prop::collection::vec(any::<u8>(), 0..9000)) {
        let mut framer = Framer::default();
        framer.take(&garbage);
        framer.take(b"\n");
        prop_assert_eq!(framer.take(b"light=1\r\n"), [Piece::Line("light=1".into())]);
    }

    #[test]
    fn firmata_is_read_as_it_was_written(messages in prop::collection::vec(message(), 0..10), garbage in prop::collection::vec(0u8..0x80, 0..10)) {
        // What is left of a message whose beginning was lost.
        let mut bytes = garbage;
        messages.iter().for_each(|message| message.encode(&mut bytes));
        let mut decoder = Decoder::of(From::Board);
        let read: Vec<Message> = bytes.iter().flat_map(|byte| decoder.take(&[*byte])).collect();
        prop_assert_eq!(read, messages);
    }

    #[test]
    fn a_template_reads_what_it_wrote(name in word(), text in "[a-z ]{0,9}", number in any::<i64>(), real in -1e9f64..1e9, on in any::<bool>()) {
        let template = Template::parse(&format!("{name}{{{{ {{a}};{{b.c}};{{b.d:b}} = {{e:s}}|{{f:json}}")).expect("a template");
        let message = json!({ "a": number, "b": { "c": real, "d": on }, "e": text, "f": [text, number] });
        let line = template.render(&message).expect("a line");
        prop_assert_eq!(template.read(&line), Some(message), "{}", line);
    }

    #[test]
    fn no_line_makes_a_template_fail(source in ".{0,20}", line in ".{0,20}") {
        if let Ok(template) = Template::parse(&source) {
            template.read(&line);
        }
    }

    #[test]
    fn fields_are_read_as_they_were_written(fields in prop::collection::vec((word(), any::<i32>(), "[a-z ,;=]{0,9}"), 1..6)) {
        let columns = Columns::default();
        let texts = |named: Vec<(String, _)>| named.into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        let kv: Vec<String> = fields.iter().flat_map(|(name, number, text)| [format!("{name}={number}"), format!("{name}:\"{text}\"")]).collect();
        let read = Fields::Kv.read(&kv.join(", "), &columns).expect("pairs");
        prop_assert_eq!(read.len(), fields.len() * 2);
        for (pair, (name, number, text)) in read.chunks(2).zip(&fields) {
            prop_assert_eq!(&pair[0], &(name.clone(), lrp_bridge_serial::lines::Field::Text(number.to_string())));
            prop_assert_eq!(&pair[1], &(name.clone(), lrp_bridge_serial::lines::Field::Text(text.clone())));
        }
        let names = Columns::Same(fields.iter().map(|(name, _, _)| name.clone()).collect());
        let csv: Vec<String> = fields.iter().map(|(name, _, text)| format!("\"{name} \"\"{text}\"\"\"")).collect();
        let read = Fields::Csv.read(&csv.join(","), &names).expect("columns");
        prop_assert_eq!(texts(read.clone()), fields.iter().map(|(name, _, _)| name.clone()).collect::<Vec<_>>());
        for ((_, field), (name, _, text)) in read.iter().zip(&fields) {
            prop_assert_eq!(field, &lrp_bridge_serial::lines::Field::Text(format!("{name} \"{text}\"")));
        }
        let body = format!("GP,{}", fields.iter().map(|(_, number, _)| number.to_string()).collect::<Vec<_>>().join(","));
        let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
        let tagged = Columns::Tagged([("GP".to_string(), fields.iter().map(|(name, _, _)| name.clone()).collect())].into());
        let right = Fields::Nmea.read(&format!("${body}*{sum:02x}"), &tagged).expect("a sentence");
        prop_assert_eq!(texts(right), fields.iter().map(|(name, _, _)| name.clone()).collect::<Vec<_>>());
        let wrong = sum ^ 1;
        let refused = Fields::Nmea.read(&format!("${body}*{wrong:02X}"), &tagged).is_err();
        prop_assert!(refused);
    }
}
