//! Sentences that name keys: `{pause}` is the key of the action of that name, as it is configured; what stands in back
//! quotes is as in a program. Broken into lines by words.

use super::format;
use super::keymap::Keymap;

/// What stands between two spaces.
pub type Word = Vec<Piece>;

/// A piece of a word, with what it is.
pub type Piece = (Tone, String);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    Text,
    Key,
    /// As in a program.
    Code,
}

/// `names`: what other names in braces stand for.
pub fn words(text: &str, keys: &Keymap, names: &[(&str, &str)]) -> Vec<Word> {
    let mut words = vec![Word::new()];
    let mut tone = Tone::Text;
    let mut rest = text;
    while let Some(at) = rest.find(['{', '`', ' ']) {
        add(&mut words, tone, &rest[..at]);
        let after = &rest[at + 1..];
        rest = match rest.as_bytes()[at] {
            b'`' => {
                tone = if tone == Tone::Code { Tone::Text } else { Tone::Code };
                after
            }
            b' ' => {
                words.push(Word::new());
                after
            }
            _ => {
                let (name, after) = after.split_once('}').unwrap_or((after, ""));
                match names.iter().find(|(known, _)| *known == name) {
                    Some((_, text)) => add(&mut words, Tone::Code, text),
                    None => add(&mut words, Tone::Key, &keys.named(name)),
                }
                after
            }
        };
    }
    add(&mut words, tone, rest);
    words
}

fn add(words: &mut [Word], tone: Tone, text: &str) {
    if let Some(word) = words.last_mut().filter(|_| !text.is_empty()) {
        word.push((tone, text.to_string()));
    }
}

/// The same without colours, spaces and lines as they are.
pub fn plain(text: &str, keys: &Keymap) -> String {
    let join = |word: Word| word.into_iter().map(|(_, text)| text).collect::<String>();
    words(text, keys, &[]).into_iter().map(join).collect::<Vec<_>>().join(" ")
}

/// As many words in each line as fit; the first line begins after `indent` columns.
pub fn lines(words: &[Word], columns: u16, indent: u16) -> Vec<Vec<Word>> {
    let mut lines: Vec<Vec<Word>> = vec![Vec::new()];
    let mut used = indent;
    for word in words {
        let wanted = width(word) + u16::from(lines.last().is_some_and(|line| !line.is_empty()));
        match lines.last_mut() {
            Some(line) if line.is_empty() || used + wanted <= columns => {
                line.push(word.clone());
                used += wanted;
            }
            _ => {
                used = width(word);
                lines.push(vec![word.clone()]);
            }
        }
    }
    lines
}

pub fn width(word: &Word) -> u16 {
    word.iter().map(|(_, text)| format::width(text)).sum()
}
