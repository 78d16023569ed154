//! The pins that the form names, each with what it does: `{ light = "analog A0", left = "pwm 5" }`.

use std::collections::BTreeMap;

use lrp_bridge::Setting;

use crate::read::Read;

pub const KEYS: [&str; 3] = ["pins", "sampling", "stop"];

const SAMPLING: f64 = 20.0;
const SAMPLINGS: std::ops::RangeInclusive<f64> = 1.0..=1000.0;
const HELP: &str = "as \"analog A0\", \"pullup 7\", \"pwm 5\"; there are input, pullup, output, analog, pwm, servo";

#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub pins: BTreeMap<String, Pin>,
    /// How often analogue pins are read, ms.
    pub sampling: u16,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Pin {
    pub place: Place,
    pub mode: Mode,
    /// 1 where the pin is low.
    pub inverted: bool,
    /// What halts it; none: it stays as it is.
    pub stop: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Pin(u8),
    /// As printed on the board: A0.
    Channel(u8),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Input,
    Pullup,
    Output,
    Analog,
    Pwm,
    Servo,
}

impl Mode {
    pub const ALL: [Mode; 6] = [Mode::Input, Mode::Pullup, Mode::Output, Mode::Analog, Mode::Pwm, Mode::Servo];

    pub fn name(self) -> &'static str {
        match self {
            Mode::Input => "input",
            Mode::Pullup => "pullup",
            Mode::Output => "output",
            Mode::Analog => "analog",
            Mode::Pwm => "pwm",
            Mode::Servo => "servo",
        }
    }

    /// Firmata's number for it.
    pub fn code(self) -> u8 {
        match self {
            Mode::Input => 0x00,
            Mode::Output => 0x01,
            Mode::Analog => 0x02,
            Mode::Pwm => 0x03,
            Mode::Servo => 0x04,
            Mode::Pullup => 0x0b,
        }
    }

    pub fn is_input(self) -> bool {
        matches!(self, Mode::Input | Mode::Pullup | Mode::Analog)
    }

    pub fn most(self) -> f64 {
        match self {
            Mode::Input | Mode::Pullup | Mode::Output => 1.0,
            Mode::Analog => 1023.0,
            Mode::Pwm => 255.0,
            Mode::Servo => 180.0,
        }
    }
}

pub fn described() -> Vec<Setting> {
    let setting = |name, doc, example: &str| Setting::new(name, doc).example(example);
    vec![
        setting(
            "pins",
            "firmata: what each pin does: input, pullup, output, analog, pwm or servo, then its number, then perhaps \"inverted\"",
            "{ light = \"analog A0\", left = \"pwm 5\" }",
        ),
        setting("sampling", "firmata: how often analogue pins are read, 1 to 1000 ms; 20 by default", "50"),
    ]
}

impl Settings {
    pub fn read(read: &mut Read) -> Settings {
        let mut pins = BTreeMap::new();
        for (name, place, value) in read.entries("pins", HELP) {
            let pin = value.as_str().ok_or("it is a text".to_string()).and_then(Pin::parse);
            match pin {
                Ok(pin) if read.is_name(name, &place) => {
                    pins.insert(name.to_string(), pin);
                }
                Ok(_) => {}
                Err(problem) => read.wrong(&place, format!("`{place}`: {problem}"), HELP),
            }
        }
        twice(read, &pins);
        stops(read, &mut pins);
        let sampling = read.number("sampling", SAMPLINGS, "ms").unwrap_or(SAMPLING) as u16;
        Settings { pins, sampling }
    }
}

fn twice(read: &mut Read, pins: &BTreeMap<String, Pin>) {
    let all: Vec<(&String, &Pin)> = pins.iter().collect();
    for (at, (name, pin)) in all.iter().enumerate() {
        if let Some((other, _)) = all[..at].iter().find(|(_, other)| other.place == pin.place) {
            read.wrong(&format!("pins.{name}"), format!("`{name}` and `{other}` are the same pin"), "leave one out");
        }
    }
}

fn stops(read: &mut Read, pins: &mut BTreeMap<String, Pin>) {
    for (name, place, value) in read.entries("stop", "for firmata, as `{ arm = 90 }`") {
        let pin = pins.get_mut(name).filter(|pin| !pin.mode.is_input());
        match (pin, value.as_f64()) {
            (Some(pin), Some(value)) if (0.0..=pin.mode.most()).contains(&value) => pin.stop = Some(value),
            (Some(pin), _) => {
                let message = format!("`{place}` is a number from 0 to {}", pin.mode.most());
                read.wrong(&place, message, "the value that halts it");
            }
            (None, _) => read.wrong(&place, format!("no pin `{name}` can be set"), "name it in `pins` first"),
        }
    }
}

impl Pin {
    fn parse(text: &str) -> Result<Pin, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let (mode, place, inverted) = match *words.as_slice() {
            [mode, place] => (mode, place, false),
            [mode, place, "inverted"] => (mode, place, true),
            _ => return Err(format!("`{text}` is no mode and pin")),
        };
        let known = Mode::ALL.into_iter().find(|known| known.name() == mode);
        let mode = known.ok_or_else(|| format!("there is no mode `{mode}`"))?;
        if inverted && !matches!(mode, Mode::Input | Mode::Pullup | Mode::Output) {
            return Err(format!("{} can't be inverted", mode.name()));
        }
        let place = Place::parse(place).ok_or_else(|| format!("`{place}` is no pin"))?;
        // A servo would be sent somewhere, the others are let go.
        let stop = matches!(mode, Mode::Output | Mode::Pwm).then_some(0.0);
        Ok(Pin { place, mode, inverted, stop })
    }
}

impl Place {
    fn parse(text: &str) -> Option<Place> {
        let channel = text.strip_prefix(['A', 'a']);
        let number: u8 = channel.unwrap_or(text).parse().ok()?;
        match channel {
            Some(_) => Some(Place::Channel(number)).filter(|_| number < 16),
            None => Some(Place::Pin(number)).filter(|_| number < 127),
        }
    }
}
