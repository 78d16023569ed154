//! Texts that a test put in the place of files: a program finds them before those on the disk.

use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use super::bench::Library;
use crate::session::files::{Disk, Files};
use crate::session::{loader, modules};
use crate::syntax::Source;

/// Clones share the texts.
#[derive(Clone, Default)]
pub struct Written {
    /// What paths are relative to.
    base: PathBuf,
    texts: Rc<RefCell<HashMap<PathBuf, Arc<str>>>>,
}

impl Written {
    /// The same texts, where paths are relative to another folder.
    pub fn seen_from(&self, base: &Path) -> Written {
        Written { base: base.to_path_buf(), ..self.clone() }
    }

    pub fn put(&self, path: &Path, text: &str) {
        self.texts.borrow_mut().insert(self.canonical(path), text.into());
    }

    fn text(&self, path: &Path) -> Option<Arc<str>> {
        self.texts.borrow().get(&self.canonical(path)).cloned()
    }

    /// The Lua files of a folder.
    pub fn library(&self, folder: PathBuf) -> Library {
        let written = self.clone();
        let disk = modules::library(folder.clone(), |_, _| ());
        Box::new(move |module| {
            let path = modules::path(&folder, module)?;
            written.text(&path).map_or_else(|| disk(module), |text| Ok(text.to_string()))
        })
    }
}

impl Files for Written {
    fn read(&self, path: &Path) -> Result<Source, loader::Unreadable> {
        let name = path.display().to_string();
        match self.text(path) {
            Some(text) if text.trim().is_empty() => Err(loader::Unreadable::Empty { path: path.to_path_buf() }),
            Some(text) => Ok(Source::new(name, text)),
            None => Ok(Source::new(name, loader::read_file(&self.base.join(path))?.text)),
        }
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        Disk.canonical(&self.base.join(path))
    }
}
