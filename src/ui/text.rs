//! One of a program's texts as a person reads it: as it runs, or as it was saved last where that isn't taken over.

use std::ops::Range;

use super::alignment::Alignment;
use super::view::View;
use crate::syntax::{FileId, Source};

#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    pub file: FileId,
    pub source: &'a Source,
    runs: Runs<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Runs<'a> {
    Nothing,
    ThisText,
    /// The text that runs, and which of its lines are those of the one that is read.
    Other(&'a Source, Alignment),
}

impl<'a> Text<'a> {
    /// None where there is no such file.
    pub fn of(view: &'a View, file: FileId) -> Option<Text<'a>> {
        let Some(program) = &view.program else {
            let source = view.refused.first()?;
            return Some(Text { file, source, runs: Runs::Nothing });
        };
        let own = program.sources.get(usize::from(file.0))?;
        let refused = view.refused.iter().find(|source| source.name == own.name);
        Some(match refused {
            None => Text { file, source: own, runs: Runs::ThisText },
            Some(source) => Text { file, source, runs: Runs::Other(own, Alignment::of(own, source)) },
        })
    }

    /// It isn't the text that runs.
    pub fn is_refused(&self) -> bool {
        !matches!(self.runs, Runs::ThisText)
    }

    /// Where a line of the program that runs stands here; none if it was changed.
    pub fn line_here(&self, line: usize) -> Option<usize> {
        match self.runs {
            Runs::Nothing => None,
            Runs::ThisText => Some(line),
            Runs::Other(_, alignment) => alignment.second(line),
        }
    }

    /// The bytes of a line in the text that runs.
    pub fn running(&self, line: usize) -> Option<Range<usize>> {
        match self.runs {
            Runs::Nothing => None,
            Runs::ThisText => Some(self.source.line_range(line)),
            Runs::Other(own, alignment) => alignment.first(line).map(|line| own.line_range(line)),
        }
    }

    /// A byte of a line in the text that runs.
    pub fn running_offset(&self, line: usize, offset: usize) -> Option<usize> {
        let range = self.running(line)?;
        Some((range.start + offset.saturating_sub(self.source.line_range(line).start)).min(range.end))
    }
}
