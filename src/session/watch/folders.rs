//! Which folders the system is asked to watch, so that every way to change some files is noticed. Folders rather than
//! files, for a save may put a new file in the old one's place. Knows nothing of what is done about it.

use std::collections::{BTreeSet, HashMap};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind, RenameMode};
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher, WatcherKind};

use super::settling::Stir;
use super::stamp::FileId;
use crate::session::loader::folder;

/// Something happened to the file of this name in one of the folders; without a name, to any of them.
pub struct Happened {
    pub name: Option<OsString>,
    pub how: Stir,
}

pub struct Folders {
    /// None where the system has no watches left to give: then only polling notices changes.
    watcher: Option<RecommendedWatcher>,
    watched: HashMap<FolderId, PathBuf>,
}

/// With its time of birth, for a new folder may get a deleted one's number.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct FolderId {
    file: FileId,
    born: Option<SystemTime>,
}

impl FolderId {
    fn of(folder: &Path) -> Option<FolderId> {
        let seen = folder.metadata().ok()?;
        Some(FolderId { file: FileId::from(&seen), born: seen.created().ok() })
    }
}

impl Folders {
    /// Calls `tell` from another thread.
    pub fn new(tell: impl Fn(Happened) + Send + 'static) -> Folders {
        let watcher = notify::recommended_watcher(move |event| happened(event).into_iter().for_each(&tell)).ok();
        Folders { watcher, watched: HashMap::new() }
    }

    /// Watches the folders of these files from now on, and no others. To be called again from time to time, for folders
    /// come, go and are replaced. One that can't be watched is left out.
    pub fn follow(&mut self, files: &BTreeSet<PathBuf>) {
        let Some(watcher) = &mut self.watcher else {
            return;
        };
        let wanted: HashMap<FolderId, PathBuf> = files
            .iter()
            .map(|file| folder(file))
            .filter_map(|folder| Some((FolderId::of(folder)?, folder.to_owned())))
            .collect();
        self.watched.retain(|id, folder| {
            let keep = wanted.contains_key(id);
            if !keep {
                // A folder that was deleted is watched no longer anyway.
                let _ = watcher.unwatch(folder);
            }
            keep
        });
        for (id, folder) in wanted {
            if !self.watched.contains_key(&id) && watcher.watch(&folder, RecursiveMode::NonRecursive).is_ok() {
                self.watched.insert(id, folder);
            }
        }
    }
}

/// As many links as systems follow before they call it a loop.
const LINKS: usize = 40;

/// The path, absolute, and all that it leads to through symbolic links.
pub fn trail(path: &Path) -> Vec<PathBuf> {
    let start = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let next = |file: &PathBuf| Some(folder(file).join(file.read_link().ok()?));
    std::iter::successors(Some(start), next).take(LINKS).collect()
}

fn happened(event: notify::Result<Event>) -> Vec<Happened> {
    let Ok(event) = event else {
        return vec![Happened { name: None, how: Stir::Touched }];
    };
    let Some(how) = stir(event.kind) else {
        return Vec::new();
    };
    if event.paths.is_empty() || event.need_rescan() {
        return vec![Happened { name: None, how: Stir::Touched }];
    }
    let names = event.paths.iter().filter_map(|path| path.file_name());
    names.map(|name| Happened { name: Some(name.to_owned()), how }).collect()
}

/// None for what leaves a file as it is; our own reading is among that.
fn stir(kind: EventKind) -> Option<Stir> {
    match kind {
        EventKind::Access(AccessKind::Close(AccessMode::Write)) => Some(Stir::Whole),
        EventKind::Access(_) => None,
        EventKind::Modify(ModifyKind::Name(RenameMode::To)) => Some(Stir::Whole),
        EventKind::Modify(ModifyKind::Data(_)) if closing_is_told() => Some(Stir::Written),
        _ => Some(Stir::Touched),
    }
}

fn closing_is_told() -> bool {
    RecommendedWatcher::kind() == WatcherKind::Inotify
}
