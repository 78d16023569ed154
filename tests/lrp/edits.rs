//! Programs that are edited while they run, one file each in tests/corpus/edit: the first text, then at `--- at MS ---`
//! the whole next one, or at `--- at MS: OLD => NEW ---` the last one with a piece of it replaced.

use crate::runs::compare;
use crate::stage::{Head, lines};

struct Texts {
    first: String,
    saves: Vec<(f64, String)>,
}

fn read(case: &str) -> Texts {
    let mut texts = Texts { first: String::new(), saves: Vec::new() };
    for line in case.split_inclusive('\n') {
        let head = line.trim_end().strip_prefix("--- at ").and_then(|rest| rest.strip_suffix("---"));
        let last = texts.saves.last_mut().map_or(&mut texts.first, |(_, text)| text);
        match head {
            None => last.push_str(line),
            Some(head) => {
                let next = head.split_once(": ").map(|(_, edit)| replaced(last, edit.trim()));
                let time = head.split_once(':').map_or(head, |(time, _)| time).trim();
                texts.saves.push((time.parse().expect("a time in ms"), next.unwrap_or_default()));
            }
        }
    }
    texts
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
        let Texts { first, saves } = read(case);
        lines(&Head::read(case).play(&first, saves))
    });
}
