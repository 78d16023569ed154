//! How a test wants its program to run: what may stand in the table after the program's name.

use mlua::Table;

use super::failure::Complaint;
use super::message::hint;
use crate::runtime::{OnEdit, OnError};
use crate::session::pace::Rate;

#[derive(Clone, Debug)]
pub struct Options {
    /// `sim`, or `robot=sim`; none: a stand-in for every robot.
    pub bridge: Option<String>,
    /// A world's file, as seen from the test's folder.
    pub world: Option<String>,
    pub rate: Rate,
    pub seed: u64,
    pub on_edit: OnEdit,
    pub on_error: OnError,
}

const KEYS: [&str; 6] = ["bridge", "world", "rate", "seed", "on_edit", "on_error"];

impl Options {
    pub fn read(table: Option<&Table>) -> Result<Options, Complaint> {
        let mut options = Options {
            bridge: None,
            world: None,
            rate: Rate::default(),
            seed: 1,
            on_edit: OnEdit::default(),
            on_error: OnError::default(),
        };
        for (key, value) in table.into_iter().flat_map(|table| table.pairs::<mlua::Value, mlua::Value>()).flatten() {
            let key = key.as_string().map_or_else(|| key.type_name().to_string(), |key| key.to_string_lossy());
            options.take(&key, &value)?;
        }
        match options {
            Options { world: Some(_), bridge: None, .. } => {
                Err(Complaint::new("`world` needs a robot that drives in it: add `bridge = \"sim\"`"))
            }
            options => Ok(options),
        }
    }

    fn take(&mut self, key: &str, value: &mlua::Value) -> Result<(), Complaint> {
        match key {
            "bridge" => self.bridge = Some(text(key, value)?),
            "world" => self.world = Some(text(key, value)?),
            "rate" => {
                let rate = value.as_number().or_else(|| value.as_integer().map(|hz| hz as f64)).and_then(Rate::new);
                self.rate = rate
                    .ok_or_else(|| Complaint::new(format!("`rate` is steps a second, from 0 to {}", Rate::MAX_HZ)))?;
            }
            "seed" => {
                let seed = value.as_integer().and_then(|seed| u64::try_from(seed).ok());
                self.seed = seed.ok_or_else(|| Complaint::new("`seed` is a whole number from 0 on"))?;
            }
            "on_edit" => {
                self.on_edit = match &*text(key, value)? {
                    "restart" => OnEdit::Restart,
                    "keep" => OnEdit::Keep,
                    _ => return Err(Complaint::new("`on_edit` is \"restart\" or \"keep\"")),
                };
            }
            "on_error" => match &*text(key, value)? {
                "continue" => self.on_error = OnError::Continue,
                "pause" => self.on_error = OnError::Pause,
                _ => return Err(Complaint::new("`on_error` is \"continue\" or \"pause\"")),
            },
            key => return Err(Complaint::new(format!("there is no option `{key}`; {}", hint(key, KEYS.into_iter())))),
        }
        Ok(())
    }
}

fn text(key: &str, value: &mlua::Value) -> Result<String, Complaint> {
    let text = value.as_string().map(|text| text.to_string_lossy());
    text.ok_or_else(|| Complaint::new(format!("`{key}` is a text in quotes, not a {}", value.type_name())))
}
