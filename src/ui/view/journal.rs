//! What happened, in order, each entry with a number of its own, so that a reader's place holds still while entries come and go.

use std::collections::VecDeque;

use super::Path;
use crate::runtime::record::Level;
use crate::runtime::time::Time;

/// How many entries are kept.
pub const KEPT: usize = 2000;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Journal {
    /// Oldest first; their numbers are consecutive.
    entries: VecDeque<Entry>,
    next: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub number: u64,
    pub t: Time,
    pub kind: Kind,
    pub text: String,
    /// The state it concerns; empty where there is none.
    pub state: Path,
    /// File and line where it was written, where it was written anywhere.
    pub place: Option<(Path, usize)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Log(Level),
    /// A transition taken.
    Change,
    /// An edit, a pause, a restart, a robot coming or going.
    Note,
}

impl Journal {
    pub fn add(&mut self, t: Time, kind: Kind, text: String, state: Path, place: Option<(Path, usize)>) {
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(Entry { number: self.next, t, kind, text, state, place });
        self.next += 1;
    }

    pub fn note(&mut self, t: Time, text: impl Into<String>) {
        self.add(t, Kind::Note, text.into(), "".into(), None);
    }

    /// Newest first.
    pub fn newest_first(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().rev()
    }

    pub fn get(&self, number: u64) -> Option<&Entry> {
        let first = self.entries.front()?.number;
        self.entries.get(number.checked_sub(first)? as usize)
    }

    /// The number the next entry will get: how many there have been.
    pub fn next(&self) -> u64 {
        self.next
    }
}
