//! The sensors known by name and their modes, and how a program says which mode it wants.

/// A sensor as the brick numbers it.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    pub number: u8,
    pub name: &'static str,
    pub modes: &'static [Mode],
}

#[derive(Debug, PartialEq, Eq)]
pub struct Mode {
    pub name: &'static str,
    /// The brick's own name for it.
    pub brick: &'static str,
    /// How many numbers it gives.
    pub values: u8,
    pub unit: &'static str,
}

const fn mode(name: &'static str, brick: &'static str, values: u8, unit: &'static str) -> Mode {
    Mode { name, brick, values, unit }
}

pub const TOUCH: u8 = 16;
pub const NXT_TOUCH: u8 = 1;
pub const COLOUR: u8 = 29;
pub const COLOUR_MODE: u8 = 2;

/// Sensors that are still finding out what they are, and empty ports.
const INITIALISING: u8 = 0x7d;
const EMPTY: u8 = 0x7e;

pub const KINDS: &[Kind] = &[
    Kind { number: TOUCH, name: "touch", modes: &[mode("pressed", "TOUCH", 1, ""), mode("bumps", "BUMPS", 1, "")] },
    Kind {
        number: COLOUR,
        name: "colour",
        modes: &[
            mode("reflected", "COL-REFLECT", 1, "%"),
            mode("ambient", "COL-AMBIENT", 1, "%"),
            mode("colour", "COL-COLOR", 1, ""),
            mode("reflected-raw", "REF-RAW", 2, ""),
            mode("rgb", "RGB-RAW", 3, ""),
            mode("calibration", "COL-CAL", 4, ""),
        ],
    },
    Kind {
        number: 30,
        name: "ultrasonic",
        modes: &[
            mode("cm", "US-DIST-CM", 1, "cm"),
            mode("inch", "US-DIST-IN", 1, "in"),
            mode("listen", "US-LISTEN", 1, ""),
            mode("single-cm", "US-SI-CM", 1, "cm"),
            mode("single-inch", "US-SI-IN", 1, "in"),
            mode("continuous-cm", "US-DC-CM", 1, "cm"),
            mode("continuous-inch", "US-DC-IN", 1, "in"),
        ],
    },
    Kind {
        number: 32,
        name: "gyro",
        modes: &[
            mode("angle", "GYRO-ANG", 1, "deg"),
            mode("rate", "GYRO-RATE", 1, "deg/s"),
            mode("fast", "GYRO-FAS", 1, ""),
            mode("angle-and-rate", "GYRO-G&A", 2, ""),
            mode("calibration", "GYRO-CAL", 4, ""),
        ],
    },
    Kind {
        number: 33,
        name: "infrared",
        modes: &[
            mode("proximity", "IR-PROX", 1, "%"),
            mode("seek", "IR-SEEK", 8, ""),
            mode("remote", "IR-REMOTE", 4, ""),
            mode("remote-raw", "IR-REM-A", 1, ""),
            mode("seek-alternative", "IR-S-ALT", 4, "%"),
            mode("calibration", "IR-CAL", 2, ""),
        ],
    },
    Kind {
        number: NXT_TOUCH,
        name: "nxt-touch",
        modes: &[mode("pressed", "NXT-TOUCH", 1, ""), mode("bumps", "NXT-BUMPS", 1, "")],
    },
    Kind {
        number: 2,
        name: "nxt-light",
        modes: &[mode("reflected", "NXT-REFLECT", 1, "%"), mode("ambient", "NXT-AMBIENT", 1, "%")],
    },
    Kind {
        number: 3,
        name: "nxt-sound",
        modes: &[mode("loudness", "NXT-SND-DB", 1, "%"), mode("loudness-as-heard", "NXT-SND-DBA", 1, "%")],
    },
    Kind {
        number: 5,
        name: "nxt-ultrasonic",
        modes: &[mode("cm", "NXT-US-CM", 1, "cm"), mode("inch", "NXT-US-IN", 1, "in")],
    },
    Kind { number: 7, name: "large-motor", modes: &[] },
    Kind { number: 8, name: "medium-motor", modes: &[] },
];

