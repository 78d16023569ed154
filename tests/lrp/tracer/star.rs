//! Reads what is around a state: its box on the left, and lines between it and the boxes of others, one a row. Knows nothing
//! of lines that turn.

use super::arrows::{to_the_left, to_the_right};
use super::page::Page;
use super::{Seen, named};

/// The states come with the one in the middle first, then by name.
pub fn trace(page: &Page) -> Result<Seen, String> {
    let [left, right] = page.script.borders;
    let mut hubs: Vec<(String, bool)> = Vec::new();
    let mut others: Vec<(String, bool)> = Vec::new();
    let mut edges = Vec::new();
    let (mut is_new, mut widths) = (true, Vec::new());
    for row in page.cells.iter().map(|row| row.concat()) {
        let row = row.trim_end_matches(' ');
        if row.is_empty() {
            is_new = true;
            continue;
        }
        let wrong = |what: &str| format!("{what}: {row:?}");
        let parts = row.strip_prefix(left).and_then(|rest| rest.split_once(right));
        let (text, beside) = parts.ok_or_else(|| wrong("no box at the left"))?;
        if !(text.starts_with(' ') && text.ends_with(' ')) {
            return Err(wrong("something touches the border"));
        }
        match (text.trim_matches(' '), is_new) {
            ("", true) => return Err(wrong("a box without a name")),
            ("", false) => {}
            (name, true) => hubs.push(named(name, &page.script)),
            (_, false) => return Err(wrong("a second name in a box")),
        }
        if beside.is_empty() && is_new && hubs.len() > 1 {
            return Err(wrong("a second box with nothing beside it"));
        }
        is_new = false;
        let hub = hubs.last().map(|(name, _)| name.clone()).unwrap_or_default();
        let mut width = vec![super::columns(text)];
        if !beside.is_empty() {
            let parts = beside.strip_suffix(right).and_then(|rest| rest.rsplit_once(left));
            let (line, text) = parts.ok_or_else(|| wrong("no box at the right"))?;
            let name = text.strip_prefix(' ').and_then(|text| text.strip_suffix(' '));
            let other =
                named(name.ok_or_else(|| wrong("something touches the border"))?.trim_matches(' '), &page.script);
            edges.push(match (to_the_right(line, 2, &page.script), to_the_left(line, &page.script)) {
                (Some(label), None) => (hub, other.0.clone(), label),
                (None, Some(label)) => (other.0.clone(), hub, label),
                _ => return Err(wrong("no line, or one with two heads")),
            });
            others.push(other);
            width.extend([super::columns(line), super::columns(text)]);
        }
        widths.push(width);
    }
    let all = |at: usize| widths.iter().filter_map(move |width| width.get(at));
    if (0..3).any(|at| all(at).any(|width| all(at).next() != Some(width))) {
        return Err("borders that don't stand below each other".to_owned());
    }
    edges.sort();
    Ok(Seen { states: once(hubs, others)?, edges })
}

/// A state may be shown several times, always with the same mark.
fn once(hubs: Vec<(String, bool)>, others: Vec<(String, bool)>) -> Result<Vec<(String, bool)>, String> {
    let mut hubs = hubs.into_iter();
    let first = hubs.next().ok_or("nothing is in the middle")?;
    let mut rest: Vec<_> = hubs.chain(others).filter(|state| *state != first).collect();
    rest.sort();
    rest.dedup();
    let states: Vec<_> = std::iter::once(first).chain(rest).collect();
    let twice =
        (1..states.len()).find(|&i| states[i].0.is_empty() || states[..i].iter().any(|other| other.0 == states[i].0));
    twice.map_or_else(|| Ok(states.clone()), |i| Err(format!("{:?} with and without a mark", states[i].0)))
}
