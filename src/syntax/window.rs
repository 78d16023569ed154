//! The lines of a text that are shown with a diagnostic, cut to a length that can be read. Knows nothing of what is said of them.

use std::ops::Range;

use super::render::{LONG_LINE, Mark};
use super::source::{Source, Span};

/// Characters shown of a line that is too long, and how many of them before the place that matters.
const PART: usize = 80;
const BEFORE: usize = 30;

/// Lines that follow one another, with a line feed after each whatever ended it in the text.
pub struct Window {
    pub text: String,
    /// One-based number of the first line.
    pub first: usize,
    lines: Vec<Line>,
}

/// What is shown of a line: bytes of the source, and where they begin in the window.
struct Line {
    shown: Range<usize>,
    at: usize,
}

impl Window {
    /// From the first to the last line in which a mark begins.
    pub fn new(source: &Source, marks: &[Mark]) -> Self {
        let numbers = marks.iter().map(|mark| source.line(mark.span.start as usize));
        let first = numbers.clone().min().unwrap_or(1);
        let last = numbers.max().unwrap_or(1);
        let mut window = Window { text: String::new(), first, lines: Vec::with_capacity(last - first + 1) };
        for number in first..=last {
            let line = without_mark(source, source.line_range(number));
            let marked = marks.iter().map(|mark| mark.span.start as usize).find(|at| source.line(*at) == number);
            window.push(source, line.clone(), part(&source.text, line, marked));
        }
        window
    }

    fn push(&mut self, source: &Source, line: Range<usize>, shown: Range<usize>) {
        // As many blanks as characters are left out, so that columns stay right; the renderer shows dots for them.
        let hidden = source.text[line.start..shown.start].chars().count();
        self.text.extend(std::iter::repeat_n(' ', hidden));
        let at = self.text.len();
        self.text.push_str(&source.text[shown.clone()]);
        if shown.end < line.end {
            self.text.push_str("...");
        }
        self.text.push('\n');
        self.lines.push(Line { shown, at });
    }

    /// A span's place in the window, cut off where what is shown of its first line ends.
    pub fn place(&self, source: &Source, span: Span) -> Range<usize> {
        let index = source.line(span.start as usize).saturating_sub(self.first).min(self.lines.len() - 1);
        let Line { shown, at } = &self.lines[index];
        let place = |offset: u32| (offset as usize).clamp(shown.start, shown.end) - shown.start + at;
        place(span.start)..place(span.end)
    }
}

/// A line without the byte order mark that the text may begin with.
fn without_mark(source: &Source, line: Range<usize>) -> Range<usize> {
    let mark = if line.start == 0 && source.text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    line.start + mark..line.end
}

/// What to show of a line: all, or the part around the byte that matters.
fn part(text: &str, line: Range<usize>, marked: Option<usize>) -> Range<usize> {
    if line.len() <= LONG_LINE {
        return line;
    }
    let marked = marked.unwrap_or(line.start).clamp(line.start, line.end);
    let before = text.get(line.start..marked).unwrap_or("");
    let start = before.char_indices().rev().nth(BEFORE).map_or(line.start, |(i, _)| line.start + i);
    let rest = &text[start..line.end];
    let end = rest.char_indices().nth(PART).map_or(line.end, |(i, _)| start + i);
    start..end
}