/// What colours the colour sensor sees, by the numbers it gives.
const COLOURS: [&str; 8] = ["none", "black", "blue", "green", "yellow", "red", "white", "brown"];

pub fn colour(number: f32) -> Option<&'static str> {
    COLOURS.get(number as usize).copied()
}

pub fn kind(number: u8) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.number == number)
}

/// What is plugged in, in a word.
pub fn name(number: u8) -> String {
    match number {
        INITIALISING => "initialising".to_string(),
        EMPTY => "none".to_string(),
        _ => kind(number).map_or_else(|| format!("type {number}"), |kind| kind.name.to_string()),
    }
}

/// Whether something is plugged in that can be told what to do.
pub fn is_ready(number: u8) -> bool {
    number != INITIALISING && number != EMPTY
}

pub fn mode_of(number: u8, mode: u8) -> Option<&'static Mode> {
    kind(number)?.modes.get(usize::from(mode))
}

/// The mode that a program wants of the sensor on a port.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Only of this kind of sensor.
    pub kind: Option<&'static Kind>,
    mode: Which,
}

#[derive(Clone, Debug, PartialEq)]
enum Which {
    Number(u8),
    Name(String),
}

impl Choice {
    pub fn number(number: u8) -> Option<Choice> {
        (number < 8).then_some(Choice { kind: None, mode: Which::Number(number) })
    }

    /// Reads `reflected`, `colour/reflected`, `COL-REFLECT` or `Mode2`.
    pub fn read(text: &str) -> Result<Choice, String> {
        let (kind, mode) = match text.split_once('/') {
            Some((kind, mode)) => (Some(kind_called(kind)?), mode),
            None => (None, text),
        };
        let digits = mode.strip_prefix("Mode").or_else(|| mode.strip_prefix("mode")).unwrap_or(mode);
        if let Ok(number @ 0..=7) = digits.parse() {
            return Ok(Choice { kind, mode: Which::Number(number) });
        }
        let mut kinds = KINDS.iter().filter(|known| kind.is_none_or(|kind| kind == *known));
        match kinds.any(|kind| mode_called(kind, mode).is_some()) {
            true => Ok(Choice { kind, mode: Which::Name(mode.to_string()) }),
            false => Err(unknown_mode(mode, kind)),
        }
    }

    /// The mode's number on the sensor that is there.
    pub fn on(&self, number: u8) -> Result<u8, String> {
        if let Some(wanted) = self.kind.filter(|kind| kind.number != number) {
            return Err(format!("a {} sensor is wanted, and this is {}", wanted.name, name(number)));
        }
        match &self.mode {
            Which::Number(mode) => Ok(*mode),
            Which::Name(mode) => match kind(number) {
                Some(kind) => mode_called(kind, mode).ok_or_else(|| unknown_mode(mode, Some(kind))),
                None => Err(format!("the modes of a sensor of {} are known by number only: `Mode0`", name(number))),
            },
        }
    }
}

fn kind_called(name: &str) -> Result<&'static Kind, String> {
    let name = british(name);
    let sensors = || KINDS.iter().filter(|kind| !kind.modes.is_empty());
    sensors().find(|kind| kind.name == name).ok_or_else(|| {
        let known: Vec<&str> = sensors().map(|kind| kind.name).collect();
        format!("no sensor is called `{name}`; there are {}", known.join(", "))
    })
}

fn mode_called(kind: &Kind, name: &str) -> Option<u8> {
    let british = british(name);
    let mode = kind.modes.iter().position(|mode| mode.name == british || mode.brick.eq_ignore_ascii_case(name))?;
    u8::try_from(mode).ok()
}

fn british(name: &str) -> String {
    name.to_ascii_lowercase().replace("color", "colour")
}

fn unknown_mode(mode: &str, kind: Option<&Kind>) -> String {
    match kind {
        Some(kind) => {
            let known: Vec<&str> = kind.modes.iter().map(|mode| mode.name).collect();
            format!("`{mode}` is no mode of {}; it has {}", kind.name, known.join(", "))
        }
        None => format!("no sensor has a mode `{mode}`; write its name, or `Mode0` to `Mode7`"),
    }
}
