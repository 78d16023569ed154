//! Finds the longest texts with which a spine keeps to a width. Knows nothing of rows and lanes.

use super::columns::{Columns, Spacing};
use super::stack::Stack;
use crate::ui::graph::texts::{Limits, Texts};
use crate::ui::graph::{Options, Place, words};

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
    let middle =
        max.filter(|_| options.place == Place::Middle).map(|width| [Spacing::Roomy(width), Spacing::Middle(width)]);
    let within = |limits, spacing| {
        let columns = Columns::new(stack, texts, limits, spacing);
        let keeps = max.is_none_or(|max| columns.width() <= max);
        keeps.then(|| filled(columns, stack, texts, limits)).flatten()
    };
    let whole = texts.full();
    let spacings = middle.into_iter().flatten().chain([Spacing::Stepped, Spacing::Tight]);
    let fitted = spacings.into_iter().find_map(|spacing| within(whole, spacing));
    fitted.or_else(|| whole.longest(|limits| within(limits, Spacing::Tight)))
}

fn filled(columns: Columns, stack: &Stack, texts: &Texts, limits: Limits) -> Option<Fitted> {
    let labels = texts.labels().iter().zip(&stack.runs);
    let labels: Vec<_> = labels.map(|(label, &run)| (label.as_str(), columns.room(run, texts))).collect();
    let (names, labels) = (texts.names_within(limits)?, words::distinct(&labels, texts.glyphs)?);
    Some(Fitted { columns, names, labels })
}
