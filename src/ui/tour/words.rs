//! What the tour says now, and the room that takes at most.

use super::steps::{ELSE, END, SKIPPED};
use super::{Mark, Need, STEPS, Tour};
use crate::ui::keymap::Keymap;
use crate::ui::view::View;
use crate::ui::words::{Word, lines, plain, words};

impl Tour {
    /// What is to be done now.
    pub fn text(&self, view: &View, keys: &Keymap) -> Vec<Word> {
        match (self.missing(view), self.step()) {
            (Some(need), _) => self.words(need.way_back(), keys),
            (None, Some((_, step))) => self.words(step.task, keys),
            (None, None) if self.marks.contains(&Mark::Skipped) => self.words(SKIPPED, keys),
            (None, None) => self.words(END, keys),
        }
    }

    /// `3 of 14`, `through`
    pub fn heading(&self) -> String {
        match self.step() {
            Some((number, _)) => format!("tour {number} of {}", STEPS.len()),
            None => "tour".into(),
        }
    }

    pub fn title(&self) -> &'static str {
        self.step().map_or("through", |(_, step)| step.title)
    }

    /// Rows that the longest of its texts needs, so that the panes stand still whichever is shown.
    pub fn rows(&self, keys: &Keymap, columns: u16, indent: u16) -> u16 {
        let needs = [Need::Taken, Need::Sound, Need::Alive, Need::Going].map(Need::way_back);
        let texts = STEPS.iter().map(|step| step.task).chain(needs).chain([END, SKIPPED]);
        texts.map(|text| lines(&self.words(text, keys), columns, indent).len() as u16).max().unwrap_or(1)
    }

    /// For the shell, after the tour.
    pub fn outlook(keys: &Keymap) -> String {
        plain(ELSE, keys)
    }

    fn words(&self, text: &str, keys: &Keymap) -> Vec<Word> {
        words(text, keys, &[("file", &*self.file)])
    }
}
