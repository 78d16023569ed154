//! What happened, in order, each entry with a number of its own, so that a reader's place holds still while entries come and go.

use crate::ui::glyphs::{RIGHT, TIMES};
use std::collections::VecDeque;

use super::{Path, name};
use crate::model::TransitionId;
use crate::runtime::record::{Level, Log};
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
    /// How often a program said this, the last time when.
    pub times: u64,
    pub last: Time,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    Log(Level),
    /// A transition taken.
    Change(Cause),
    /// A person set a variable.
    Hand(Hand),
    /// An edit, a pause, a restart, a robot coming or going.
    Note,
}

impl Kind {
    /// Whether nobody misses it for half a second.
    pub fn can_wait(&self) -> bool {
        matches!(self, Kind::Change(_) | Kind::Log(Level::Debug | Level::Info))
    }
}

/// The transition that was taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cause {
    /// The event's name, `block`, `eps` or `ontime`.
    pub trigger: Path,
    pub name: Option<Path>,
    /// In the program of this many loads.
    pub transition: Option<(u64, TransitionId)>,
    /// What its condition saw: `robot.light.data 142`.
    pub evidence: Vec<String>,
}

/// A variable that is set again and again keeps one entry for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hand {
    var: Path,
    before: String,
    times: u64,
    last: Time,
}

/// Within this time a variable set again is set by the same hand.
const SAME_HAND: Time = Time(3_000_000);
/// Within this time the same words in the same place are the same again.
const SAME_VOICE: Time = Time(3_000_000);
/// So far back it is looked for.
const NEAR: usize = 40;

impl Journal {
    /// From one value to another, both as text.
    pub fn set_by_hand(&mut self, t: Time, var: &Path, from: &str, to: &str) {
        let mut recent = self.entries.iter_mut().rev().take(NEAR);
        let known = recent.find_map(|entry| match &mut entry.kind {
            Kind::Hand(hand) if hand.var == *var && t.since(hand.last) < SAME_HAND => Some((&mut entry.text, hand)),
            _ => None,
        });
        if let Some((text, hand)) = known {
            (hand.times, hand.last) = (hand.times + 1, t);
            *text = format!("{} {} {RIGHT} {to} ({TIMES}{})", name(var), hand.before, hand.times);
            return;
        }
        let text = format!("{} {from} {RIGHT} {to}", name(var));
        let hand = Hand { var: var.clone(), before: from.into(), times: 1, last: t };
        self.add(t, Kind::Hand(hand), text, "".into(), None);
    }

    pub fn add(&mut self, t: Time, kind: Kind, text: String, state: Path, place: Option<(Path, usize)>) {
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(Entry { number: self.next, t, kind, text, state, place, times: 1, last: t });
        self.next += 1;
    }

    /// What a program says again and again is one entry.
    pub fn log(&mut self, t: Time, log: &Log) {
        let place = (!log.file.is_empty()).then(|| (log.file.clone(), log.line));
        let is_same = |entry: &Entry| {
            entry.kind == Kind::Log(log.level)
                && entry.text == log.message
                && (&entry.state, &entry.place) == (&log.state, &place)
                && t.since(entry.last) < SAME_VOICE
        };
        match self.entries.iter_mut().rev().take(NEAR).find(|entry| is_same(entry)) {
            Some(known) => (known.times, known.last) = (known.times + 1, t),
            None => self.add(t, Kind::Log(log.level), log.message.clone(), log.state.clone(), place),
        }
    }

    pub fn note(&mut self, t: Time, text: impl Into<String>) {
        self.add(t, Kind::Note, text.into(), "".into(), None);
    }

    /// Lines are history and stay; variables that are set again go on in theirs.
    pub fn rename(&mut self, to: impl Fn(&Path) -> Path) {
        for entry in &mut self.entries {
            if let Kind::Hand(hand) = &mut entry.kind {
                hand.var = to(&hand.var);
            }
        }
    }

    pub fn newest(&self) -> Option<&Entry> {
        self.entries.back()
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
