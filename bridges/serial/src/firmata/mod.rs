//! A board with Firmata on it, whose pins are the inputs and outputs. What it is asked at first, and what is made of
//! its answers; reports that nobody asked for, as boards send when they begin, are welcome at any time.

mod message;
mod pins;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lrp_bridge::{Call, Description, Level, Port};
use serde_json::{Value, json};

pub use message::{Decoder, From, Message};
pub use pins::{KEYS, Mode, Pin, Place, Settings, described};

use crate::codec::{Begun, Codec, Heard};
use crate::settings::Protocol;

/// How often a board that doesn't answer yet is asked: it may still begin.
const ASK: Duration = Duration::from_millis(500);
/// When a board is given up that has said nothing.
const SILENT: Duration = Duration::from_secs(8);
/// How long what it can do is waited for: some boards don't tell.
const LEARN: Duration = Duration::from_millis(1500);
/// How often a running board is asked whether it is there: digital pins are told only when they change.
const BEAT: Duration = Duration::from_millis(100);
/// When a board that ran is given up.
const GONE: Duration = Duration::from_secs(3);
/// Where the analogue pins begin on a board that doesn't tell: as on the Uno.
const FIRST_ANALOG: u8 = 14;

pub struct Board {
    settings: Settings,
    decoder: Decoder,
    phase: Phase,
    /// When it was last asked something, and last said something.
    asked: Instant,
    heard: Instant,
    /// Reports of its firmware that were asked for and haven't come.
    reports_due: u32,
    capabilities: Option<Vec<Vec<(u8, u8)>>>,
    channels: Option<Vec<Option<u8>>>,
    /// What the eight pins of each port are, as the board said.
    levels: BTreeMap<u8, u8>,
    /// What they are to be, as we said.
    wanted: BTreeMap<u8, u8>,
}

#[derive(Clone, Copy, PartialEq)]
enum Phase {
    /// Is there anybody?
    Asking {
        since: Instant,
    },
    /// Which pins has it?
    Learning {
        since: Instant,
    },
    Running,
}

impl Board {
    pub fn new(settings: Settings) -> Board {
        let now = Instant::now();
        Board {
            settings,
            decoder: Decoder::default(),
            phase: Phase::Asking { since: now },
            asked: now,
            heard: now,
            reports_due: 0,
            capabilities: None,
            channels: None,
            levels: BTreeMap::new(),
            wanted: BTreeMap::new(),
        }
    }

    fn ask(&mut self, now: Instant) -> Vec<u8> {
        self.asked = now;
        self.reports_due += 1;
        bytes(&[Message::AskVersion, Message::AskFirmware])
    }

    fn message(&mut self, message: Message, now: Instant, heard: &mut Vec<Heard>) {
        match message {
            Message::Version { .. } => self.somebody(now, heard),
            Message::Firmware { .. } => {
                let is_asked_for = self.reports_due > 0;
                self.reports_due = self.reports_due.saturating_sub(1);
                match self.phase {
                    Phase::Running if !is_asked_for => self.run(heard),
                    _ => self.somebody(now, heard),
                }
            }
            Message::Capabilities(pins) => {
                self.capabilities = Some(pins);
                self.perhaps_run(heard);
            }
            Message::AnalogMapping(channels) => {
                self.channels = Some(channels);
                self.perhaps_run(heard);
            }
            // From pins that were set up by somebody else.
            Message::Digital { .. } | Message::Analog { .. } if self.phase != Phase::Running => {}
            Message::Digital { port, pins } => self.digital(port, pins, heard),
            Message::Analog { channel, value } => self.analog(channel, value, heard),
            Message::Text(text) => heard.push(Heard::Log(Level::Info, text)),
            _ => {}
        }
    }

    fn somebody(&mut self, now: Instant, heard: &mut Vec<Heard>) {
        if matches!(self.phase, Phase::Asking { .. }) {
            self.phase = Phase::Learning { since: now };
            heard.push(Heard::Send(bytes(&[Message::AskCapabilities, Message::AskAnalogMapping])));
        }
    }

    fn perhaps_run(&mut self, heard: &mut Vec<Heard>) {
        let knows = self.capabilities.is_some() && self.channels.is_some();
        if knows && matches!(self.phase, Phase::Learning { .. }) {
            self.run(heard);
        }
    }

    /// Sets the pins up; also again, where the board has forgotten it.
    fn run(&mut self, heard: &mut Vec<Heard>) {
        self.phase = Phase::Running;
        self.levels.clear();
        self.wanted.clear();
        for (name, pin) in &self.settings.pins {
            heard.extend(self.unfit(name, pin).map(|why| Heard::Log(Level::Error, why)));
        }
        let mut messages = vec![Message::SamplingInterval(self.settings.sampling)];
        for pin in self.settings.pins.values() {
            messages.extend(self.set_up(pin));
        }
        heard.push(Heard::Send(bytes(&messages)));
        heard.push(Heard::Ready);
    }

