//! The first row that a list shows: it goes along with the selection, and stays where a person scrolled to meanwhile.

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Scroll {
    top: usize,
    /// The selected row and the rows there were when the selection was brought into sight last.
    seen: Option<(Option<usize>, usize)>,
}

impl Scroll {
    pub fn top(self) -> usize {
        self.top
    }

    /// Brings row `at` into sight where it or the room changed; never shows less than could be.
    pub fn settle(&mut self, at: Option<usize>, length: usize, height: usize) {
        let wanted = at.filter(|_| self.is_new(at, height));
        self.seen = Some((at, height));
        self.top = top_for(self.top, wanted, length, height);
    }

    /// The selected row when it was brought into sight last.
    pub fn at(self) -> Option<usize> {
        self.seen.and_then(|(at, _)| at)
    }

    /// Whether there is a selection to bring into sight.
    pub fn is_new(self, at: Option<usize>, height: usize) -> bool {
        self.seen != Some((at, height))
    }

    pub fn go_to(&mut self, top: usize) {
        self.top = top;
    }

    /// Without the selection.
    pub fn by(&mut self, rows: isize, length: usize, height: usize) {
        self.top = self.top.saturating_add_signed(rows).min(length.saturating_sub(height));
    }

    pub fn rewind(&mut self) {
        *self = Scroll::default();
    }
}

/// The first row to show, so that row `at` is among the `height` rows seen, moved as little as can be.
pub fn top_for(top: usize, at: Option<usize>, length: usize, height: usize) -> usize {
    let top = match at {
        Some(at) if at < top => at,
        Some(at) if at >= top + height => at + 1 - height.max(1),
        _ => top,
    };
    top.min(length.saturating_sub(height))
}
