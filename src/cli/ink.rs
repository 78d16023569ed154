//! A drawing as text with the colours of its transitions, for a terminal that nothing else is drawn on.

use std::fmt::Write;

use ratatui::style::Style;

use crate::ui::encoder::number;
use crate::ui::graph::{Drawing, Graph, Part};
use crate::ui::theme::Theme;

/// Lines without trailing blanks; where the theme has no colours, nothing but the text.
pub fn inked(drawing: &Drawing, graph: &Graph, theme: &Theme) -> String {
    let text = drawing.text();
    let mut out = String::new();
    for (y, line) in (0..drawing.height).zip(text.lines()) {
        let mut ink = None;
        let (mut x, mut rest) = (0, line);
        while !rest.is_empty() && x < drawing.width {
            let symbol = drawing.symbol(x, y);
            let wanted = style(drawing.cell(x, y).part, graph, theme).fg.and_then(number);
            if !symbol.is_empty() && wanted != ink {
                // Writing to a string can't fail.
                let _ = write!(out, "\x1b[{}m", wanted.unwrap_or(0));
                ink = wanted;
            }
            out.push_str(&symbol);
            (x, rest) = (x + 1, rest.strip_prefix(&*symbol).unwrap_or(""));
        }
        out.push_str(if ink.is_some() { "\x1b[0m\n" } else { "\n" });
    }
    out
}

fn style(part: Part, graph: &Graph, theme: &Theme) -> Style {
    match part {
        Part::Line(edge) | Part::Label(edge) | Part::Head(edge) | Part::Crossing { across: edge, .. } => {
            theme.transition(graph.edges[edge].kind)
        }
        Part::Blank | Part::Box(_) | Part::Name(_) | Part::Mark(_) | Part::Inside(_) | Part::Target(_) => Style::new(),
    }
}
