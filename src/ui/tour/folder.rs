//! The tour's own folder: a program and a world to play with, and what was done so far. Nothing in it is ever overwritten
//! but the last.

use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use super::{STEPS, Tour};

/// Where it is when none is named.
pub const USUAL: &str = "lrp-tour";

const FILES: [(&str, &str); 2] = [("tour.lrp", include_str!("tour.lrp")), ("room.world", include_str!("room.world"))];

/// In the folder: what was done, a task a line.
const PROGRESS: &str = "progress";

/// Makes the folder and what isn't in it yet. The program's file.
pub fn open(folder: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    for (name, text) in FILES {
        match OpenOptions::new().write(true).create_new(true).open(folder.join(name)) {
            Ok(mut file) => file.write_all(text.as_bytes())?,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => (),
            Err(error) => return Err(error),
        }
    }
    Ok(folder.join(FILES[0].0))
}

/// The tour as far as it was taken in a folder.
pub fn resume(folder: &Path) -> Tour {
    let file = folder.join(FILES[0].0).display().to_string();
    Tour::new(file, &fs::read_to_string(folder.join(PROGRESS)).unwrap_or_default())
}

/// `4 of 14`, where a tour was begun.
pub fn begun(folder: &Path) -> Option<String> {
    let tour = resume(folder);
    (tour.done() > 0).then(|| format!("{} of {}", tour.done(), STEPS.len()))
}

pub fn keep(folder: &Path, tour: &Tour) -> io::Result<()> {
    fs::write(folder.join(PROGRESS), tour.progress())
}
