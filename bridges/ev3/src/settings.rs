//! The form's configuration: which brick, what is plugged in, how often it is read; and what is wrong with it.

use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;
use std::time::Duration;

use lrp_bridge::{Problem, Setting};
use serde_json::Value;

use crate::discovery;
use crate::motor::Motor;
use crate::sensor::Choice;

/// Where bricks listen.
const PORT: u16 = 5555;

const RATES: RangeInclusive<f64> = 1.0..=50.0;
const RATE: f64 = 20.0;

#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub place: Place,
    /// How often everything is read, Hz.
    pub rate: f64,
    /// The modes that the sensors are to be in.
    pub modes: [Option<Choice>; 4],
    /// Motors that turn the other way.
    pub reversed: [bool; 4],
}

/// Where the brick is.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    Address {
        host: String,
        port: u16,
    },
    /// Found by its beacon: the first that is as wanted.
    Heard {
        port: u16,
        wanted: Wanted,
    },
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wanted {
    pub name: Option<String>,
    pub serial: Option<String>,
}

impl Display for Wanted {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match (&self.name, &self.serial) {
            (Some(name), _) => write!(f, "the brick `{name}`"),
            (None, Some(serial)) => write!(f, "the brick {serial}"),
            (None, None) => f.write_str("a brick"),
        }
    }
}

pub fn described() -> Vec<Setting> {
    vec![
        Setting::new("name", "the brick's name, as it shows it; left out: the first brick that is heard")
            .example("\"EV3\""),
        Setting::new("serial", "the brick's serial number, from its Brick Info page").example("\"0016533F0C1E\""),
        Setting::new(
            "address",
            "the brick's address, to connect without listening for it; port 5555 unless one is given",
        )
        .example("\"192.168.0.17\""),
        Setting::new("sensors", "the mode of the sensor on each port, by name or number; left out: as it is")
            .example("{ \"colour/reflected\", \"touch\", [4] = \"Mode1\" }"),
        Setting::new("reversed", "motors that are mounted the other way round: their speeds and degrees change sign")
            .example("{ \"B\", \"C\" }"),
        Setting::new("rate", "how often sensors and motors are read, 1 to 50 Hz; 20 by default").example("20"),
        Setting::new("discovery", "the UDP port on which bricks are heard; 3015 by default").example("3015"),
    ]
}

impl Settings {
    pub fn read(config: &Value) -> Result<Settings, Vec<Problem>> {
        let mut read = Read { config, problems: Vec::new() };
        read.unknown_keys();
        let settings =
            Settings { place: read.place(), rate: read.rate(), modes: read.modes(), reversed: read.reversed() };
        if read.problems.is_empty() { Ok(settings) } else { Err(read.problems) }
    }

    /// The sign of a motor's speeds and degrees.
    pub fn sign(&self, motor: Motor) -> i32 {
        if self.reversed[motor.index()] { -1 } else { 1 }
    }

    /// How long from one reading to the next.
    pub fn period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / self.rate)
    }
}

struct Read<'a> {
    config: &'a Value,
    problems: Vec<Problem>,
}

impl<'a> Read<'a> {
    fn unknown_keys(&mut self) {
        let known: Vec<String> = described().into_iter().map(|setting| setting.name).collect();
        for key in self.config.as_object().into_iter().flatten().map(|(key, _)| key) {
            if !known.contains(key) {
                let problem = Problem::new(format!("`ev3` has no setting `{key}`")).at(key.as_str());
                self.problems.push(problem.help(format!("it has {}", known.join(", "))));
            }
        }
    }

    fn place(&mut self) -> Place {
        let wanted = Wanted { name: self.text("name"), serial: self.text("serial").map(plain_serial) };
        let port = self.port("discovery").unwrap_or(discovery::PORT);
        let Some(address) = self.text("address") else { return Place::Heard { port, wanted } };
        if wanted.name.is_some() {
            let problem = Problem::new("`address` says already which brick it is").at("name");
            self.problems.push(problem.help("leave `name` or `address` out"));
        }
        let (host, port) = match address.rsplit_once(':') {
            // More colons are an address of IP version 6.
            Some((host, port)) if !host.contains(':') => (host.to_string(), port.parse().ok().filter(|&port| port > 0)),
            _ => (address.clone(), Some(PORT)),
        };
        if host.is_empty() || port.is_none() {
            let problem = Problem::new(format!("`{address}` is no address")).at("address");
            self.problems.push(problem.help("a host's name or number, as `192.168.0.17` or `192.168.0.17:5555`"));
        }
        Place::Address { host, port: port.unwrap_or(PORT) }
    }

