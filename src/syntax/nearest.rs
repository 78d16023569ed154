//! "Did you mean": the known word that is nearest to a mistyped one. Knows nothing of what the words name.

/// The known word fewest edits away, where an edit inserts, removes or replaces a character or swaps two neighbours.
/// None where even the nearest differs in more than a third of its characters (one edit is always allowed, but not for
/// a single letter, and of two letters only their order may differ); capitals don't count. Of equally near ones, the first.
pub fn nearest<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded: Vec<char> = fold(wanted);
    let mut best: Option<(usize, &str)> = None;
    for word in known {
        if word == wanted {
            continue;
        }
        let candidate = fold(word);
        let longer = folded.len().max(candidate.len());
        let limit = best.map_or(cut_off(longer), |(least, _)| cut_off(longer).min(least.saturating_sub(1)));
        if folded.len().abs_diff(candidate.len()) > limit || folded.len().min(candidate.len()) <= limit {
            continue;
        }
        if longer == 2 && !same_letters(&folded, &candidate) {
            continue;
        }
        let distance = distance(&folded, &candidate);
        if distance <= limit && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, word));
        }
    }
    best.map(|(_, word)| word)
}

/// Longer than any name worth guessing at; keeps the table small.
const LONGEST: usize = 64;

fn fold(word: &str) -> Vec<char> {
    word.chars().take(LONGEST).flat_map(char::to_lowercase).collect()
}

/// Of two pairs.
fn same_letters(a: &[char], b: &[char]) -> bool {
    a == b || a.iter().eq(b.iter().rev())
}

fn cut_off(length: usize) -> usize {
    (length / 3).max(1)
}

/// Optimal string alignment: the edits above, none of them touching the same place twice.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before_last = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    let mut row = vec![0; b.len() + 1];
    for i in 1..=a.len() {
        row[0] = i;
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before_last[j - 2] + 1);
            }
        }
        std::mem::swap(&mut before_last, &mut last);
        std::mem::swap(&mut last, &mut row);
    }
    last[b.len()]
}
