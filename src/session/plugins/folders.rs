//! Where plugins are looked for, and which lie there. A bridge of kind `ev3` is a library `liblrp_bridge_ev3.so`, or a
//! program `lrp-bridge-ev3` in any language, whatever its extension.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// In the order they are looked through; the first plugin of a kind counts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folders(Vec<PathBuf>);

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plugin {
    pub kind: String,
    pub path: PathBuf,
    pub form: PluginForm,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PluginForm {
    /// Loaded by a process of lrp's own.
    Library,
    Program,
}

const LIBRARY: &str = "liblrp_bridge_";
const PROGRAM: &str = "lrp-bridge-";

impl Folders {
    pub fn new(folders: Vec<PathBuf>) -> Folders {
        Folders(folders)
    }

    /// Those of this machine and user, for an lrp that lies at `binary`.
    pub fn here(chosen: &[PathBuf], binary: &Path) -> Folders {
        let mut folders = chosen.to_vec();
        folders.extend(env::var_os("LRP_BRIDGES").iter().flat_map(env::split_paths));
        if let Some(beside) = binary.parent() {
            // `deps` is where cargo puts what it builds; beside the binary there may be an older copy.
            folders.extend([beside.join("deps"), beside.to_path_buf(), beside.join("bridges")]);
            folders.extend(beside.parent().map(|prefix| prefix.join("lib/lrp/bridges")));
        }
        let home = || Some(PathBuf::from(env::var_os("HOME")?).join(".local/share"));
        let data = env::var_os("XDG_DATA_HOME").map(PathBuf::from).filter(|data| data.is_absolute()).or_else(home);
        folders.extend(data.map(|data| data.join("lrp/bridges")));
        folders.retain(|folder| !folder.as_os_str().is_empty());
        Folders(folders)
    }

    pub fn paths(&self) -> &[PathBuf] {
        &self.0
    }

    pub fn find(&self, kind: &str) -> Option<Plugin> {
        self.0.iter().find_map(|folder| plugins(folder).into_iter().find(|plugin| plugin.kind == kind))
    }

    /// One of each kind, by name.
    pub fn all(&self) -> Vec<Plugin> {
        let mut all: Vec<Plugin> = Vec::new();
        for plugin in self.0.iter().flat_map(|folder| plugins(folder)) {
            if all.iter().all(|known| known.kind != plugin.kind) {
                all.push(plugin);
            }
        }
        all.sort_by(|a, b| a.kind.cmp(&b.kind));
        all
    }
}

/// By name; a library before a program. A folder that isn't there has none.
fn plugins(folder: &Path) -> Vec<Plugin> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<Plugin> = entries.filter_map(|entry| plugin(entry.path())).collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn plugin(path: PathBuf) -> Option<Plugin> {
    let (stem, extension) = (path.file_stem()?.to_str()?, path.extension().and_then(OsStr::to_str));
    let (kind, form) = match (stem.strip_prefix(LIBRARY), stem.strip_prefix(PROGRAM)) {
        (Some(kind), _) if matches!(extension, Some("so" | "dylib")) => (kind.to_string(), PluginForm::Library),
        // Cargo's notes on what a program depends on lie beside it.
        (_, Some(kind)) if extension != Some("d") && is_executable(&path) => (kind.to_string(), PluginForm::Program),
        _ => return None,
    };
    // Cargo keeps copies with a hash in their names.
    is_kind(&kind).then_some(Plugin { kind, path, form })
}

/// As a program may write it.
fn is_kind(kind: &str) -> bool {
    kind.starts_with(|c: char| c.is_ascii_lowercase()) && kind.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

fn is_executable(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
}
