//! Reads what lines that don't turn say: their labels, and whether they lead right or left. Knows nothing of boxes.

use super::page::Script;

/// The label of a line to the right, its head included, that begins with so many cells of line.
pub fn to_the_right(line: &str, before: usize, script: &Script) -> Option<String> {
    let line = line.strip_suffix(|c| script.heads[1].contains(c))?;
    script.across.iter().find_map(|style| {
        let rest = line.strip_prefix(style).or_else(|| line.strip_prefix(script.exit))?;
        let rest = rest.strip_prefix(&*style.repeat(before - 1))?;
        bare(rest.strip_suffix(style)?.trim_end_matches(style), script)
    })
}

/// The label of a line to the left, its head included.
pub fn to_the_left(line: &str, script: &Script) -> Option<String> {
    let line = line.strip_prefix(|c| script.heads[0].contains(c))?;
    script.across.iter().find_map(|style| {
        let rest = line.strip_suffix(style).or_else(|| line.strip_suffix(script.exit))?;
        bare(rest.strip_prefix(style)?.trim_end_matches(style), script)
    })
}

/// A label without the blanks that part it from its line.
fn bare(text: &str, script: &Script) -> Option<String> {
    let label = match (script.padded, text) {
        (false, text) | (true, text @ "") => text,
        (true, text) => text.strip_prefix(' ')?.strip_suffix(' ')?,
    };
    (label.trim_matches(' ') == label && !label.contains("  ")).then(|| label.to_owned())
}
