//! Programs that are edited while they run, one file each in tests/corpus/edit: the first text, then at `--- at MS ---`
//! the whole next one, or at `--- at MS: OLD => NEW ---` the last one with a piece of it replaced. So for its other
//! files: `--- at MS FILE ---`, `--- at MS FILE: OLD => NEW ---`; `--- at MS FILE gone ---` removes one.

use std::collections::BTreeMap;

use crate::runs::compare;
use crate::shelf::split;
use crate::stage::{Event, Head, lines};

#[derive(Default)]
struct Case {
    first: String,
    /// The last text of each file; that of the program itself has no name.
    texts: BTreeMap<String, String>,
    saves: Vec<(f64, Event)>,
}

fn read(case: &str) -> Case {
    let mut read = Case::default();
    let mut parts: Vec<(&str, String)> = vec![("", String::new())];
    for line in case.split_inclusive('\n') {
        match line.trim_end().strip_prefix("--- at ").and_then(|rest| rest.strip_suffix("---")) {
            None => parts.last_mut().expect("the first").1.push_str(line),
            Some(head) => parts.push((head.trim(), String::new())),
        }
    }
    for (head, text) in parts {
        if head.is_empty() {
            let (own, files) = split(&text);
            read.texts = files.into_iter().chain([(String::new(), own)]).collect();
            read.first = text;
        } else {
            read.save(head, text);
        }
    }
    read
}

impl Case {
    fn save(&mut self, head: &str, whole: String) {
        let (place, edit) = head.split_once(": ").map_or((head.trim_end_matches(':'), None), |(a, b)| (a, Some(b)));
        let mut words = place.split_whitespace();
        let time = words.next().and_then(|time| time.parse().ok()).expect("a time in ms");
        let file = words.next().unwrap_or_default().to_string();
        if words.next() == Some("gone") {
            self.texts.remove(&file);
            return self.saves.push((time, Event::Write { file, text: None }));
        }
        let text = edit.map_or(whole, |edit| replaced(&self.texts[&file], edit.trim()));
        self.texts.insert(file.clone(), text.clone());
        let event = match file.is_empty() {
            true => Event::Save(text),
            false => Event::Write { file, text: Some(text) },
        };
        self.saves.push((time, event));
    }
}

fn replaced(text: &str, edit: &str) -> String {
    let (old, new) = edit.split_once("=>").expect("OLD => NEW");
    let (old, new) = (old.trim().replace("\\n", "\n"), new.trim().replace("\\n", "\n"));
    assert_eq!(text.matches(&old).count(), 1, "`{old}` stands once in the text");
    text.replace(&old, &new)
}

#[test]
fn programs_change_while_they_run() {
    compare("edit", |case| {
        let Case { first, saves, .. } = read(case);
        lines(&Head::read(case).play(&first, saves))
    });
}
