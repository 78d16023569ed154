//! The Lua files that blocks may `require`: those under the program's folder.

use std::path::{Component, Path, PathBuf};

use super::engine_thread::Library;

/// `require "a.b"` reads `a/b.lua` under this folder, and nothing outside it.
pub fn library(folder: PathBuf) -> Library {
    Box::new(move |module| {
        let file = PathBuf::from(module.replace('.', "/")).with_extension("lua");
        if module.is_empty() || !file.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(format!("`{module}` does not name a Lua file under the program's folder"));
        }
        read(&folder.join(file))
    })
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{} can't be read: {error}", path.display()))
}
