//! What is wrong with the program, as it was found or while it runs, each known by its kind and place.

use super::{Path, within};
use crate::runtime::record::{Fault, Finding};
use crate::runtime::time::Time;

#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    pub key: ProblemKey,
    pub gravity: Gravity,
    pub origin: Origin,
    pub message: String,
    pub help: Option<String>,
    /// The state or machine it belongs to; empty where that isn't known.
    pub state: Path,
    /// How many times it happened; 0 for what was found by reading.
    pub count: u64,
    /// When it was seen last.
    pub last: Time,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ProblemKey {
    pub code: String,
    pub file: Path,
    pub line: usize,
    pub column: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gravity {
    Hint,
    Warning,
    Error,
}

impl Gravity {
    pub fn word(self) -> &'static str {
        match self {
            Gravity::Error => "error",
            Gravity::Warning => "warning",
            Gravity::Hint => "hint",
        }
    }
}

/// Where a problem comes from, and so what makes it go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It happens while the program runs; a load, a restart or its mending clears it.
    Run,
    /// The checks of the program that runs; the next load replaces them.
    Check,
    /// A text that wasn't taken over; the next text replaces it.
    Rejected,
    /// The person's configuration, which is read once.
    Config,
}

impl ProblemKey {
    pub fn of(fault: &Fault) -> ProblemKey {
        ProblemKey { code: fault.code.clone(), file: fault.file.clone(), line: fault.line, column: fault.column }
    }
}

impl Problem {
    pub fn from_fault(fault: &Fault, at: Time) -> Problem {
        Problem {
            key: ProblemKey::of(fault),
            gravity: Gravity::Error,
            origin: Origin::Run,
            message: fault.message.clone(),
            help: fault.help.clone(),
            state: fault.state.clone(),
            count: fault.count,
            last: at,
        }
    }

    pub fn from_finding(finding: &Finding, origin: Origin, at: Time) -> Problem {
        let key = ProblemKey {
            code: finding.code.clone(),
            file: finding.file.clone(),
            line: finding.line,
            column: finding.column,
        };
        Problem {
            key,
            gravity: gravity(&finding.severity),
            origin,
            message: finding.message.clone(),
            help: finding.help.clone(),
            state: "".into(),
            count: 0,
            last: at,
        }
    }

    /// Its line is not in the program that runs.
    pub fn is_of_rejected_text(&self) -> bool {
        self.origin == Origin::Rejected
    }

    /// Whether it belongs to the element of this path or to something inside it.
    pub fn concerns(&self, path: &str) -> bool {
        !self.state.is_empty() && within(&self.state, path)
    }
}

fn gravity(severity: &str) -> Gravity {
    match severity {
        "error" => Gravity::Error,
        "warning" => Gravity::Warning,
        _ => Gravity::Hint,
    }
}
