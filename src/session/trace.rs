//! Records as lines of JSON. A trace that can't be written ends with one report; the program goes on.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::runtime::record;
use crate::runtime::{Record, What};

pub struct Trace {
    out: Box<dyn Write + Send>,
    path: PathBuf,
    /// Until the header is written.
    conditions: Option<Conditions>,
    /// Robots that come up before the program is loaded: told after the header.
    early: Vec<Record>,
    state: State,
    /// Why it ends early, until told.
    trouble: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Open,
    /// Its reader has seen enough, as in `| head`.
    Unread,
    Failed,
}

/// What the first line of a trace tells besides the program's texts.
#[derive(Clone, Debug)]
pub struct Conditions {
    pub rate: f64,
    pub seed: u64,
    pub clock: Clock,
}

#[derive(Serialize)]
struct FirstLine<'a> {
    /// The version of the format.
    lrp: u32,
    /// Milliseconds since 1970.
    #[serde(skip_serializing_if = "Option::is_none")]
    start: Option<u64>,
    rate: f64,
    seed: u64,
    files: &'a [record::File],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    Real,
    /// The trace then says nothing of real time, so that equal runs give equal traces.
    Virtual,
}

impl Trace {
    /// `-` is standard output.
    pub fn create(path: &Path, conditions: Conditions) -> io::Result<Trace> {
        let out: Box<dyn Write + Send> = match path.to_str() {
            Some("-") => Box::new(BufWriter::new(io::stdout())),
            _ => Box::new(BufWriter::new(File::create(path)?)),
        };
        Ok(Trace {
            out,
            path: path.to_path_buf(),
            conditions: Some(conditions),
            early: Vec::new(),
            state: State::Open,
            trouble: None,
        })
    }

    fn header(&mut self, conditions: &Conditions, files: &[record::File]) {
        let start = (conditions.clock == Clock::Real).then(|| {
            let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
            now.as_millis() as u64
        });
        self.line(&FirstLine { lrp: 1, start, rate: conditions.rate, seed: conditions.seed, files });
    }

    /// The header goes before the first one, with the program's texts where that is a load.
    pub fn record(&mut self, record: &Record) {
        match &record.what {
            What::Bridge(_) | What::Offer { .. } | What::Found { .. } | What::Log(_) if self.conditions.is_some() => {
                self.early.push(record.clone());
            }
            What::Load(load) => self.begin(&load.files),
            _ => self.begin(&[]),
        }
        if self.conditions.is_none() {
            self.line(record);
        }
    }

    fn begin(&mut self, files: &[record::File]) {
        if let Some(conditions) = self.conditions.take() {
            self.header(&conditions, files);
            for record in std::mem::take(&mut self.early) {
                self.line(&record);
            }
        }
    }

    pub fn flush(&mut self) {
        if self.state == State::Open {
            let result = self.out.flush();
            self.check(result);
        }
    }

    fn line(&mut self, line: &impl serde::Serialize) {
        if self.state != State::Open {
            return;
        }
        let result = serde_json::to_writer(&mut self.out, line).map_err(io::Error::from);
        let result = result.and_then(|()| self.out.write_all(b"\n"));
        self.check(result);
    }

    fn check(&mut self, result: io::Result<()>) {
        match result {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => self.state = State::Unread,
            Err(error) => {
                self.state = State::Failed;
                self.trouble = Some(format!("the trace {} ends here: {error}", self.path.display()));
            }
        }
    }

    /// Why it couldn't be written to its end; once.
    pub fn trouble(&mut self) -> Option<String> {
        self.trouble.take()
    }

    /// Whether whoever read it has gone.
    pub fn is_unread(&self) -> bool {
        self.state == State::Unread
    }
}

impl Drop for Trace {
    fn drop(&mut self) {
        self.begin(&[]);
        self.flush();
    }
}
