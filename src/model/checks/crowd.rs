//! Keeps one kind of finding from burying the others: half a program that was just pasted has many of them. Knows
//! nothing of what they say.

use std::collections::BTreeMap;

use crate::syntax::{Code, Diagnostic};

/// Of one code, errors apart.
const MOST: usize = 10;

/// The first of each code in the order of the text; the last of these tells how many more there are.
pub fn thinned(mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    found.sort_by_key(|finding| finding.span);
    let mut counts: BTreeMap<Code, usize> = BTreeMap::new();
    for finding in &found {
        *counts.entry(finding.code).or_default() += 1;
    }
    let mut seen: BTreeMap<Code, usize> = BTreeMap::new();
    found.retain_mut(|finding| {
        let nth = seen.entry(finding.code).or_default();
        *nth += 1;
        let more = counts[&finding.code] - *nth;
        if *nth == MOST && more > 0 && !finding.is_error() {
            finding.message = format!("{}; and {more} more like this", finding.message);
        }
        *nth <= MOST || finding.is_error()
    });
    found
}
