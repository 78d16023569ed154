//! The form's configuration: which port, how fast, in which protocol; and what is wrong with it.

use lrp_bridge::{Problem, Setting};
use serde_json::Value;

use crate::codec::Codec;
use crate::read::Read;
use crate::{firmata, lines};

const COMMON: [&str; 3] = ["port", "baud", "codec"];
const BAUDS: std::ops::RangeInclusive<f64> = 50.0..=4_000_000.0;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    pub line: Line,
    pub protocol: Protocol,
}

/// What has the port opened anew when it is edited.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// A path, a name, a pattern; none: the only one that there is.
    pub port: Option<String>,
    pub baud: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Protocol {
    Lines(lines::Settings),
    Firmata(firmata::Settings),
}

impl Default for Protocol {
    fn default() -> Protocol {
        Protocol::Lines(lines::Settings::default())
    }
}

impl Protocol {
    pub fn codec(&self) -> Box<dyn Codec> {
        match self {
            Protocol::Lines(settings) => Box::new(lines::Lines::new(settings.clone())),
            Protocol::Firmata(settings) => Box::new(firmata::Board::new(settings.clone())),
        }
    }
}

impl Settings {
    pub fn read(config: &Value) -> Result<Settings, Vec<Problem>> {
        let mut read = Read::new(config);
        let (protocol, usual_baud) = match read.text("codec") {
            Some("firmata") => {
                read.unknown_keys(&[&COMMON[..], &firmata::KEYS].concat(), "`firmata`");
                (Protocol::Firmata(firmata::Settings::read(&mut read)), 57_600)
            }
            None | Some("lines") => {
                read.unknown_keys(&[&COMMON[..], &lines::KEYS].concat(), "`lines`");
                (Protocol::Lines(lines::Settings::read(&mut read)), 115_200)
            }
            Some(other) => {
                read.wrong("codec", format!("there is no codec `{other}`"), "\"lines\" or \"firmata\"");
                (Protocol::default(), 115_200)
            }
        };
        let port = read.text("port").map(str::to_string);
        let baud = read.number("baud", BAUDS, "baud").map_or(usual_baud, |baud| baud as u32);
        match read.problems.is_empty() {
            true => Ok(Settings { line: Line { port, baud }, protocol }),
            false => Err(read.problems),
        }
    }
}

pub fn described() -> Vec<Setting> {
    let mut all = vec![
        Setting::new(
            "port",
            "a path, a name in /dev/serial/by-id or /dev, with `*` and `?`; left out: the only USB port there is",
        )
        .example("\"/dev/serial/by-id/usb-Arduino*\""),
        Setting::new("baud", "the line's speed; 115200 by default, for firmata 57600").example("9600"),
        Setting::new("codec", "what is spoken: \"lines\" of text, the default, or \"firmata\"").example("\"firmata\""),
    ];
    all.extend(lines::described());
    all.extend(firmata::described());
    all
}
