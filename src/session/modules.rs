//! The Lua files that blocks may `require`: those under the program's folder.

use std::path::{Component, Path, PathBuf};

use super::engine_thread::Library;

/// `require "a.b"` reads `a/b.lua` under this folder, and nothing outside it; `read` hears of each file that was read, and what.
pub fn library(folder: PathBuf, read: impl Fn(&Path, &str) + Send + 'static) -> Library {
    Box::new(move |module| {
        let path = path(&folder, module)?;
        let text =
            std::fs::read_to_string(&path).map_err(|error| format!("{} can't be read: {error}", path.display()))?;
        read(&path, &text);
        Ok(text)
    })
}

/// Where the file of a module is, whether there is one or not; or why there can't be any.
pub fn path(folder: &Path, module: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(module.replace('.', "/")).with_extension("lua");
    if module.is_empty() || !file.components().all(|part| matches!(part, Component::Normal(_))) {
        return Err(format!("`{module}` does not name a Lua file under the program's folder"));
    }
    Ok(folder.join(file))
}

/// What a block calls the Lua file at a path.
pub fn name(folder: &Path, path: &Path) -> Option<String> {
    let file = path.strip_prefix(folder).ok()?;
    (file.extension()? == "lua").then(|| file.with_extension("").display().to_string().replace('/', "."))
}