    fn rate(&mut self) -> f64 {
        let Some(value) = self.given("rate") else { return RATE };
        value.as_f64().filter(|rate| RATES.contains(rate)).unwrap_or_else(|| {
            self.wrong("rate", "`rate` is a number of Hz from 1 to 50", "20 is enough for most robots");
            RATE
        })
    }

    fn modes(&mut self) -> [Option<Choice>; 4] {
        let mut modes = [const { None }; 4];
        let Some(sensors) = self.given("sensors") else { return modes };
        for (key, value) in entries(sensors) {
            let place = format!("sensors.{key}");
            let Some(port @ 1..=4) = key.strip_prefix("sensor").unwrap_or(&key).parse::<usize>().ok() else {
                self.wrong(&place, format!("there is no sensor port `{key}`"), "ports are 1 to 4");
                continue;
            };
            match choice(value) {
                Ok(choice) => modes[port - 1] = choice,
                Err(problem) => self.wrong(&place, problem, "as `\"colour/reflected\"`, `\"touch\"` or `\"Mode2\"`"),
            }
        }
        modes
    }

    fn reversed(&mut self) -> [bool; 4] {
        let mut reversed = [false; 4];
        let Some(motors) = self.given("reversed") else { return reversed };
        let motors = if motors.is_string() { vec![motors] } else { entries(motors).map(|(_, value)| value).collect() };
        for value in motors {
            match value.as_str().and_then(Motor::of_letter) {
                Some(motor) => reversed[motor.index()] = true,
                None => self.wrong("reversed", format!("{value} is no motor"), "a list of letters A to D"),
            }
        }
        reversed
    }

    fn given(&self, key: &str) -> Option<&'a Value> {
        self.config.get(key).filter(|value| !value.is_null())
    }

    fn text(&mut self, key: &str) -> Option<String> {
        let value = self.given(key)?;
        match value.as_str().filter(|text| !text.is_empty()) {
            Some(text) => Some(text.to_string()),
            None => {
                self.wrong(key, format!("`{key}` is a text"), "put it between quotes");
                None
            }
        }
    }

    fn port(&mut self, key: &str) -> Option<u16> {
        let value = self.given(key)?;
        let port = value.as_u64().and_then(|port| u16::try_from(port).ok()).filter(|&port| port > 0);
        if port.is_none() {
            self.wrong(key, format!("`{key}` is a port, 1 to 65535"), "leave it out for the usual one");
        }
        port
    }

    fn wrong(&mut self, key: &str, message: impl Into<String>, help: &str) {
        self.problems.push(Problem::new(message).at(key).help(help));
    }
}

/// A list's elements by number, from 1 as in Lua, or a table's by key.
fn entries(value: &Value) -> Box<dyn Iterator<Item = (String, &Value)> + '_> {
    match value {
        Value::Array(list) => Box::new(list.iter().enumerate().map(|(index, value)| ((index + 1).to_string(), value))),
        Value::Object(table) => Box::new(table.iter().map(|(key, value)| (key.clone(), value))),
        _ => Box::new(std::iter::once((value.to_string(), &Value::Null))),
    }
}

/// A kind alone leaves the mode at the first.
fn choice(value: &Value) -> Result<Option<Choice>, String> {
    match value {
        Value::Null => Ok(None),
        Value::Number(number) => {
            let choice = number.as_u64().and_then(|number| Choice::number(u8::try_from(number).ok()?));
            choice.map(Some).ok_or_else(|| format!("{number} is no mode; modes are 0 to 7"))
        }
        Value::String(text) => {
            Choice::read(text).or_else(|problem| Choice::read(&format!("{text}/Mode0")).map_err(|_| problem)).map(Some)
        }
        _ => Err(format!("{value} is no mode")),
    }
}

/// Serial numbers are also written with colons.
fn plain_serial(serial: String) -> String {
    serial.replace([':', '-'], "").to_ascii_uppercase()
}
