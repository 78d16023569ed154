//! How well what a person typed fits a name: its characters in their order, best at the beginnings of words.

/// What a word typed at the beginning of a word is worth.
const START: i32 = 10;
/// What follows the character before without a gap.
const NEXT: i32 = 8;
const FOUND: i32 = 2;
const WHOLE: i32 = 30;

/// None where it doesn't fit; every word typed has to. More is better.
pub fn fit(typed: &str, text: &str) -> Option<i32> {
    let text = folded(text);
    let words: Vec<Vec<char>> = typed.split_whitespace().map(folded).collect();
    words.iter().map(|word| fit_word(word, &text)).sum()
}

/// Whether each word typed begins a word of the text, for sentences, in which few characters fit by chance.
pub fn begins_words(typed: &str, text: &str) -> bool {
    let text = text.to_lowercase();
    let mut words = typed.split_whitespace().map(str::to_lowercase);
    words.all(|word| text.split(|c: char| !c.is_alphanumeric()).any(|other| other.starts_with(&*word)))
}

fn folded(text: &str) -> Vec<char> {
    text.to_lowercase().chars().collect()
}

fn fit_word(word: &[char], text: &[char]) -> Option<i32> {
    // The best way to end at each place of the text, for one character of the word after the other.
    let mut before: Vec<Option<i32>> = Vec::new();
    for (i, c) in word.iter().enumerate() {
        let mut apart = None;
        let ways = text.iter().enumerate().map(|(at, other)| {
            let adjacent = at.checked_sub(1).and_then(|at| *before.get(at)?);
            let worth = FOUND + if begins(text, at) { START } else { 0 };
            let way = if i == 0 { Some(-(at as i32).min(START)) } else { apart.max(adjacent.map(|sum| sum + NEXT)) };
            apart = apart.max(adjacent).map(|sum| sum - 1);
            way.filter(|_| c == other).map(|sum| sum + worth)
        });
        before = ways.collect();
    }
    let best = before.into_iter().flatten().max()?;
    Some(if word.len() == text.len() { best + WHOLE } else { best })
}

fn begins(text: &[char], at: usize) -> bool {
    at.checked_sub(1).is_none_or(|before| !text[before].is_alphanumeric())
}
