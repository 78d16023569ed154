//! Reads tables: boxes right below each other, each with arrows to the names of other states beside it, perhaps in several
//! columns. Knows nothing of lines that turn.

use super::arrows::to_the_right;
use super::page::{Page, Script};
use super::{Seen, known_targets};

pub fn trace(page: &Page) -> Result<Seen, String> {
    let starts = starts(page);
    let mut seen = Seen { states: Vec::new(), edges: Vec::new() };
    if starts.first() != Some(&0) {
        return Err("no box in the corner".to_owned());
    }
    for (i, &start) in starts.iter().enumerate() {
        let end = starts.get(i + 1).copied().unwrap_or(usize::MAX);
        column(page, start, end, &mut seen)?;
    }
    seen.edges.sort();
    known_targets(seen)
}

/// Where columns of boxes begin: at borders of the first row that stand alone.
fn starts(page: &Page) -> Vec<usize> {
    let alone = |x: usize| x == 0 || (x > 2 && (1..=3).all(|before| page.at((x - before, 0)) == " "));
    let first = page.cells.first().map_or(0, Vec::len);
    (0..first).filter(|&x| page.at((x, 0)) == page.script.borders[0] && alone(x)).collect()
}

fn column(page: &Page, start: usize, end: usize, seen: &mut Seen) -> Result<(), String> {
    let row = |y: usize| page.text(y, start..end.min(page.cells[y].len().max(start)));
    let rows: Vec<String> = (0..page.cells.len()).map(row).collect();
    let used = rows.iter().position(|row| row.trim_end_matches(' ').is_empty()).unwrap_or(rows.len());
    if let Some(late) = rows[used..].iter().find(|row| !row.trim_end_matches(' ').is_empty()) {
        return Err(format!("{late:?} below the end of its column"));
    }
    let mut width = None;
    for row in &rows[..used] {
        let (text, arrows) = boxed(row, &page.script)?;
        if *width.get_or_insert(super::columns(text)) != super::columns(text) {
            return Err(format!("a box of another width in {row:?}"));
        }
        match text.trim_matches(' ') {
            "" if seen.states.is_empty() => return Err("a box without a name".to_owned()),
            "" => {}
            name => seen.states.push(super::named(name, &page.script)),
        }
        let from = seen.states.last().map(|(name, _)| name.clone()).unwrap_or_default();
        for arrow in arrows.split("  ").map(|arrow| arrow.trim_matches(' ')).filter(|arrow| !arrow.is_empty()) {
            let (line, target) = arrow.rsplit_once(' ').ok_or_else(|| format!("no arrow: {arrow:?}"))?;
            let label = to_the_right(line, 1, &page.script).ok_or_else(|| format!("no arrow: {arrow:?}"))?;
            seen.edges.push((from.clone(), target.to_owned(), label));
        }
    }
    Ok(())
}

/// What is in the box of a row, and what is beside it at once.
fn boxed<'r>(row: &'r str, script: &Script) -> Result<(&'r str, &'r str), String> {
    let [left, right] = script.borders;
    let parts = row.strip_prefix(left).and_then(|rest| rest.split_once(right));
    let (text, arrows) = parts.ok_or_else(|| format!("no box in {row:?}"))?;
    let is_clear = text.starts_with(' ') && text.ends_with(' ');
    match is_clear && (!arrows.starts_with(' ') || arrows.trim_end_matches(' ').is_empty()) {
        true => Ok((text, arrows)),
        false => Err(format!("something touches the border, or nothing does: {row:?}")),
    }
}
