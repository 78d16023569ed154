//! Names and labels as they can be shown: cleaned, measured in columns, shortened. Knows nothing of what they name.

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
