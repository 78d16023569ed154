//! Finds the test files that paths stand for. Reads folders, never files.

use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

const ENDING: &str = "_test.lua";

/// Why there is nothing to run, as one line.
#[derive(Debug, PartialEq, Eq)]
pub enum NoTests {
    Missing(PathBuf),
    /// A file that is no test, such as a program.
    NotATest(PathBuf),
    /// No test file in any of these.
    Found {
        nowhere: Vec<PathBuf>,
    },
}

impl fmt::Display for NoTests {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            NoTests::Missing(path) => write!(f, "{}: no such file or folder", path.display()),
            NoTests::NotATest(path) => {
                write!(f, "{}: not a test; tests are Lua files, called `*{ENDING}`", path.display())
            }
            NoTests::Found { nowhere } => {
                let places: Vec<String> = nowhere.iter().map(|path| path.display().to_string()).collect();
                write!(f, "no tests found: there is no `*{ENDING}` in {}", places.join(", "))
            }
        }
    }
}

/// A file as it is named; of a folder all `*_test.lua` below it, sorted, but for those in hidden folders and in `target`.
/// No paths: the current folder.
pub fn test_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, NoTests> {
    let here = [PathBuf::from(".")];
    let paths = if paths.is_empty() { &here } else { paths };
    let mut files = Vec::new();
    for path in paths {
        match path {
            path if path.is_dir() => gather(path, &mut files),
            path if path.is_file() && path.extension() == Some(OsStr::new("lua")) => files.push(path.clone()),
            path if path.is_file() => return Err(NoTests::NotATest(path.clone())),
            path => return Err(NoTests::Missing(path.clone())),
        }
    }
    let mut seen = std::collections::HashSet::new();
    files.retain(|file| seen.insert(file.clone()));
    match files.is_empty() {
        true => Err(NoTests::Found { nowhere: paths.to_vec() }),
        false => Ok(files),
    }
}

fn gather(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = folder.read_dir() else { return };
    let mut names: Vec<String> = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    for name in names {
        let path = if folder == Path::new(".") { PathBuf::from(&name) } else { folder.join(&name) };
        // A link to a folder could lead back up.
        if path.is_dir() && !path.is_symlink() && !name.starts_with('.') && name != "target" {
            gather(&path, files);
        } else if path.is_file() && name.ends_with(ENDING) {
            files.push(path);
        }
    }
}
