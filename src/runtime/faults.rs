//! What went wrong and was skipped, each fault once with how often it happened. Knows nothing of machines.

use std::collections::HashMap;
use std::sync::Arc;

use super::record::Fault;
use super::time::Time;
use crate::syntax::{Code, Source, Span};

/// A fault goes out at its first occurrence, then at most this often while it goes on.
const REPORT_EVERY: Time = Time(1_000_000);

#[derive(Default)]
pub struct Faults {
    known: Vec<Entry>,
    by_place: HashMap<(Code, Span), usize>,
    /// Entries that happened again since they last went out.
    unreported: usize,
}

struct Entry {
    code: Code,
    span: Span,
    fault: Fault,
    reported: u64,
    reported_at: Time,
}

pub struct Happening {
    pub code: Code,
    pub span: Span,
    pub message: String,
    pub help: Option<String>,
    pub state: Arc<str>,
}

/// Where a fault of the old program stands in the new one.
pub struct Moved {
    pub span: Span,
    pub source: Source,
    /// The state or machine it belongs to.
    pub state: Arc<str>,
}

impl Faults {
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }

    /// The fault as a record, when it is to go out now.
    pub fn happened(&mut self, now: Time, source: &Source, what: Happening) -> Option<Fault> {
        let key = (what.code, what.span);
        if let Some(&index) = self.by_place.get(&key) {
            let entry = &mut self.known[index];
            if entry.fault.count == entry.reported {
                self.unreported += 1;
            }
            entry.fault.count += 1;
            entry.fault.message = what.message;
            return None;
        }
        let place = source.position(what.span.start as usize);
        let fault = Fault {
            code: what.code.name().to_string(),
            message: what.message,
            help: what.help,
            file: source.name.clone(),
            line: place.line,
            column: place.column,
            state: what.state,
            count: 1,
        };
        self.by_place.insert(key, self.known.len());
        self.known.push(Entry {
            code: what.code,
            span: what.span,
            fault: fault.clone(),
            reported: 1,
            reported_at: now,
        });
        Some(fault)
    }

    /// What stood until now no longer does: gives it out as it was.
    pub fn mended(&mut self, code: Code, span: Span) -> Option<Fault> {
        let index = self.by_place.remove(&(code, span))?;
        let Entry { fault, reported, .. } = self.known.remove(index);
        self.unreported -= usize::from(fault.count > reported);
        self.by_place.values_mut().filter(|later| **later > index).for_each(|later| *later -= 1);
        Some(fault)
    }

    pub fn clear(&mut self) {
        *self = Faults::default();
    }

    /// Whether any fault went on since it was last reported.
    pub fn any_unreported(&self) -> bool {
        self.unreported > 0
    }

    /// Faults that went on and were last reported long enough ago.
    pub fn due(&mut self, now: Time) -> Vec<Fault> {
        let mut due = Vec::new();
        for entry in &mut self.known {
            if entry.fault.count > entry.reported && now.since(entry.reported_at) >= REPORT_EVERY {
                entry.reported = entry.fault.count;
                entry.reported_at = now;
                self.unreported -= 1;
                due.push(entry.fault.clone());
            }
        }
        due
    }

    /// After an edit: keeps those for whose place `moved` has a new one, and gives them out anew.
    pub fn edited(&mut self, now: Time, moved: impl Fn(Code, Span) -> Option<Moved>) -> Vec<Fault> {
        let mut kept = Vec::new();
        for mut entry in std::mem::take(&mut self.known) {
            if let Some(Moved { span, source, state }) = moved(entry.code, entry.span) {
                let place = source.position(span.start as usize);
                entry.span = span;
                (entry.fault.line, entry.fault.column) = (place.line, place.column);
                (entry.fault.file, entry.fault.state) = (source.name, state);
                (entry.reported, entry.reported_at) = (entry.fault.count, now);
                kept.push(entry);
            }
        }
        self.by_place = kept.iter().enumerate().map(|(index, entry)| ((entry.code, entry.span), index)).collect();
        self.unreported = 0;
        self.known = kept;
        self.known.iter().map(|entry| entry.fault.clone()).collect()
    }

    pub fn reported(&self) -> impl Iterator<Item = Fault> + '_ {
        self.known.iter().map(|entry| Fault { count: entry.reported, ..entry.fault.clone() })
    }
}
