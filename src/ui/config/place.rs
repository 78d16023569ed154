//! Where the configuration file is.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::Config;
use crate::runtime::record::Finding;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Somebody said so: it has to be there.
    Named(PathBuf),
    /// Where it is looked for otherwise.
    Usual(PathBuf),
    /// None is wanted, or there is no home to have one.
    Nowhere,
}

impl Place {
    /// `--config PATH` before `LRP_CONFIG` before the person's folder of configurations. An empty `LRP_CONFIG`: none.
    pub fn find(said: Option<&Path>, var: impl Fn(&str) -> Option<OsString>) -> Place {
        if let Some(path) = said {
            return Place::Named(path.into());
        }
        match var("LRP_CONFIG") {
            Some(path) if path.is_empty() => return Place::Nowhere,
            Some(path) => return Place::Named(path.into()),
            None => (),
        }
        // The rule for XDG_CONFIG_HOME: what isn't an absolute path doesn't count.
        let folder = var("XDG_CONFIG_HOME").map(PathBuf::from).filter(|path| path.is_absolute());
        let home = || var("HOME").filter(|home| !home.is_empty()).map(|home| Path::new(&home).join(".config"));
        folder.or_else(home).map_or(Place::Nowhere, |folder| Place::Usual(folder.join("lrp/config.toml")))
    }

    pub fn here(said: Option<&Path>) -> Place {
        Place::find(said, |name| env::var_os(name))
    }

    pub fn path(&self) -> Option<&Path> {
        match self {
            Place::Named(path) | Place::Usual(path) => Some(path),
            Place::Nowhere => None,
        }
    }
}

/// What the file says; a usual one may be missing.
pub fn load(place: &Place) -> Config {
    let Some(path) = place.path() else { return Config::default() };
    let name = path.display().to_string();
    match fs::read_to_string(path) {
        Ok(text) => Config::read(&name, &text),
        Err(error) if error.kind() == ErrorKind::NotFound && matches!(place, Place::Usual(_)) => Config::default(),
        Err(error) => Config { findings: vec![unreadable(name, &error)], ..Config::default() },
    }
}

fn unreadable(name: String, error: &std::io::Error) -> Finding {
    Finding {
        severity: "warning".into(),
        code: "config".into(),
        message: format!("{name} can't be read: {error}; everything is as by default"),
        help: None,
        file: name.into(),
        line: 0,
        column: 0,
    }
}
