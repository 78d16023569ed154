//! The behaviours in a folder and below, each with what its first comment says of it. Bounded, so that it is quick wherever
//! it is asked; knows nothing of what is chosen.

use std::collections::VecDeque;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How far is looked.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Folders within folders.
    pub depth: usize,
    /// Names that are looked at, of files and folders of all kinds.
    pub names: usize,
    /// Behaviours that are told.
    pub behaviours: usize,
    pub time: Duration,
}

pub const BOUNDS: Bounds = Bounds { depth: 5, names: 50_000, behaviours: 500, time: Duration::from_secs(2) };

/// Of a file so much is read for its comment.
const HEAD: u64 = 2048;

/// Folders of others' making, in which nobody keeps behaviours.
const PASSED_OVER: [&str; 2] = ["target", "node_modules"];

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Behaviour {
    /// From the folder on.
    pub file: PathBuf,
    /// Its first comment line; empty where there is none.
    pub about: String,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Those of the folder itself first, each folder's by name.
    pub all: Vec<Behaviour>,
    /// Whether the bounds were reached before the end.
    pub cut: bool,
    /// Why the folder itself can't be read.
    pub trouble: Option<String>,
}

/// Links to folders are not followed; folders that can't be read are passed over.
pub fn find(folder: &Path, bounds: Bounds) -> Found {
    let begun = Instant::now();
    let mut found = Found::default();
    let mut names = 0;
    let mut folders = VecDeque::from([(PathBuf::new(), 0)]);
    while let Some((inner, depth)) = folders.pop_front() {
        let entries = match fs::read_dir(folder.join(&inner)) {
            Ok(entries) => entries,
            Err(error) if depth == 0 => {
                found.trouble = Some(why(&error));
                break;
            }
            Err(_) => continue,
        };
        let mut files = Vec::new();
        let mut inside = Vec::new();
        for entry in entries.flatten() {
            names += 1;
            if names > bounds.names || begun.elapsed() > bounds.time {
                found.cut = true;
                break;
            }
            let name = entry.file_name();
            let path = inner.join(&name);
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                if !is_passed_over(&name) {
                    inside.push(path);
                }
            } else if path.extension().is_some_and(|ending| ending == "lrp") {
                files.push(path);
            }
        }
        files.sort_unstable();
        for file in files {
            if found.all.len() == bounds.behaviours {
                found.cut = true;
                break;
            }
            found.all.extend(behaviour(folder, file));
        }
        if found.cut {
            break;
        }
        inside.sort_unstable();
        match depth < bounds.depth {
            true => folders.extend(inside.into_iter().map(|path| (path, depth + 1))),
            false => found.cut |= !inside.is_empty(),
        }
    }
    found
}

fn is_passed_over(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    name.starts_with('.') || PASSED_OVER.contains(&&*name)
}

/// None for pipes and the like, which would be waited for. One that may not be read is one all the same.
fn behaviour(folder: &Path, file: PathBuf) -> Option<Behaviour> {
    let path = folder.join(&file);
    path.metadata().ok().filter(fs::Metadata::is_file)?;
    let mut head = Vec::new();
    let read = File::open(path).and_then(|open| open.take(HEAD).read_to_end(&mut head));
    let about = match read {
        Ok(_) => first_comment(&String::from_utf8_lossy(&head)),
        Err(error) => why(&error),
    };
    Some(Behaviour { file, about })
}

/// The first line of the text that is a comment and says anything.
pub fn first_comment(text: &str) -> String {
    let comments = text.lines().filter_map(|line| line.trim_start().strip_prefix(';'));
    let mut said = comments.map(|line| line.trim_start_matches(';').trim());
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    said.find(|line| line.chars().any(char::is_alphanumeric)).unwrap_or_default().chars().map(plain).collect()
}

fn why(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::PermissionDenied => "may not be read".into(),
        io::ErrorKind::NotFound => "is gone".into(),
        _ => format!("can't be read: {error}"),
    }
}
