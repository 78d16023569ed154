//! Reads a program's text from the disk, or says in one line why it can't be. Knows nothing of what the text means.

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::syntax::Source;
use crate::syntax::nearest::nearest;

/// The longest text that is loaded, in bytes.
pub const LIMIT: u64 = 8 << 20;

/// Why a file gives no text. Displays as one line that begins with the path as the user gave it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// No such file; `nearest` is a file of the same folder with nearly that name.
    Missing {
        path: PathBuf,
        nearest: Option<String>,
    },
    /// The folder the file should be in doesn't exist.
    NoFolder {
        path: PathBuf,
        folder: PathBuf,
    },
    Directory {
        path: PathBuf,
    },
    /// A pipe, a socket or a device.
    NotAFile {
        path: PathBuf,
    },
    /// Nothing but white space, if that.
    Empty {
        path: PathBuf,
    },
    /// The first byte that isn't UTF-8; line and column are one-based, the column counts characters.
    NotUtf8 {
        path: PathBuf,
        line: usize,
        column: usize,
        byte: u8,
    },
    /// More than [`LIMIT`] bytes.
    TooLarge {
        path: PathBuf,
    },
    Forbidden {
        path: PathBuf,
    },
    Other {
        path: PathBuf,
        why: String,
    },
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { path, nearest: None } => write!(f, "{}: no such file", path.display()),
            Self::Missing { path, nearest: Some(name) } => {
                write!(f, "{}: no such file; did you mean `{name}`?", path.display())
            }
            Self::NoFolder { path, folder } => {
                write!(f, "{}: no such file; there is no folder `{}`", path.display(), folder.display())
            }
            Self::Directory { path } => {
                write!(f, "{}: this is a folder; name a file in it", path.display())
            }
            Self::NotAFile { path } => write!(f, "{}: this is a pipe or a device, not a file", path.display()),
            Self::Empty { path } => write!(f, "{}: the file is empty", path.display()),
            Self::NotUtf8 { path, line, column, byte } => {
                write!(f, "{}:{line}:{column}: not UTF-8 (byte 0x{byte:02X}); save the file as UTF-8", path.display())
            }
            Self::TooLarge { path } => {
                write!(f, "{}: larger than {} MiB; is this a program?", path.display(), LIMIT >> 20)
            }
            Self::Forbidden { path } => {
                write!(f, "{}: you may not read this file; see its permissions", path.display())
            }
            Self::Other { path, why } => write!(f, "{}: {why}", path.display()),
        }
    }
}

impl std::error::Error for Unreadable {}

/// The file's text, named by the path as given. Of a file over [`LIMIT`] nothing is read; of an endless one no more than that.
pub fn read(path: &Path) -> Result<Source, Unreadable> {
    let Some(bytes) = bytes(path).map_err(|error| explain(path, &error))? else {
        return Err(Unreadable::TooLarge { path: path.into() });
    };
    let text = String::from_utf8(bytes).map_err(|error| not_utf8(path, &error))?;
    if text.trim().is_empty() {
        return Err(Unreadable::Empty { path: path.into() });
    }
    Ok(Source::new(path.to_string_lossy(), text))
}

/// The same, but of nothing except a file: to open a pipe may take for ever.
pub fn read_file(path: &Path) -> Result<Source, Unreadable> {
    let kind = path.metadata().map_err(|error| explain(path, &error))?;
    if !kind.is_file() && !kind.is_dir() {
        return Err(Unreadable::NotAFile { path: path.into() });
    }
    read(path)
}

/// None where there are too many.
fn bytes(path: &Path) -> io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    let size = file.metadata()?.len();
    if size > LIMIT {
        return Ok(None);
    }
    let mut bytes = Vec::with_capacity(size as usize + 1);
    file.take(LIMIT + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= LIMIT).then_some(bytes))
}

fn explain(path: &Path, error: &io::Error) -> Unreadable {
    match error.kind() {
        io::ErrorKind::NotFound => missing(path),
        io::ErrorKind::IsADirectory => Unreadable::Directory { path: path.into() },
        io::ErrorKind::PermissionDenied => Unreadable::Forbidden { path: path.into() },
        _ => Unreadable::Other { path: path.into(), why: error.to_string() },
    }
}

fn missing(path: &Path) -> Unreadable {
    let folder = folder(path);
    if !folder.exists() {
        return Unreadable::NoFolder { path: path.into(), folder: folder.into() };
    }
    Unreadable::Missing { path: path.into(), nearest: nearest_file(folder, path) }
}

fn nearest_file(folder: &Path, path: &Path) -> Option<String> {
    let wanted = path.file_name()?.to_str()?;
    let mut names: Vec<String> = folder
        .read_dir()
        .ok()?
        .flatten()
        .filter(|entry| entry.path().is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    nearest_name(wanted, &names.iter().map(String::as_str).collect::<Vec<_>>()).map(str::to_owned)
}

/// Of some names of files the one that may have been meant: either the extension is mistyped or what stands before it,
/// and the other part is no likeness.
pub fn nearest_name<'a>(wanted: &str, names: &[&'a str]) -> Option<&'a str> {
    let Some((stem, extension)) = wanted.rsplit_once('.') else {
        return nearest(wanted, names.iter().copied());
    };
    let parts = || names.iter().filter_map(|name| name.rsplit_once('.'));
    let stems = parts().filter(|part| part.1 == extension).map(|part| part.0);
    let extensions = parts().filter(|part| part.0 == stem).map(|part| part.1);
    let meant = match nearest(stem, stems) {
        Some(near) => (near, extension),
        None => (stem, nearest(extension, extensions)?),
    };
    names.iter().copied().find(|name| name.rsplit_once('.') == Some(meant))
}

/// The folder a path lies in; a bare name lies in the current one.
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => path,
    }
}

fn not_utf8(path: &Path, error: &std::string::FromUtf8Error) -> Unreadable {
    let end = error.utf8_error().valid_up_to();
    let valid = String::from_utf8_lossy(&error.as_bytes()[..end]);
    let place = Source::new("", valid.as_ref()).position(end);
    Unreadable::NotUtf8 { path: path.into(), line: place.line, column: place.column, byte: error.as_bytes()[end] }
}
