//! Writes a text over a file as an editor would: whole or not at all, and only over the text that it was made from.
//! Knows nothing of what the texts say.

use std::fmt;
use std::fs::{self, File, Metadata, OpenOptions, Permissions};
use std::io::{self, Seek, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file's text and the one to take its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rewrite {
    pub file: Arc<str>,
    pub from: Arc<str>,
    pub to: String,
}

/// Why nothing was written. Displays as one line that names the file.
#[derive(Debug)]
pub enum NotWritten {
    /// It doesn't hold the text that the new one was made from.
    Changed {
        file: Arc<str>,
    },
    /// Nobody may write it.
    Forbidden {
        file: Arc<str>,
    },
    System {
        file: Arc<str>,
        error: io::Error,
    },
}

impl fmt::Display for NotWritten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotWritten::Changed { file } => {
                write!(f, "not written: {file} isn't what runs now; save it so that it runs, then again")
            }
            NotWritten::Forbidden { file } => write!(f, "not written: you may not write {file}; see its permissions"),
            NotWritten::System { file, error } => write!(f, "not written: {file}: {error}"),
        }
    }
}

impl Rewrite {
    /// Follows links to the file itself, which keeps its permissions, its owner and its other names.
    pub fn write(&self) -> Result<(), NotWritten> {
        self.try_write().map_err(|error| match error.kind() {
            io::ErrorKind::InvalidData => NotWritten::Changed { file: self.file.clone() },
            io::ErrorKind::PermissionDenied => NotWritten::Forbidden { file: self.file.clone() },
            _ => NotWritten::System { file: self.file.clone(), error },
        })
    }

    fn try_write(&self) -> io::Result<()> {
        let path = Path::new(&*self.file).canonicalize()?;
        // A file that may not be written isn't replaced either.
        let mut file = OpenOptions::new().read(true).write(true).open(&path)?;
        let metadata = file.metadata()?;
        self.is_unchanged(&path)?;
        match Temporary::beside(&path, &metadata, &self.to) {
            Ok(temporary) => {
                self.is_unchanged(&path)?;
                match temporary.take_the_place_of(&path) {
                    Ok(()) => Ok(()),
                    Err(_) => self.write_in_place(&mut file),
                }
            }
            Err(_) => self.write_in_place(&mut file),
        }
    }

    fn is_unchanged(&self, path: &Path) -> io::Result<()> {
        match fs::read(path)? == self.from.as_bytes() {
            true => Ok(()),
            false => Err(io::ErrorKind::InvalidData.into()),
        }
    }

    /// Never shorter than it has to be on the way: what follows the change is still there if this is cut off.
    fn write_in_place(&self, file: &mut File) -> io::Result<()> {
        file.rewind()?;
        file.write_all(self.to.as_bytes())?;
        file.set_len(self.to.len() as u64)?;
        file.sync_all()
    }
}

/// Removed when dropped, unless it took its place.
struct Temporary {
    path: PathBuf,
}

impl Temporary {
    /// Whole and on the disk. Fails where another file in its place would not be the same one: where it has several
    /// names, or another owner than what is made here.
    fn beside(path: &Path, like: &Metadata, text: &str) -> io::Result<Temporary> {
        if like.nlink() > 1 {
            return Err(io::ErrorKind::Unsupported.into());
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let path = path.with_file_name(format!(".{name}.{}.lrp-new", std::process::id()));
        let mut file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(&path)?;
        let temporary = Temporary { path };
        let made = file.metadata()?;
        if (made.uid(), made.gid()) != (like.uid(), like.gid()) {
            return Err(io::ErrorKind::Unsupported.into());
        }
        file.write_all(text.as_bytes())?;
        file.set_permissions(Permissions::from_mode(like.mode() & 0o7777))?;
        file.sync_all()?;
        Ok(temporary)
    }

    fn take_the_place_of(&self, path: &Path) -> io::Result<()> {
        fs::rename(&self.path, path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After the rename there is nothing left to remove.
        let _ = fs::remove_file(&self.path);
    }
}
