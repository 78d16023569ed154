//! What a person may want otherwise, whatever the program: keys, colours, characters, whose the mouse is.

use super::glyphs::Charset;
use super::keymap::Keymap;
use super::pointer::Mouse;
use super::theme::{Palette, Theme};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    pub keys: Keymap,
    pub theme: Theme,
    pub charset: Charset,
    pub mouse: Mouse,
}

/// What the environment tells of the terminal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Surroundings {
    pub no_color: Option<String>,
    pub colorfgbg: Option<String>,
    pub term: Option<String>,
    /// The locale for characters: the first of `LC_ALL`, `LC_CTYPE` and `LANG` that is set and not empty.
    pub locale: Option<String>,
}

impl Surroundings {
    pub fn here() -> Surroundings {
        let var = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        Surroundings {
            no_color: var("NO_COLOR"),
            colorfgbg: var("COLORFGBG"),
            term: var("TERM"),
            locale: ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(var),
        }
    }

    /// Dark, unless the terminal says otherwise: `COLORFGBG` ends with the number of the ground's colour.
    pub fn palette(&self) -> Palette {
        if self.no_color.is_some() || self.is_of_old() {
            return Palette::Mono;
        }
        let ground = self.colorfgbg.as_deref().and_then(|colours| colours.rsplit(';').next()?.parse().ok());
        match ground {
            Some(7 | 9..=15) => Palette::Light,
            _ => Palette::Dark,
        }
    }

    /// vt100 and its kin have neither colours nor characters.
    fn is_of_old(&self) -> bool {
        self.term.as_deref().is_some_and(|term| term.starts_with("vt"))
    }

    /// UTF-8 where the locale names it, but for the console of Linux, whose font has a few hundred characters.
    pub fn charset(&self) -> Charset {
        let codeset = self.locale.as_deref().unwrap_or("").to_lowercase();
        let speaks = codeset.contains("utf-8") || codeset.contains("utf8");
        match speaks && self.term.as_deref() != Some("linux") && !self.is_of_old() {
            true => Charset::Unicode,
            false => Charset::Ascii,
        }
    }
}
