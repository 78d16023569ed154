//! Firmata's messages as bytes, both ways. A byte with its top bit set begins a message; what begins none is left out.

/// Longer than any answer: a pin takes some 20 bytes of the longest, and there are 128 pins.
const LONGEST: usize = 4096;

const START: u8 = 0xf0;
const END: u8 = 0xf7;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// Also asks for it, in the other direction, as `AskVersion`.
    Version {
        major: u8,
        minor: u8,
    },
    AskVersion,
    Firmware {
        major: u8,
        minor: u8,
        name: String,
    },
    AskFirmware,
    /// Of each pin its modes, each with its bits.
    Capabilities(Vec<Vec<(u8, u8)>>),
    AskCapabilities,
    /// Of each pin its analogue channel.
    AnalogMapping(Vec<Option<u8>>),
    AskAnalogMapping,
    PinMode {
        pin: u8,
        mode: u8,
    },
    ReportAnalog {
        channel: u8,
        on: bool,
    },
    ReportDigital {
        port: u8,
        on: bool,
    },
    /// Eight pins, from `port * 8` on.
    Digital {
        port: u8,
        pins: u8,
    },
    /// 14 bits, channels or pins up to 15.
    Analog {
        channel: u8,
        value: u16,
    },
    ExtendedAnalog {
        pin: u8,
        value: u32,
    },
    Text(String),
    SamplingInterval(u16),
    ServoConfig {
        pin: u8,
        min: u16,
        max: u16,
    },
    Reset,
    /// A system message of another kind.
    Other(Vec<u8>),
}

impl Message {
    pub fn encode(&self, bytes: &mut Vec<u8>) {
        match self {
            Message::Version { major, minor } => bytes.extend([0xf9, major & 0x7f, minor & 0x7f]),
            Message::AskVersion => bytes.push(0xf9),
            Message::PinMode { pin, mode } => bytes.extend([0xf4, pin & 0x7f, mode & 0x7f]),
            Message::ReportAnalog { channel, on } => bytes.extend([0xc0 | channel & 0xf, u8::from(*on)]),
            Message::ReportDigital { port, on } => bytes.extend([0xd0 | port & 0xf, u8::from(*on)]),
            Message::Digital { port, pins } => bytes.extend([0x90 | port & 0xf, pins & 0x7f, pins >> 7]),
            Message::Analog { channel, value } => {
                bytes.push(0xe0 | channel & 0xf);
                bytes.extend(halves(*value));
            }
            Message::Reset => bytes.push(0xff),
            _ => {
                bytes.push(START);
                self.encode_system(bytes);
                bytes.push(END);
            }
        }
    }

    fn encode_system(&self, bytes: &mut Vec<u8>) {
        match self {
            Message::Firmware { major, minor, name } => {
                bytes.extend([0x79, major & 0x7f, minor & 0x7f]);
                bytes.extend(name.bytes().flat_map(|byte| halves(byte.into())));
            }
            Message::AskFirmware => bytes.push(0x79),
            Message::Capabilities(pins) => {
                bytes.push(0x6c);
                for modes in pins {
                    bytes.extend(modes.iter().flat_map(|(mode, bits)| [mode & 0x7f, bits & 0x7f]));
                    bytes.push(0x7f);
                }
            }
            Message::AskCapabilities => bytes.push(0x6b),
            Message::AnalogMapping(channels) => {
                bytes.push(0x6a);
                bytes.extend(channels.iter().map(|channel| channel.unwrap_or(0x7f) & 0x7f));
            }
            Message::AskAnalogMapping => bytes.push(0x69),
            Message::ExtendedAnalog { pin, value } => {
                bytes.extend([0x6f, pin & 0x7f]);
                let mut rest = *value;
                loop {
                    bytes.push((rest & 0x7f) as u8);
                    rest >>= 7;
                    if rest == 0 {
                        break;
                    }
                }
            }
            Message::Text(text) => {
                bytes.push(0x71);
                bytes.extend(text.bytes().flat_map(|byte| halves(byte.into())));
            }
            Message::SamplingInterval(ms) => {
                bytes.push(0x7a);
                bytes.extend(halves(*ms));
            }
            Message::ServoConfig { pin, min, max } => {
                bytes.extend([0x70, pin & 0x7f]);
                bytes.extend(halves(*min));
                bytes.extend(halves(*max));
            }
            Message::Other(system) => bytes.extend(system.iter().map(|byte| byte & 0x7f)),
            _ => {}
        }
    }
}

fn halves(value: u16) -> [u8; 2] {
    [(value & 0x7f) as u8, (value >> 7 & 0x7f) as u8]
}

