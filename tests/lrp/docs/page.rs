//! The fences of the documents. Knows nothing of what is in them.

use std::path::{Path, PathBuf};

pub struct Example {
    /// `language.md:12`
    pub place: String,
    pub kind: Kind,
    pub text: String,
    /// What it may import: the files shown before it on its page, by name.
    pub files: Vec<(String, String)>,
    /// Lines of its trace that say what happens to the program: an input, a command, a save.
    pub fed: Vec<String>,
    /// Lines of its trace that say what it does.
    pub trace: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Sound,
    Broken,
    Faulty,
}

pub struct Fence {
    pub place: String,
    pub info: String,
    pub text: String,
}

/// README.md and all of docs/.
pub fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = std::fs::read_dir(root.join("docs"))
        .expect("there are documents")
        .map(|entry| entry.expect("it can be listed").path());
    let mut pages: Vec<PathBuf> = docs.filter(|path| path.extension().is_some_and(|end| end == "md")).collect();
    pages.sort();
    pages.push(root.join("README.md"));
    pages
}

pub fn fences(page: &Path) -> Vec<Fence> {
    let text = std::fs::read_to_string(page).unwrap_or_else(|why| panic!("{}: {why}", page.display()));
    let name = page.file_name().unwrap_or_default().to_string_lossy();
    let mut fences: Vec<Fence> = Vec::new();
    let mut open = None;
    for (index, line) in text.lines().enumerate() {
        match (line.strip_prefix("```"), open.take()) {
            (Some(info), None) => {
                open = Some(Fence {
                    place: format!("{name}:{}", index + 1),
                    info: info.trim().to_string(),
                    text: String::new(),
                });
            }
            (Some(_), Some(fence)) => fences.push(fence),
            (None, Some(mut fence)) => {
                fence.text += line;
                fence.text += "\n";
                open = Some(fence);
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "{name}: a fence is not closed");
    fences
}

pub fn examples() -> Vec<Example> {
    let mut examples: Vec<Example> = Vec::new();
    for page in pages() {
        // A trace belongs to the program right before it.
        let mut follows = false;
        let mut files: Vec<(String, String)> = Vec::new();
        for fence in fences(&page) {
            if let Some(name) = fence.info.strip_prefix("lrp file ") {
                files.push((name.to_string(), fence.text));
                follows = false;
                continue;
            }
            let kind = match fence.info.as_str() {
                "lrp" => Some(Kind::Sound),
                "lrp broken" => Some(Kind::Broken),
                "lrp faulty" => Some(Kind::Faulty),
                // In docs/codes.md, with a test of their own.
                "lrp wrong" => {
                    follows = false;
                    continue;
                }
                "trace" => None,
                info => {
                    assert!(!info.starts_with("lrp"), "{}: no such fence: {info}", fence.place);
                    follows = false;
                    continue;
                }
            };
            match kind {
                Some(kind) => examples.push(Example {
                    place: fence.place,
                    kind,
                    text: fence.text,
                    files: files.clone(),
                    fed: Vec::new(),
                    trace: Vec::new(),
                }),
                None => {
                    let example = examples.last_mut().filter(|_| follows);
                    let example =
                        example.unwrap_or_else(|| panic!("{}: a trace without a program before it", fence.place));
                    let lines = fence.text.lines().map(str::to_string);
                    (example.fed, example.trace) = lines.partition(|line| is_fed(line));
                }
            }
            follows = kind.is_some();
        }
    }
    examples
}

fn is_fed(line: &str) -> bool {
    matches!(line.split(' ').nth(1), Some("input" | "command" | "save"))
}
