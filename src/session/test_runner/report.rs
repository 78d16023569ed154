//! What came of tests: a line for each, the details of the failures, the sum.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Duration;

use super::failure::Failure;

#[derive(Clone, Debug)]
pub struct Outcome {
    pub file: PathBuf,
    /// None: the file itself, which can't be read as tests.
    pub name: Option<String>,
    /// Real time.
    pub took: Duration,
    /// What the test printed.
    pub printed: Vec<String>,
    pub failure: Option<Failure>,
}

impl Outcome {
    fn title(&self) -> String {
        match &self.name {
            Some(name) => format!("{}: {name}", self.file.display()),
            None => self.file.display().to_string(),
        }
    }

    /// How it went, with what it printed below.
    pub fn line(&self) -> String {
        let word = if self.failure.is_some() { "FAILED" } else { "ok" };
        let mut line = format!("{word:6} {:6.2} s  {}", self.took.as_secs_f64(), self.title());
        for printed in self.printed.iter().flat_map(|printed| printed.lines()) {
            line += &format!("\n         | {printed}");
        }
        line
    }
}

#[derive(Clone, Debug, Default)]
pub struct Report {
    pub outcomes: Vec<Outcome>,
}

impl Report {
    pub fn failed(&self) -> usize {
        self.outcomes.iter().filter(|outcome| outcome.failure.is_some()).count()
    }

    /// The failures, then the sum.
    pub fn end(&self) -> String {
        let mut text = String::new();
        for outcome in &self.outcomes {
            if let Some(failure) = &outcome.failure {
                // Writing to a string can't fail.
                let _ = write!(text, "\n{}\n{failure}", outcome.title());
            }
        }
        let failed = self.failed();
        text + &format!("\n{} passed, {failed} failed", self.outcomes.len() - failed)
    }
}
