//! Reads the legend below a drawing: what shortened names and labels are in full. Knows nothing of drawings.

use std::collections::BTreeMap;

use super::Seen;

#[derive(Default)]
pub struct Legend {
    states: BTreeMap<String, String>,
    labels: BTreeMap<String, String>,
}

impl Legend {
    /// The lines of the drawing, and what stands below it.
    pub fn split(text: &str) -> Result<(Vec<&str>, Legend), String> {
        let mut lines: Vec<&str> = text.lines().collect();
        let start = lines.iter().position(|line| is_title(line)).unwrap_or(lines.len());
        let below = lines.split_off(start);
        let mut legend = Legend::default();
        for part in below.chunk_by(|_, next| !is_title(next)) {
            let texts = if part[0] == "states" { &mut legend.states } else { &mut legend.labels };
            for entry in unbroken(part[1..].iter().map(|line| (*line).to_owned()))? {
                let pair = entry.strip_prefix("  ").and_then(|entry| entry.split_once("  "));
                let (shown, whole) = pair.ok_or_else(|| format!("not in a legend: {entry:?}"))?;
                if texts.insert(shown.to_owned(), whole.to_owned()).is_some() {
                    return Err(format!("the legend has {shown:?} twice"));
                }
            }
        }
        Ok((lines, legend))
    }

    /// What was seen, with all texts whole.
    pub fn applied(&self, seen: Seen) -> Result<Seen, String> {
        let whole = |texts: &BTreeMap<String, String>, text: String| texts.get(&text).cloned().unwrap_or(text);
        let used = self.states.keys().all(|shown| seen.states.iter().any(|(name, _)| name == shown))
            && self.labels.keys().all(|shown| seen.edges.iter().any(|(_, _, label)| label == shown));
        if !used {
            return Err("the legend tells of what isn't there".to_owned());
        }
        let state = |name| whole(&self.states, name);
        let edges = seen.edges.into_iter();
        let mut edges: Vec<_> =
            edges.map(|(from, to, label)| (state(from), state(to), whole(&self.labels, label))).collect();
        edges.sort();
        Ok(Seen { states: seen.states.into_iter().map(|(name, nested)| (state(name), nested)).collect(), edges })
    }
}

fn is_title(line: &str) -> bool {
    line == "states" || line == "labels"
}

/// The lines, each with those appended that are further in.
pub fn unbroken(lines: impl Iterator<Item = String>) -> Result<Vec<String>, String> {
    let mut items: Vec<String> = Vec::new();
    for line in lines {
        match line.strip_prefix("    ") {
            Some(more) => items.last_mut().ok_or("a line goes on that never began")?.push_str(more),
            None => items.push(line),
        }
    }
    Ok(items)
}
