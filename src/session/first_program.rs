//! A first program that runs in the simulator, made to be edited: `lrp new NAME`, and the welcome.

use std::fmt;
use std::fs::OpenOptions;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

const TEMPLATE: &str = include_str!("first_program.lrp");

/// Why there is no new file. Displays as one sentence.
#[derive(Debug)]
pub enum NotMade {
    /// Nothing stands before the `.lrp`.
    Nameless,
    Exists {
        file: PathBuf,
    },
    NoFolder {
        file: PathBuf,
        folder: PathBuf,
    },
    System {
        file: PathBuf,
        error: io::Error,
    },
}

impl fmt::Display for NotMade {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            NotMade::Nameless => f.write_str("a new behaviour needs a name, such as rover"),
            NotMade::Exists { file } => {
                let file = file.display();
                write!(f, "{file} exists already and stays as it is; choose another name, or run it: lrp {file}")
            }
            NotMade::NoFolder { file, folder } => {
                write!(f, "{} can't be made: there is no folder {}", file.display(), folder.display())
            }
            NotMade::System { file, error } => write!(f, "{} can't be made: {error}", file.display()),
        }
    }
}

/// The file that was made; `.lrp` is added where it is missing.
pub fn create(name: &str) -> Result<PathBuf, NotMade> {
    let stem = name.trim().strip_suffix(".lrp").unwrap_or(name.trim());
    if stem.is_empty() || stem.ends_with('/') {
        return Err(NotMade::Nameless);
    }
    let file = PathBuf::from(format!("{stem}.lrp"));
    let made = OpenOptions::new().write(true).create_new(true).open(&file);
    match made.and_then(|mut out| out.write_all(TEMPLATE.as_bytes())) {
        Ok(()) => Ok(file),
        Err(error) => Err(why(file, error)),
    }
}

fn why(file: PathBuf, error: io::Error) -> NotMade {
    match (error.kind(), file.parent().map(Path::to_path_buf)) {
        (ErrorKind::AlreadyExists, _) => NotMade::Exists { file },
        (ErrorKind::NotFound, Some(folder)) if !folder.exists() => NotMade::NoFolder { file, folder },
        _ => NotMade::System { file, error },
    }
}