    /// Why a pin can't do what it should.
    fn unfit(&self, name: &str, pin: &Pin) -> Option<String> {
        let capabilities = self.capabilities.as_ref()?;
        let can = |modes: &[(u8, u8)]| modes.iter().any(|(mode, _)| *mode == pin.mode.code());
        let number = self.number(pin.place);
        if number.and_then(|number| capabilities.get(usize::from(number))).is_some_and(|modes| can(modes)) {
            return None;
        }
        let others = capabilities.iter().enumerate().filter(|(_, modes)| can(modes));
        let others: Vec<String> = others.map(|(number, _)| number.to_string()).collect();
        let mode = pin.mode.name();
        Some(match others.is_empty() {
            true => format!("`{name}`: no pin of this board can do {mode}"),
            false => format!("`{name}`: that pin can't do {mode} on this board; pins that can: {}", others.join(", ")),
        })
    }

    fn number(&self, place: Place) -> Option<u8> {
        match (place, &self.channels) {
            (Place::Pin(number), _) => Some(number),
            (Place::Channel(channel), Some(channels)) => {
                let pin = channels.iter().position(|known| *known == Some(channel));
                pin.and_then(|pin| u8::try_from(pin).ok())
            }
            (Place::Channel(channel), None) => Some(FIRST_ANALOG + channel),
        }
    }

    fn channel(&self, place: Place) -> Option<u8> {
        match (place, &self.channels) {
            (Place::Channel(channel), _) => Some(channel),
            (Place::Pin(number), Some(channels)) => channels.get(usize::from(number)).copied().flatten(),
            (Place::Pin(number), None) => number.checked_sub(FIRST_ANALOG),
        }
    }

    fn set_up(&self, pin: &Pin) -> Vec<Message> {
        let Some(number) = self.number(pin.place) else { return Vec::new() };
        let mode = Message::PinMode { pin: number, mode: pin.mode.code() };
        [mode].into_iter().chain(self.report(pin, true)).collect()
    }

    fn report(&self, pin: &Pin, on: bool) -> Option<Message> {
        match pin.mode {
            Mode::Analog => Some(Message::ReportAnalog { channel: self.channel(pin.place)?, on }),
            Mode::Input | Mode::Pullup => Some(Message::ReportDigital { port: self.number(pin.place)? / 8, on }),
            Mode::Output | Mode::Pwm | Mode::Servo => None,
        }
    }

    fn digital(&mut self, port: u8, pins: u8, heard: &mut Vec<Heard>) {
        let changed = self.levels.insert(port, pins).map_or(0xff, |before| before ^ pins);
        self.tell_digital(port, pins, changed, heard);
    }

    fn tell_digital(&self, port: u8, pins: u8, which: u8, heard: &mut Vec<Heard>) {
        for (name, pin) in &self.settings.pins {
            let Some(number) = self.number(pin.place).filter(|number| number / 8 == port) else { continue };
            let bit = 1 << (number % 8);
            if matches!(pin.mode, Mode::Input | Mode::Pullup) && which & bit != 0 {
                let is_high = pins & bit != 0;
                heard.push(Heard::Input(name.clone(), json!({ "data": u8::from(is_high != pin.inverted) })));
            }
        }
    }

    fn analog(&self, channel: u8, value: u16, heard: &mut Vec<Heard>) {
        let is_it = |pin: &Pin| pin.mode == Mode::Analog && self.channel(pin.place) == Some(channel);
        let names = self.settings.pins.iter().filter(|(_, pin)| is_it(pin)).map(|(name, _)| name);
        heard.extend(names.map(|name| Heard::Input(name.clone(), json!({ "data": value }))));
    }

    /// A value already known to be within the pin's range.
    fn set(&mut self, pin: &Pin, value: f64) -> Option<Message> {
        let number = self.number(pin.place)?;
        match pin.mode {
            Mode::Output => {
                let (port, bit) = (number / 8, 1 << (number % 8));
                let pins = self.wanted.entry(port).or_default();
                *pins = if (value != 0.0) != pin.inverted { *pins | bit } else { *pins & !bit };
                Some(Message::Digital { port, pins: *pins })
            }
            Mode::Pwm | Mode::Servo if number < 16 => Some(Message::Analog { channel: number, value: value as u16 }),
            Mode::Pwm | Mode::Servo => Some(Message::ExtendedAnalog { pin: number, value: value as u32 }),
            Mode::Input | Mode::Pullup | Mode::Analog => None,
        }
    }

    fn halt<'p>(&mut self, pins: impl IntoIterator<Item = &'p Pin>) -> Vec<Message> {
        let stops = pins.into_iter().filter_map(|pin| Some((pin, pin.stop?)));
        stops.filter_map(|(pin, stop)| self.set(pin, stop)).collect()
    }
}

impl Codec for Board {
    fn offer(&self) -> Description {
        let of = |inputs| self.settings.pins.iter().filter(move |(_, pin)| pin.mode.is_input() == inputs);
        let port = |(name, pin): (&String, &Pin)| Port::new(name, json!({ "data": 0 }), pin.doc());
        Description {
            inputs: of(true).map(port).collect(),
            outputs: of(false).map(port).collect(),
            ..Description::default()
        }
    }

