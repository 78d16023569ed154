//! The files of a program that runs, as they were last saved whole: one that is just being written counts with the text
//! it had before. Files that are new to the program come from the disk. Knows nothing of when a save is whole.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use super::files::{Disk, Files};
use super::loader::Unreadable;
use super::watch::Watched;
use crate::syntax::Source;

/// Clones share the texts.
#[derive(Clone, Default)]
pub struct Settled(Rc<RefCell<BTreeMap<PathBuf, Arc<str>>>>);

impl Settled {
    /// These files and no others are part of the program, with these texts.
    pub fn take(&self, files: &[Watched]) {
        let texts = files.iter().filter_map(|file| Some((file.path.clone(), file.text.clone()?)));
        *self.0.borrow_mut() = texts.collect();
    }

    pub fn put(&self, path: PathBuf, text: Arc<str>) {
        self.0.borrow_mut().insert(path, text);
    }

    /// The file is gone or has no text: what the disk says of it counts.
    pub fn forget(&self, path: &Path) {
        self.0.borrow_mut().remove(path);
    }
}

impl Files for Settled {
    fn read(&self, path: &Path) -> Result<Source, Unreadable> {
        match self.0.borrow().get(path) {
            Some(text) => Ok(Source::new(path.to_string_lossy(), text.clone())),
            None => Disk.read(path),
        }
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        Disk.canonical(path)
    }
}
