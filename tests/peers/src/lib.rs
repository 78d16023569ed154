//! The independent peers that bridges are tested against: whether they are here, and where. `tests/peers/setup` installs
//! them. A test asks for what it needs and is over where that is missing; one line on standard error says so.
//!
//! `LRP_PEERS=require`, or `CI=true`, makes a missing peer a failure; `LRP_PEERS=none` tests as if there were none.

use std::collections::BTreeSet;
use std::env::{split_paths, var, var_os};
use std::ffi::OsString;
use std::fs::{read, read_dir};
use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex};

/// A program by its name, as `socat`.
pub fn program(name: &str) -> Option<PathBuf> {
    WANTED.accept(name, HERE.program(name))
}

/// A file that a Debian package brings, as a header.
pub fn file(path: &str) -> Option<PathBuf> {
    WANTED.accept(path, Some(PathBuf::from(path)).filter(|path| path.is_file()))
}

/// The Python that has the packages of a list, as `ros2`.
pub fn python(list: &str) -> Option<PathBuf> {
    WANTED.accept(&format!("Python with {list}.txt"), HERE.python(list))
}

/// The same, where it also has the interfaces that a folder defines now.
pub fn python_with(list: &str, definitions: &Path) -> Option<PathBuf> {
    let what = format!("Python with {list}.txt and {}", definitions.display());
    WANTED.accept(&what, HERE.python_with(list, definitions))
}

static HERE: LazyLock<Places> = LazyLock::new(Places::of_environment);
static WANTED: LazyLock<Wanted> = LazyLock::new(Wanted::of_environment);

/// Where peers are looked for.
pub struct Places {
    /// Programs.
    pub path: Vec<PathBuf>,
    /// The environments of Python.
    pub folder: PathBuf,
}

impl Places {
    fn of_environment() -> Places {
        let folder = |name| var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let cache = || folder("XDG_CACHE_HOME").unwrap_or_else(|| folder("HOME").unwrap_or_default().join(".cache"));
        Places {
            path: var_os("PATH").map(|path| split_paths(&path).collect()).unwrap_or_default(),
            folder: folder("LRP_PEERS_DIR").unwrap_or_else(|| cache().join("lrp-peers")),
        }
    }

    pub fn program(&self, name: &str) -> Option<PathBuf> {
        self.path.iter().map(|folder| folder.join(name)).find(|path| path.is_file())
    }

    /// None also where it was made from another list, since it has other packages.
    pub fn python(&self, list: &str) -> Option<PathBuf> {
        let home = self.folder.join(list);
        let wanted = read(Path::new(env!("CARGO_MANIFEST_DIR")).join(list).with_extension("txt")).ok()?;
        (read(home.join("installed.txt")).ok()? == wanted).then(|| home.join("bin/python"))
    }

    /// None also where its interfaces were made of other definitions.
    pub fn python_with(&self, list: &str, definitions: &Path) -> Option<PathBuf> {
        let made = self.folder.join(list).join("interfaces");
        self.python(list).filter(|_| are_alike(&made, definitions))
    }
}

/// Whether two files, or all in two folders, read the same.
fn are_alike(one: &Path, other: &Path) -> bool {
    match (names(one), names(other)) {
        (Some(names), Some(others)) => {
            names == others && names.iter().all(|name| are_alike(&one.join(name), &other.join(name)))
        }
        (None, None) => read(one).is_ok_and(|text| read(other).is_ok_and(|other| other == text)),
        _ => false,
    }
}

/// What a folder has in it.
fn names(folder: &Path) -> Option<BTreeSet<OsString>> {
    Some(read_dir(folder).ok()?.flatten().map(|entry| entry.file_name()).collect())
}

/// What it means that a peer is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// It isn't tested against.
    IfHere,
    /// A failure.
    Required,
    /// Nothing: none is looked for.
    None,
}

impl Wanted {
    fn of_environment() -> Wanted {
        match (var("LRP_PEERS").as_deref(), var("CI").as_deref()) {
            (Ok("none"), _) => Wanted::None,
            (Ok("require"), _) | (_, Ok("true")) => Wanted::Required,
            _ => Wanted::IfHere,
        }
    }

    pub fn accept(self, what: &str, found: Option<PathBuf>) -> Option<PathBuf> {
        match (self, &found) {
            (Wanted::None, _) => return None,
            (Wanted::Required, None) => panic!("a peer is missing: {what}; tests/peers/setup installs it"),
            (Wanted::IfHere, None) => tell(what),
            (_, Some(_)) => {}
        }
        found
    }
}

/// Once for each peer, past the test harness, which keeps back what a passing test prints.
fn tell(what: &str) {
    static TOLD: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let mut told = TOLD.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if told.insert(what.to_string()) {
        let _ = writeln!(stderr(), "not tested against {what}: missing here, tests/peers/setup installs it");
    }
}
