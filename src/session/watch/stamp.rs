//! What tells from outside whether a file changed. Knows nothing of what is in it.

use std::fs::Metadata;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

/// Two equal stamps of a path mean the same bytes, as far as the file system's clock can tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Stamp {
    pub id: FileId,
    pub size: u64,
    /// Seconds and nanoseconds of the last change of the content, and of anything about the file.
    pub modified: (i64, i64),
    pub changed: (i64, i64),
}

/// Which file or folder it is, whatever its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId {
    pub device: u64,
    pub inode: u64,
}

impl Stamp {
    /// None where there is nothing to be seen.
    pub fn of(path: &Path) -> Option<Stamp> {
        let seen = path.metadata().ok()?;
        Some(Stamp {
            id: FileId::from(&seen),
            size: seen.size(),
            modified: (seen.mtime(), seen.mtime_nsec()),
            changed: (seen.ctime(), seen.ctime_nsec()),
        })
    }
}

impl From<&Metadata> for FileId {
    fn from(seen: &Metadata) -> FileId {
        FileId { device: seen.dev(), inode: seen.ino() }
    }
}
