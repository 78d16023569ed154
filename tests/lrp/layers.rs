//! The house rules that a compiler doesn't check, read from the sources: each layer uses only those before it, nothing
//! below the session prints, each file says what it is and stays short.

use std::fs;
use std::path::{Path, PathBuf};

const LAYERS: [&str; 7] = ["syntax", "lua", "model", "runtime", "session", "ui", "cli"];
const LONGEST: usize = 450;

struct File {
    /// From the package's folder.
    path: PathBuf,
    text: String,
}

fn files(folder: &str) -> Vec<File> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let mut folders = vec![root.join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|it| it == "rs") {
                let text = fs::read_to_string(&path).expect("a source");
                found.push(File { path: path.strip_prefix(root).expect("inside").into(), text });
            }
        }
    }
    assert!(found.len() > 5, "{folder} has sources");
    found
}

impl File {
    fn layer(&self) -> Option<usize> {
        let path = self.path.strip_prefix("src").ok()?;
        let top = path.iter().next()?.to_str()?;
        LAYERS.iter().position(|&layer| layer == top.trim_end_matches(".rs"))
    }

    /// Its lines of code, numbered from 1, without comments.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines = self.text.lines().enumerate().map(|(i, line)| (i + 1, line));
        lines.map(|(i, line)| (i, line.split("//").next().unwrap_or(line)))
    }

    /// The layers that it names: `crate::model`, also in `use crate::{model, lua}`.
    fn used(&self) -> Vec<(usize, usize)> {
        let mut used = Vec::new();
        for (number, line) in self.code() {
            for (at, _) in line.match_indices("crate::") {
                let rest = &line[at + "crate::".len()..];
                let names =
                    rest.strip_prefix('{').map_or_else(|| vec![head(rest)], |list| list.split(',').map(head).collect());
                let layers = names.into_iter().filter_map(|name| LAYERS.iter().position(|&layer| layer == name));
                used.extend(layers.map(|layer| (number, layer)));
            }
        }
        used
    }
}

fn head(path: &str) -> &str {
    let path = path.trim_start();
    path.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(path)
}

fn none(broken: Vec<String>) {
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn a_layer_uses_only_those_before_it() {
    let mut broken = Vec::new();
    let mut seen = 0;
    for file in files("src") {
        let Some(layer) = file.layer() else { continue };
        let used = file.used();
        seen += used.len();
        let later = used.into_iter().filter(|&(_, used)| used > layer);
        let path = file.path.display().to_string();
        broken.extend(later.map(|(line, used)| format!("{path}:{line}: {} uses {}", LAYERS[layer], LAYERS[used])));
    }
    assert!(seen > 100, "uses are found");
    none(broken);
}

#[test]
fn nothing_below_the_session_prints() {
    let session = LAYERS.iter().position(|&layer| layer == "session");
    let mut broken = Vec::new();
    for file in files("src").into_iter().filter(|file| file.layer() < session && file.layer().is_some()) {
        for (number, line) in file.code() {
            let prints = ["print!(", "println!(", "eprint!(", "eprintln!(", "dbg!(", "io::stdout", "io::stderr"];
            if prints.iter().any(|print| line.contains(print)) {
                broken.push(format!("{}:{number}: {}", file.path.display(), line.trim()));
            }
        }
    }
    none(broken);
}

#[test]
fn every_file_says_what_it_is() {
    let files = files("src").into_iter().chain(files("tests/lrp"));
    let silent = files.filter(|file| !file.text.starts_with("//! "));
    none(silent.map(|file| format!("{}: begins without `//!`", file.path.display())).collect());
}

#[test]
fn no_file_is_long() {
    let long = files("src").into_iter().filter(|file| file.text.lines().count() > LONGEST);
    none(long.map(|file| format!("{}: {} lines", file.path.display(), file.text.lines().count())).collect());
}

/// Lines of the screen's code outside of files and folders for which `breaks` holds.
fn on_the_screen(outside: &[&str], breaks: impl Fn(&str) -> bool) -> Vec<String> {
    let files = files("src/ui").into_iter().filter(|file| !outside.iter().any(|own| file.path.starts_with(own)));
    let lines = files.flat_map(|file| {
        let broken: Vec<String> = file
            .code()
            .filter(|(_, line)| breaks(line))
            .map(|(number, line)| format!("{}:{number}: {}", file.path.display(), line.trim()))
            .collect();
        broken
    });
    lines.collect()
}

#[test]
fn colours_are_named_in_one_place() {
    none(on_the_screen(&["src/ui/theme.rs", "src/ui/encoder.rs"], |line| {
        line.contains("Color::") || line.contains("style::Color")
    }));
}

#[test]
fn every_character_of_the_screen_is_in_a_table() {
    none(on_the_screen(&["src/ui/glyphs.rs", "src/ui/graph"], |line| !line.is_ascii()));
}
