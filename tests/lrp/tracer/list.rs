//! Reads the lists that stand for drawings too wide: boxes with their edges below them as lines of text. Knows nothing of
//! lines that lead anywhere.

use super::arrows::to_the_right;
use super::page::{Page, Script};
use super::{Seen, known_targets, named};

pub fn trace(page: &Page) -> Result<Seen, String> {
    let mut seen = Seen { states: Vec::new(), edges: Vec::new() };
    for item in items(page)? {
        match item.strip_prefix("  ") {
            Some(edge) => {
                let (from, _) = seen.states.last().ok_or("an edge without a box")?.clone();
                let (to, label) = edge_of(edge, &page.script)?;
                seen.edges.push((from, to, label));
            }
            None => {
                seen.states.push(state_of(&item, &page.script)?);
            }
        }
    }
    seen.edges.sort();
    known_targets(seen)
}

/// The lines, with those appended that go on further in.
fn items(page: &Page) -> Result<Vec<String>, String> {
    super::legend::unbroken((0..page.cells.len()).map(|y| page.cells[y].concat()))
}

fn state_of(item: &str, script: &Script) -> Result<(String, bool), String> {
    let [left, right] = script.borders;
    let inside = item.strip_prefix(left).and_then(|rest| rest.strip_suffix(right));
    let inside = inside.and_then(|text| text.strip_prefix(' ')?.strip_suffix(' '));
    let inside = inside
        .filter(|text| text.trim_matches(' ') == *text && !script.borders.iter().any(|border| text.contains(border)));
    let text = inside.ok_or_else(|| format!("neither a box nor an edge: {item:?}"))?;
    Ok(named(text, script))
}

/// The target and the label.
fn edge_of(edge: &str, script: &Script) -> Result<(String, String), String> {
    let parts = edge.rsplit_once(' ').and_then(|(line, target)| Some((target, to_the_right(line, 1, script)?)));
    let (target, label) = parts.ok_or_else(|| format!("not an edge: {edge:?}"))?;
    Ok((target.to_owned(), label))
}
