//! A program's other files in memory, and how a case in the corpus holds them: after `=== file NAME ===` stands the
//! text of one.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use lrp::session::files::{Files, plain};
use lrp::session::loader::{Unreadable, nearest_name};
use lrp::session::modules;
use lrp::syntax::Source;

/// Clones share the files.
#[derive(Clone, Default)]
pub struct Shelf(Rc<RefCell<BTreeMap<PathBuf, String>>>);

impl Shelf {
    pub fn of(files: Vec<(String, String)>) -> Shelf {
        let shelf = Shelf::default();
        files.into_iter().for_each(|(name, text)| shelf.put(&name, Some(text)));
        shelf
    }

    /// None: the file is gone.
    pub fn put(&self, name: &str, text: Option<String>) {
        let mut files = self.0.borrow_mut();
        match text {
            Some(text) => files.insert(name.into(), text),
            None => files.remove(Path::new(name)),
        };
    }

    /// What a block requires while it runs.
    pub fn module(&self, name: &str) -> Result<String, String> {
        let path = modules::path(Path::new(""), name)?;
        self.0.borrow().get(&path).cloned().ok_or_else(|| format!("there is no module `{name}`"))
    }
}

impl Files for Shelf {
    fn read(&self, path: &Path) -> Result<Source, Unreadable> {
        let files = self.0.borrow();
        match files.get(&self.canonical(path)) {
            Some(text) if text.trim().is_empty() => Err(Unreadable::Empty { path: path.into() }),
            Some(text) => Ok(Source::new(path.display().to_string(), text.as_str())),
            None => {
                let path = self.canonical(path);
                let beside = files.keys().filter(|it| it.parent() == path.parent());
                let names: Vec<&str> = beside.filter_map(|it| it.file_name()?.to_str()).collect();
                let near = nearest_name(path.file_name().and_then(|it| it.to_str()).expect("a name"), &names);
                Err(Unreadable::Missing { nearest: near.map(str::to_owned), path })
            }
        }
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        plain(path)
    }
}

/// The program's own text of a case, and its other files.
pub fn split(case: &str) -> (String, Vec<(String, String)>) {
    let (mut own, mut files): (String, Vec<(String, String)>) = Default::default();
    for line in case.split_inclusive('\n') {
        match line.trim_end().strip_prefix("=== file ").and_then(|rest| rest.strip_suffix(" ===")) {
            Some(name) => files.push((name.into(), String::new())),
            None => files.last_mut().map_or(&mut own, |(_, text)| text).push_str(line),
        }
    }
    (own, files)
}
