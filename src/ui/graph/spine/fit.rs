//! Finds the longest texts with which a spine keeps to a width. Knows nothing of rows and lanes.

use super::columns::{Columns, Spacing};
use super::stack::Stack;
use super::texts::{Limits, Texts};
use crate::ui::graph::{Options, Place, words};

/// All texts are shortened to this before any becomes shorter still.
const COMFORTABLE: usize = 8;
/// By less nobody knows a text again.
const LEAST: usize = 4;

/// Columns, and what is shown of each text in them.
pub struct Fitted {
    pub columns: Columns,
    pub names: Vec<String>,
    /// One for each edge.
    pub labels: Vec<String>,
}

/// `None` if no texts keep to the width asked for that still tell what is whose.
pub fn fit(stack: &Stack, texts: &Texts, options: &Options) -> Option<Fitted> {
    let max = options.max_width.map(usize::from);
    let middle = max.filter(|_| options.place == Place::Middle).map(Spacing::Middle);
    let within = |limits, spacing| {
        let columns = Columns::new(stack, texts, limits, spacing);
        let keeps = max.is_none_or(|max| columns.width() <= max);
        keeps.then(|| filled(columns, stack, texts, limits)).flatten()
    };
    let tight = |limits| within(limits, Spacing::Tight);
    let mut limits = texts.full();
    let whole = middle.into_iter().chain([Spacing::Stepped, Spacing::Tight]).find_map(|it| within(limits, it));
    whole.or_else(|| {
        [COMFORTABLE, LEAST].into_iter().find_map(|least| {
            let fitted = longest(least, limits.label, |label| tight(Limits { label, ..limits }));
            limits.label = limits.label.min(least);
            let fitted = fitted.or_else(|| longest(least, limits.name, |name| tight(Limits { name, ..limits })));
            limits.name = limits.name.min(least);
            fitted
        })
    })
}

fn filled(columns: Columns, stack: &Stack, texts: &Texts, limits: Limits) -> Option<Fitted> {
    let names: Vec<_> = texts.names().iter().map(|name| (name.as_str(), limits.name)).collect();
    let labels = texts.labels().iter().zip(&stack.runs);
    let labels: Vec<_> = labels.map(|(label, &run)| (label.as_str(), columns.room(run, texts))).collect();
    let (names, labels) = (words::distinct(&names, texts.glyphs)?, words::distinct(&labels, texts.glyphs)?);
    Some(Fitted { columns, names, labels })
}

/// What fits with the longest texts of `least` to `most` columns; with shorter ones nothing fits worse.
fn longest(least: usize, most: usize, fitted: impl Fn(usize) -> Option<Fitted>) -> Option<Fitted> {
    let mut best = fitted(least.min(most))?;
    let (mut low, mut high) = (least.min(most), most);
    while low < high {
        let middle = (low + high).div_ceil(2);
        match fitted(middle) {
            Some(better) => (best, low) = (better, middle),
            None => high = middle - 1,
        }
    }
    Some(best)
}
