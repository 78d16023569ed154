//! Which lines of a text are those of another one: what both begin with, and what both end with.

use crate::syntax::Source;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alignment {
    /// Lines that both begin with.
    before: usize,
    /// Lines that both end with, behind those.
    after: usize,
    /// Lines that the first has, and the second.
    lengths: (usize, usize),
}

impl Alignment {
    pub fn of(first: &Source, second: &Source) -> Alignment {
        let lengths = (first.line_count(), second.line_count());
        let shortest = lengths.0.min(lengths.1);
        let same = |a: usize, b: usize| first.text[first.line_range(a)] == second.text[second.line_range(b)];
        let before = (1..=shortest).take_while(|&line| same(line, line)).count();
        let after = (0..shortest - before).take_while(|&up| same(lengths.0 - up, lengths.1 - up)).count();
        Alignment { before, after, lengths }
    }

    /// Where the second text has a line of the first, from 1.
    pub fn second(self, line: usize) -> Option<usize> {
        self.across(line, self.lengths)
    }

    /// Where the first text has a line of the second.
    pub fn first(self, line: usize) -> Option<usize> {
        self.across(line, (self.lengths.1, self.lengths.0))
    }

    fn across(self, line: usize, (from, to): (usize, usize)) -> Option<usize> {
        match line {
            line if line <= self.before => Some(line),
            line if line + self.after > from && line <= from => Some(line + to - from),
            _ => None,
        }
    }
}