    fn open(&mut self, now: Instant) -> Vec<u8> {
        *self = Board { phase: Phase::Asking { since: now }, heard: now, ..Board::new(self.settings.clone()) };
        self.ask(now)
    }

    fn hear(&mut self, bytes: &[u8], now: Instant) -> Vec<Heard> {
        self.heard = now;
        let mut heard = Vec::new();
        for message in self.decoder.take(bytes) {
            let is_beat = matches!(message, Message::Version { .. }) && self.phase == Phase::Running;
            self.message(message, now, &mut heard);
            if is_beat {
                let levels = self.levels.clone();
                levels.into_iter().for_each(|(port, pins)| self.tell_digital(port, pins, 0xff, &mut heard));
            }
        }
        let garbage = std::mem::take(&mut self.decoder.garbage);
        if garbage > 0 && self.phase == Phase::Running {
            heard.push(Heard::Unreadable(format!("{garbage} bytes are no Firmata: is `baud` wrong?")));
        }
        heard
    }

    fn tick(&mut self, now: Instant) -> Vec<Heard> {
        let mut heard = Vec::new();
        match self.phase {
            Phase::Asking { since } if now.duration_since(since) >= SILENT => {
                let why =
                    format!("no Firmata answers within {} s: is it on the board, and `baud` right?", SILENT.as_secs());
                heard.push(Heard::Lost(why));
            }
            Phase::Asking { .. } if now.duration_since(self.asked) >= ASK => heard.push(Heard::Send(self.ask(now))),
            Phase::Learning { since } if now.duration_since(since) >= LEARN => self.run(&mut heard),
            Phase::Running if now.duration_since(self.heard) >= GONE => {
                heard.push(Heard::Lost(format!("the board has said nothing for {} s", GONE.as_secs())));
            }
            Phase::Running if now.duration_since(self.asked) >= BEAT => {
                self.asked = now;
                heard.push(Heard::Send(bytes(&[Message::AskVersion])));
            }
            _ => {}
        }
        heard
    }

    fn send(&mut self, output: &str, message: &Value) -> Result<Vec<u8>, String> {
        let pin = self.settings.pins.get(output).cloned().ok_or_else(|| format!("there is no output `{output}`"))?;
        let data = message.get("data").unwrap_or(message);
        let value = data.as_f64().or_else(|| data.as_bool().map(|on| f64::from(u8::from(on))));
        let value = value.ok_or("`data` should be a number")?.clamp(0.0, pin.mode.most()).round();
        let message = self.set(&pin, value).ok_or("the board has no such pin")?;
        Ok(bytes(&[message]))
    }

    fn call(&mut self, call: &Call, _: Instant) -> Result<Begun, String> {
        Err(format!("there is no call `{}`", call.call))
    }

    fn cancel(&mut self, _: u64) {}

    fn forget_calls(&mut self) -> Vec<u64> {
        Vec::new()
    }

    fn stop(&mut self) -> Vec<u8> {
        let pins = self.settings.pins.clone();
        bytes(&self.halt(pins.values()))
    }

    fn end_of_message(&self) -> Vec<u8> {
        vec![0xf7]
    }

    /// Pins that stay as they are aren't touched: a motor would falter.
    fn adopt(&mut self, protocol: &Protocol) -> Option<Vec<u8>> {
        let Protocol::Firmata(settings) = protocol else { return None };
        let before = std::mem::replace(&mut self.settings, settings.clone());
        if self.phase != Phase::Running {
            return Some(Vec::new());
        }
        let stays = |pin: &Pin, others: &Settings| others.pins.values().any(|other| other == pin);
        let gone: Vec<&Pin> = before.pins.values().filter(|pin| !stays(pin, settings)).collect();
        let new: Vec<&Pin> = settings.pins.values().filter(|pin| !stays(pin, &before)).collect();
        let mut messages = self.halt(gone.iter().copied());
        messages.extend(gone.iter().filter_map(|pin| self.report(pin, false)));
        messages.push(Message::SamplingInterval(settings.sampling));
        messages.extend(new.iter().flat_map(|pin| self.set_up(pin)));
        messages.extend(self.halt(new.iter().copied()));
        // A port that is no longer reported for one pin may still be wanted for another.
        messages.extend(settings.pins.values().filter_map(|pin| self.report(pin, true)));
        Some(bytes(&messages))
    }
}

impl Pin {
    fn doc(&self) -> String {
        let place = match self.place {
            Place::Pin(number) => format!("pin {number}"),
            Place::Channel(channel) => format!("pin A{channel}"),
        };
        let inverted = if self.inverted { ", inverted" } else { "" };
        format!("{} {place}, 0 to {}{inverted}", self.mode.name(), self.mode.most())
    }
}

fn bytes(messages: &[Message]) -> Vec<u8> {
    let mut bytes = Vec::new();
    messages.iter().for_each(|message| message.encode(&mut bytes));
    bytes
}
