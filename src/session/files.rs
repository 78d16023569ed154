//! Where the texts of a program's files come from, and which paths lead to the same file. Knows nothing of what is in them.

use std::path::{Component, Path, PathBuf};

use super::loader::{self, Unreadable};
use crate::syntax::Source;

pub trait Files {
    /// A file's text, named by the path as given.
    fn read(&self, path: &Path) -> Result<Source, Unreadable>;

    /// The same for all paths of a file.
    fn canonical(&self, path: &Path) -> PathBuf;
}

pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> Result<Source, Unreadable> {
        loader::read_file(path)
    }

    /// Absolute, without links; of a file that doesn't exist, its folder.
    fn canonical(&self, path: &Path) -> PathBuf {
        if let Ok(path) = path.canonicalize() {
            return path;
        }
        match (loader::folder(path).canonicalize(), path.file_name()) {
            (Ok(folder), Some(name)) => folder.join(name),
            _ => plain(&std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())),
        }
    }
}

/// Without `.`, and without `..` where that leads back out of a folder it names.
pub fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let named = matches!(plain.components().next_back(), Some(Component::Normal(_)));
        match part {
            Component::CurDir => {}
            Component::ParentDir if named => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

/// How to come from a folder to a file; both canonical.
pub fn relative(folder: &Path, file: &Path) -> PathBuf {
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(file.components().skip(shared)).collect()
}
