//! Names and labels as they can be shown: cleaned, measured in columns, shortened. Knows nothing of what they name.

use std::collections::BTreeMap;
use std::ops::Range;

use unicode_segmentation::UnicodeSegmentation;
use unicode_width::UnicodeWidthStr;

use super::glyphs::Glyphs;

/// `text` on one line, without anything that would move the cursor, merge with the glyph next to it or pass for a line.
pub fn clean(text: &str, glyphs: Glyphs) -> String {
    let mut out = String::with_capacity(text.len());
    for cluster in text.graphemes(true) {
        if cluster.chars().any(|c| c.is_whitespace() || c.is_control()) {
            if !out.is_empty() && !out.ends_with(' ') {
                out.push(' ');
            }
        } else if cluster.chars().any(|c| glyphs.draws(c)) {
            out.push('·');
        } else if cluster.width() > 0 && stands_alone(cluster) {
            out.push_str(cluster);
        }
    }
    out.truncate(out.trim_end().len());
    out
}

/// Whether a neighbour on either side stays a cluster of its own.
fn stands_alone(cluster: &str) -> bool {
    cluster.is_ascii() || format!("-{cluster}-").graphemes(true).count() == 3
}

/// Its clusters with their widths in columns.
pub fn clusters(text: &str) -> impl Iterator<Item = (&str, usize)> {
    text.graphemes(true).map(|cluster| (cluster, cluster.width()))
}

/// Width in columns.
pub fn width(text: &str) -> usize {
    clusters(text).map(|(_, width)| width).sum()
}

/// `text` in at most `room` columns; what is left out shows as an ellipsis. Nothing fits into no room.
pub fn shorten(text: &str, room: usize, glyphs: Glyphs) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    if room == 0 {
        return String::new();
    }
    let mut left = room - 1;
    let mut out = String::new();
    for (cluster, width) in clusters(text) {
        if width > left {
            break;
        }
        left -= width;
        out.push_str(cluster);
    }
    out.truncate(out.trim_end().len());
    out.push(glyphs.ellipsis());
    out
}

/// Each text in at most its room, what is left out as an ellipsis, numbered where else two texts would show the same;
/// `None` if a room is too small for that.
pub fn distinct(texts: &[(&str, usize)], glyphs: Glyphs) -> Option<Vec<String>> {
    let whole = texts.iter().filter(|(text, room)| width(text) <= *room);
    let mut meant: BTreeMap<String, &str> = whole.map(|&(text, _)| (text.to_owned(), text)).collect();
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let mut shown: BTreeMap<(&str, usize), String> = BTreeMap::new();
    for &(text, room) in texts {
        if width(text) <= room || shown.contains_key(&(text, room)) {
            continue;
        }
        let number = numbers.entry(shorten(text, room, glyphs)).or_insert(0);
        let free = loop {
            *number += 1;
            let short = numbered(text, room, *number, glyphs)?;
            if *meant.entry(short.clone()).or_insert(text) == text {
                break short;
            }
        };
        shown.insert((text, room), free);
    }
    let shown = |it: &(&str, usize)| shown.get(it).map_or_else(|| it.0.to_owned(), String::clone);
    Some(texts.iter().map(shown).collect())
}

/// `text` shortened and with a number from 2 on.
fn numbered(text: &str, room: usize, number: usize, glyphs: Glyphs) -> Option<String> {
    let digits = if number > 1 { number.to_string() } else { String::new() };
    let room = room.checked_sub(digits.len()).filter(|room| *room > 0)?;
    Some(shorten(text, room, glyphs) + &digits)
}

/// Where to break a text into rows, the first and the others with so much room in columns: before a blank where that
/// leaves the row half full, else anywhere. No row but the last ends with a blank, which nobody would see.
pub fn broken(clusters: &[(&str, usize)], [first, others]: [usize; 2]) -> Vec<Range<usize>> {
    let is_blank = |i: usize| clusters[i].0 == " ";
    let mut rows = Vec::new();
    let (mut start, mut room) = (0, first);
    while start < clusters.len() {
        let mut used = 0;
        let fit = clusters[start..].iter().take_while(|(_, width)| {
            used += width;
            used <= room
        });
        let mut end = start + fit.count().max(1);
        if end < clusters.len() {
            let half = start + (end - start) / 2;
            let gap = (half.max(start + 1)..=end).rev().find(|&i| is_blank(i) && !is_blank(i - 1));
            end = gap.unwrap_or(end);
        }
        rows.push(start..end);
        (start, room) = (end, others);
    }
    rows
}
