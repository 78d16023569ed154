//! A person's configuration file: text in, settings and what is wrong with it out. What can't be used leaves its default.

mod keys;
mod place;

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub use place::{Place, load};

use super::glyphs::Charset;
use super::keymap::Keymap;
use super::pointer::Mouse;
use super::settings::{Settings, Surroundings};
use super::theme::{self, Palette, TABLE, Theme};
use crate::runtime::record::Finding;
use crate::syntax::Source;
use crate::syntax::nearest::nearest;

/// The settings of this person at this terminal, where nothing is said on the command line.
pub fn usual() -> Settings {
    load(&Place::here(None)).settings(Look::default(), &Surroundings::here())
}

/// What is said on the command line, or in the file; none: as the terminal seems to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Look {
    pub palette: Option<Palette>,
    pub charset: Option<Charset>,
    pub mouse: Option<Mouse>,
}

impl Look {
    /// What isn't said here is said there.
    pub fn or(self, other: Look) -> Look {
        Look {
            palette: self.palette.or(other.palette),
            charset: self.charset.or(other.charset),
            mouse: self.mouse.or(other.mouse),
        }
    }
}

/// What a file says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Config {
    pub look: Look,
    pub keys: Keymap,
    /// Styles of roles, by their ids.
    pub colours: Vec<(&'static str, ratatui::style::Style)>,
    pub findings: Vec<Finding>,
}

impl Config {
    /// With what the command line says before it, and the terminal behind.
    pub fn settings(self, said: Look, surroundings: &Surroundings) -> Settings {
        let look = said.or(self.look);
        let palette = look.palette.unwrap_or_else(|| surroundings.palette());
        let mut theme = Theme::of(palette);
        // Who wants no colours wants none of these either.
        for (id, style) in self.colours.into_iter().filter(|_| palette != Palette::Mono) {
            theme.set(id, style);
        }
        let charset = look.charset.unwrap_or_else(|| surroundings.charset());
        Settings { keys: self.keys, theme, charset, mouse: look.mouse.unwrap_or_default() }
    }

    /// `name`: of the file, for what is wrong with it.
    pub fn read(name: &str, text: &str) -> Config {
        let mut reader = Reader { source: Source::new(name, text), config: Config::default() };
        match DeTable::parse(text) {
            Ok(table) => reader.top(table.get_ref()),
            Err(error) => {
                let message = format!("{}; nothing of this file is used", error.message().trim());
                reader.finding(error.span().unwrap_or(0..0), message, "values are written as in step = \"s\"");
            }
        }
        reader.config.findings.sort_by_key(|finding| (finding.line, finding.column));
        reader.config
    }
}

const NAMES: [&str; 5] = ["theme", "ascii", "mouse", "keys", "colours"];

struct Reader {
    source: Source,
    config: Config,
}

impl Reader {
    fn finding(&mut self, at: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        let position = self.source.position(at.start);
        self.config.findings.push(Finding {
            severity: "warning".into(),
            code: "config".into(),
            message: message.into(),
            help: Some(help.into()),
            file: self.source.name.clone(),
            line: position.line,
            column: position.column,
        });
    }

    fn top(&mut self, table: &DeTable) {
        for (name, value) in in_order(table) {
            match (&**name.get_ref(), value.get_ref()) {
                ("theme", DeValue::String(text)) => self.theme(text, value.span()),
                ("ascii", DeValue::Boolean(yes)) => {
                    self.config.look.charset = Some(if *yes { Charset::Ascii } else { Charset::Unicode });
                }
                ("mouse", DeValue::Boolean(yes)) => {
                    self.config.look.mouse = Some(if *yes { Mouse::Ours } else { Mouse::Terminals });
                }
                ("keys", DeValue::Table(rows)) => self.keys(rows),
                ("colours", DeValue::Table(rows)) => self.colours(rows),
                ("theme", _) => self.finding(value.span(), "`theme` is a word", THEMES),
                ("ascii", _) => self.finding(value.span(), "`ascii` is true or false", "without it the locale decides"),
                ("mouse", _) => {
                    self.finding(
                        value.span(),
                        "`mouse` is true or false",
                        "false leaves it to the terminal, to select text",
                    );
                }
                ("keys" | "colours", _) => {
                    let help = format!("write [{0}] on a line of its own, and its rows below", name.get_ref());
                    self.finding(value.span(), format!("`{}` is a table", name.get_ref()), help);
                }
                (other, _) => {
                    let message = format!("`{other}` is nothing that can be configured");
                    self.finding(name.span(), message, did_you_mean(other, &NAMES));
                }
            }
        }
    }

    fn theme(&mut self, text: &str, at: Range<usize>) {
        match Palette::named(text) {
            Some(palette) => self.config.look.palette = Some(palette),
            None if text == "auto" => (),
            None => self.finding(at, format!("there is no theme `{text}`"), THEMES),
        }
    }

    fn colours(&mut self, rows: &DeTable) {
        let ids: Vec<&'static str> = TABLE.iter().map(|meaning| meaning.id).collect();
        for (name, value) in in_order(rows) {
            let id = &**name.get_ref();
            let Some(id) = ids.iter().find(|known| **known == id) else {
                let message = format!("`{id}` is nothing that has a colour");
                self.finding(name.span(), message, did_you_mean(id, &ids));
                continue;
            };
            match value.get_ref().as_str().ok_or_else(|| format!("`{id}` takes words")).and_then(theme::style) {
                Ok(style) => self.config.colours.push((id, style)),
                Err(message) => self.finding(value.span(), message, theme::WORDS),
            }
        }
    }
}

const THEMES: &str = "\"dark\", \"light\", \"mono\" or \"auto\"";

/// As they stand in the file.
fn in_order<'a, 'i>(table: &'a DeTable<'i>) -> Vec<(&'a Spanned<toml::de::DeString<'i>>, &'a Spanned<DeValue<'i>>)> {
    let mut rows: Vec<_> = table.iter().collect();
    rows.sort_by_key(|(name, _)| name.span().start);
    rows
}

fn did_you_mean(wrong: &str, known: &[&str]) -> String {
    match nearest(wrong, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.len() > 8 => "docs/config.md lists the names".into(),
        None => format!("there is: {}", known.join(", ")),
    }
}
