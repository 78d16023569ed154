//! A text for the clipboard of the terminal that a person sits at, also over ssh: the sequence that asks a terminal to take
//! it (OSC 52). Knows nothing of what is copied.

/// Some terminals take no more.
const MOST: usize = 70_000;

/// What stands between the program and the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    Nothing,
    /// It takes the text for itself where `set-clipboard` is on, and passes it on where `allow-passthrough` is.
    Tmux,
}

impl Between {
    pub fn here() -> Between {
        if std::env::var_os("TMUX").is_some() { Between::Tmux } else { Between::Nothing }
    }
}

/// None where the text is too long.
pub fn sequence(text: &str, between: Between) -> Option<String> {
    if text.len() > MOST {
        return None;
    }
    let plain = format!("\x1b]52;c;{}\x07", base64(text.as_bytes()));
    Some(match between {
        Between::Nothing => plain,
        Between::Tmux => format!("{plain}\x1bPtmux;{}\x1b\\", plain.replace('\x1b', "\x1b\x1b")),
    })
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for digit in 0..4 {
            let index = bits >> (18 - 6 * digit) & 63;
            text.push(if digit <= three.len() { char::from(DIGITS[index as usize]) } else { '=' });
        }
    }
    text
}