fn whole(low: u8, high: u8) -> u16 {
    u16::from(low) | u16::from(high) << 7
}

/// Which end of the conversation is heard: `f9` alone asks, with two bytes it answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum From {
    #[default]
    Board,
    Computer,
}

/// Takes bytes as they come, in pieces of any size.
#[derive(Default)]
pub struct Decoder {
    from: From,
    /// The message that has begun; empty: none.
    begun: Vec<u8>,
    /// Bytes that belong to no message.
    pub garbage: u64,
}

impl Decoder {
    pub fn of(from: From) -> Decoder {
        Decoder { from, ..Decoder::default() }
    }

    pub fn take(&mut self, bytes: &[u8]) -> Vec<Message> {
        bytes.iter().filter_map(|&byte| self.byte(byte)).collect()
    }

    fn byte(&mut self, byte: u8) -> Option<Message> {
        match (self.begun.first(), byte) {
            (Some(&START), END) => {
                let system = std::mem::take(&mut self.begun);
                return Some(decode_system(&system[1..]));
            }
            (Some(_), 0..0x80) if self.begun.len() >= LONGEST => self.drop_begun(),
            (Some(_), 0..0x80) => self.begun.push(byte),
            (None, 0..0x80) => self.garbage += 1,
            (_, 0x80..) => {
                // One that was cut off.
                self.drop_begun();
                self.begun.push(byte);
            }
        }
        let message = self.short()?;
        self.begun.clear();
        Some(message)
    }

    fn drop_begun(&mut self) {
        self.garbage += self.begun.len() as u64;
        self.begun.clear();
    }

    /// The message that has begun, if that is all of it.
    fn short(&mut self) -> Option<Message> {
        let message = match *self.begun.as_slice() {
            [0xff] => Message::Reset,
            [0xf9] if self.from == From::Computer => Message::AskVersion,
            [0xf9, major, minor] => Message::Version { major, minor },
            [0xf4, pin, mode] => Message::PinMode { pin, mode },
            [first @ 0xc0..=0xcf, on] => Message::ReportAnalog { channel: first & 0xf, on: on != 0 },
            [first @ 0xd0..=0xdf, on] => Message::ReportDigital { port: first & 0xf, on: on != 0 },
            [first @ 0x90..=0x9f, low, high] => Message::Digital { port: first & 0xf, pins: low | high << 7 },
            [first @ 0xe0..=0xef, low, high] => Message::Analog { channel: first & 0xf, value: whole(low, high) },
            [START | 0xf9 | 0xf4 | 0xc0..=0xdf | 0x90..=0x9f | 0xe0..=0xef, ..] | [] => return None,
            // Not one of Firmata's.
            _ => {
                self.drop_begun();
                return None;
            }
        };
        Some(message)
    }
}

fn decode_system(system: &[u8]) -> Message {
    match *system {
        [0x79] => Message::AskFirmware,
        [0x79, major, minor, ref name @ ..] => Message::Firmware { major, minor, name: text(name) },
        [0x6b] => Message::AskCapabilities,
        [0x6c, ref pins @ ..] => Message::Capabilities(capabilities(pins)),
        [0x69] => Message::AskAnalogMapping,
        [0x6a, ref channels @ ..] => {
            Message::AnalogMapping(channels.iter().map(|&channel| (channel != 0x7f).then_some(channel)).collect())
        }
        [0x6f, pin, ref value @ ..] if (1..=4).contains(&value.len()) => {
            let value = value.iter().rev().fold(0, |all, &part| all << 7 | u32::from(part));
            Message::ExtendedAnalog { pin, value }
        }
        [0x71, ref letters @ ..] => Message::Text(text(letters)),
        [0x7a, low, high] => Message::SamplingInterval(whole(low, high)),
        [0x70, pin, a, b, c, d] => Message::ServoConfig { pin, min: whole(a, b), max: whole(c, d) },
        _ => Message::Other(system.to_vec()),
    }
}

fn text(halves: &[u8]) -> String {
    let bytes: Vec<u8> = halves.chunks(2).map(|pair| pair[0] | pair.get(1).copied().unwrap_or(0) << 7).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

fn capabilities(bytes: &[u8]) -> Vec<Vec<(u8, u8)>> {
    let pins = bytes.strip_suffix(&[0x7f]).unwrap_or(bytes);
    if bytes.is_empty() {
        return Vec::new();
    }
    let modes = |pin: &[u8]| pin.chunks(2).filter(|pair| pair.len() == 2).map(|pair| (pair[0], pair[1])).collect();
    pins.split(|&byte| byte == 0x7f).map(modes).collect()
}
