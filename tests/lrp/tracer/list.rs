//! Reads the lists that stand for drawings too wide: boxes with their edges below them as lines of text. Knows nothing of
//! lines that lead anywhere.

use super::Seen;
use super::page::{Page, Script};

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
                let state = state_of(&item, &page.script)?;
                if state.0.is_empty() || seen.states.iter().any(|(name, _)| *name == state.0) {
                    return Err(format!("a box with no name, or another's: {item:?}"));
                }
                seen.states.push(state);
            }
        }
    }
    if let Some((_, to, _)) = seen.edges.iter().find(|(_, to, _)| seen.states.iter().all(|(name, _)| name != to)) {
        return Err(format!("no box is {to:?}"));
    }
    seen.edges.sort();
    Ok(seen)
}

/// The lines, with those appended that go on further in.
fn items(page: &Page) -> Result<Vec<String>, String> {
    super::legend::unbroken((0..page.cells.len()).map(|y| page.cells[y].concat()))
}

fn state_of(item: &str, script: &Script) -> Result<(String, bool), String> {
    let [left, right] = script.borders;
    let inside = item.strip_prefix(left).and_then(|rest| rest.strip_suffix(right));
    let inside = inside.and_then(|text| text.strip_prefix(' ')?.strip_suffix(' '));
    let text = inside.ok_or_else(|| format!("neither a box nor an edge: {item:?}"))?;
    let bare = text.strip_suffix(script.nested);
    Ok((bare.unwrap_or(text).to_owned(), bare.is_some()))
}

/// The target and the label.
fn edge_of(edge: &str, script: &Script) -> Result<(String, String), String> {
    let wrong = || format!("not an edge: {edge:?}");
    let (line, target) = edge.rsplit_once(' ').ok_or_else(wrong)?;
    let line = line.strip_suffix(|c| script.heads[1].contains(c)).ok_or_else(wrong)?;
    let style = script.across.iter().find(|style| line.ends_with(**style)).ok_or_else(wrong)?;
    let line = &line[..line.len() - style.len()];
    let label = line.strip_prefix(style).or_else(|| line.strip_prefix(script.exit)).ok_or_else(wrong)?;
    let label = match (script.padded, label) {
        (false, label) | (true, label @ "") => Some(label),
        (true, label) => label.strip_prefix(' ').and_then(|label| label.strip_suffix(' ')),
    };
    let label = label.filter(|label| label.trim_matches(' ') == *label).ok_or_else(wrong)?;
    Ok((target.to_owned(), label.to_owned()))
}
