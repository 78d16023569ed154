//! A drawing as text with the colours of its transitions, for a terminal that nothing else is drawn on.

use std::fmt::Write;

use ratatui::style::{Color, Style};

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
            let wanted = code(style(drawing.cell(x, y).part, graph, theme));
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

/// The number that a terminal knows a colour of text by.
fn code(style: Style) -> Option<u8> {
    Some(match style.fg? {
        Color::Black => 30,
        Color::Red => 31,
        Color::Green => 32,
        Color::Yellow => 33,
        Color::Blue => 34,
        Color::Magenta => 35,
        Color::Cyan => 36,
        Color::Gray => 37,
        Color::DarkGray => 90,
        Color::LightRed => 91,
        Color::LightGreen => 92,
        Color::LightYellow => 93,
        Color::LightBlue => 94,
        Color::LightMagenta => 95,
        Color::LightCyan => 96,
        Color::White => 97,
        Color::Reset | Color::Rgb(..) | Color::Indexed(_) => return None,
    })
}
