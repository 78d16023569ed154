//! What a failing test says: what was expected, what was seen, where, and how the program came there.

use std::fmt;
use std::path::PathBuf;

/// Why an expectation or another call of a test failed. Goes through the test's Lua as an error.
#[derive(Clone, Debug)]
pub struct Complaint {
    pub message: String,
    /// What was there instead.
    pub seen: Option<String>,
}

impl Complaint {
    pub fn new(message: impl Into<String>) -> Complaint {
        Complaint { message: message.into(), seen: None }
    }

    pub fn seen(self, seen: impl Into<String>) -> Complaint {
        Complaint { seen: Some(seen.into()), ..self }
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Complaint {}

impl From<Complaint> for mlua::Error {
    fn from(complaint: Complaint) -> mlua::Error {
        mlua::Error::external(complaint)
    }
}

/// A line of a test, as users know the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    pub file: PathBuf,
    pub line: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}:{}", self.file.display(), self.line)
    }
}

#[derive(Clone, Debug)]
pub struct Failure {
    /// The line that failed, then those that called it.
    pub places: Vec<Place>,
    /// That line's text.
    pub line: Option<String>,
    pub complaint: Complaint,
    pub situation: Option<Situation>,
}

/// How the program stood when a test failed, in lines for reading.
#[derive(Clone, Debug)]
pub struct Situation {
    pub time: String,
    pub active: Vec<String>,
    pub records: Vec<String>,
    /// The latest inputs, and the outputs of the last step.
    pub robot: Vec<String>,
    /// What went wrong in the program itself.
    pub errors: Vec<String>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut message = self.complaint.message.trim_end().lines();
        let first = message.next().unwrap_or("");
        match self.places.first() {
            Some(place) => writeln!(f, "  {place}: {first}")?,
            None => writeln!(f, "  {first}")?,
        }
        if let (Some(place), Some(line)) = (self.places.first(), &self.line) {
            writeln!(f, "    {:>5} | {}", place.line, line.trim())?;
        }
        for caller in self.places.iter().skip(1) {
            writeln!(f, "    called from {caller}")?;
        }
        indented(f, message, 4)?;
        if let Some(seen) = &self.complaint.seen {
            section(f, "seen", seen.lines())?;
        }
        match &self.situation {
            Some(situation) => situation.fmt(f),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Situation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "    at {}", self.time)?;
        let sections = [
            ("active", &self.active),
            ("errors of the program", &self.errors),
            ("last records", &self.records),
            ("robot", &self.robot),
        ];
        for (title, lines) in sections {
            section(f, title, lines.iter().map(String::as_str))?;
        }
        Ok(())
    }
}

fn section<'l>(f: &mut fmt::Formatter, title: &str, lines: impl Iterator<Item = &'l str>) -> fmt::Result {
    let mut lines = lines.peekable();
    if lines.peek().is_some() {
        writeln!(f, "    {title}:")?;
    }
    indented(f, lines, 6)
}

fn indented<'l>(f: &mut fmt::Formatter, lines: impl Iterator<Item = &'l str>, columns: usize) -> fmt::Result {
    for line in lines {
        match line.trim_end() {
            "" => writeln!(f)?,
            line => writeln!(f, "{:columns$}{line}", "")?,
        }
    }
    Ok(())
}
