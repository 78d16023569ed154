//! The tour as a value: tasks one after the other, each done when the records or a person's actions say so. Knows nothing
//! of the terminal, of files, or of how it is drawn.

pub mod folder;
mod steps;
mod words;

use std::sync::Arc;

pub use steps::{Need, STEPS, Step, Until};

use super::action::Action;
use super::view::{Edit, Mode, View};
use crate::runtime::command::{Command, Saves};
use crate::runtime::record::{Record, What};

#[derive(Clone, Debug, PartialEq)]
pub struct Tour {
    /// The program's file, for people.
    file: Arc<str>,
    /// Of each task.
    marks: Vec<Mark>,
    /// Towards a task that is done several times.
    count: usize,
    praise: Option<Praise>,
    pub shown: Shown,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    Open,
    Done,
    Skipped,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Praise {
    words: &'static str,
    /// Half seconds it was seen.
    beats: u8,
}

/// So long a praise stands, half seconds.
const PRAISED: u8 = 8;

/// Whether the strip is on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    Strip,
    Nothing,
}

/// Something that may end a task.
enum Seen<'a> {
    Record(&'a What),
    Did(Action),
    Written,
}

impl Tour {
    /// `progress`: what [`Tour::progress`] told the last time; anything else in it is passed over.
    pub fn new(file: impl Into<Arc<str>>, progress: &str) -> Tour {
        let mark = |step: &Step| {
            let told = progress.lines().find_map(|line| line.strip_suffix(step.id));
            match told.map(str::trim) {
                Some("done") => Mark::Done,
                Some("skipped") => Mark::Skipped,
                _ => Mark::Open,
            }
        };
        let marks = STEPS.iter().map(mark).collect();
        Tour { file: file.into(), marks, count: 0, praise: None, shown: Shown::Strip }
    }

    /// A line for each task that isn't open: `done look`.
    pub fn progress(&self) -> String {
        let lines = STEPS.iter().zip(&self.marks).filter_map(|(step, mark)| match mark {
            Mark::Open => None,
            Mark::Done => Some(format!("done {}\n", step.id)),
            Mark::Skipped => Some(format!("skipped {}\n", step.id)),
        });
        lines.collect()
    }

    /// How many tasks are done.
    pub fn done(&self) -> usize {
        self.marks.iter().filter(|&&mark| mark == Mark::Done).count()
    }

    /// The task that is on, and its number from one; none when the tour is through.
    pub fn step(&self) -> Option<(usize, &'static Step)> {
        let at = self.marks.iter().position(|&mark| mark == Mark::Open)?;
        Some((at + 1, &STEPS[at]))
    }

    pub fn praise(&self) -> Option<&'static str> {
        self.praise.map(|praise| praise.words)
    }

    /// A record, after the picture has taken it in.
    pub fn record(&mut self, record: &Record, view: &View) {
        if let What::Status { .. } = record.what {
            self.praise = self.praise.and_then(Praise::later);
        }
        self.see(&Seen::Record(&record.what), view);
    }

    pub fn did(&mut self, action: Action, view: &View) {
        self.see(&Seen::Did(action), view);
    }

    /// A value was written into the file.
    pub fn written(&mut self, view: &View) {
        self.see(&Seen::Written, view);
    }

    /// The next task; from the end, what was skipped, or all again.
    pub fn next(&mut self, view: &View) {
        match self.step() {
            Some((number, _)) => self.marks[number - 1] = Mark::Skipped,
            None => {
                let again = if self.marks.contains(&Mark::Skipped) { Mark::Skipped } else { Mark::Done };
                self.marks.iter_mut().filter(|mark| **mark == again).for_each(|mark| *mark = Mark::Open);
            }
        }
        (self.count, self.praise) = (0, None);
        self.go_on(view);
    }

    fn see(&mut self, seen: &Seen, view: &View) {
        let Some((_, step)) = self.step() else { return };
        self.count += usize::from(counts(step.until, seen, view));
        let enough = match step.until {
            Until::Stepped(times) | Until::Did(_, times) => times,
            _ => 1,
        };
        if self.count >= enough {
            self.finish();
        }
        self.go_on(view);
    }

    /// Past tasks that have nothing left to do.
    fn go_on(&mut self, view: &View) {
        while self.step().is_some_and(|(_, step)| is_so(step.until, view)) {
            self.finish();
        }
    }

    fn finish(&mut self) {
        if let Some((number, step)) = self.step() {
            self.marks[number - 1] = Mark::Done;
            self.praise = Some(Praise { words: step.praise, beats: 0 });
            self.count = 0;
        }
    }

    /// What has to be put right before the task can be done.
    fn missing(&self, view: &View) -> Option<Need> {
        let (_, step) = self.step()?;
        if view.broken().is_some() && step.needs.contains(&Need::Alive) {
            return Some(Need::Sound);
        }
        step.needs.iter().copied().find(|&need| !is_met(need, view))
    }
}

impl Praise {
    fn later(self) -> Option<Praise> {
        (self.beats < PRAISED).then_some(Praise { beats: self.beats + 1, ..self })
    }
}

/// Whether it is one of the happenings that a task waits for.
fn counts(until: Until, seen: &Seen, view: &View) -> bool {
    match (until, seen) {
        (Until::Did(actions, _), Seen::Did(action)) => actions.contains(action),
        (Until::Changed, Seen::Record(What::Load(load))) => view.loads > 1 && !load.changes.is_empty(),
        (Until::Tuned, Seen::Record(What::Set { by, .. })) => **by == *"command",
        (Until::Written, Seen::Written) | (Until::Sent, Seen::Record(What::Force { .. })) => true,
        (Until::Stepped(_), Seen::Record(What::Command { command })) => *command == Command::Step,
        (Until::Stopped, Seen::Record(What::Command { command })) => *command == Command::Runstop,
        _ => false,
    }
}

/// Whether what a task is to bring about is so already.
fn is_so(until: Until, view: &View) -> bool {
    match until {
        Until::Broken => is_broken(view),
        Until::Mended => !is_broken(view),
        Until::Paused => matches!(view.mode, Mode::Paused { .. } | Mode::Stopped),
        Until::Going => view.mode == Mode::Running,
        Until::Held => view.held.is_some(),
        Until::Decided => is_met(Need::Taken, view),
        _ => false,
    }
}

fn is_met(need: Need, view: &View) -> bool {
    match need {
        Need::Taken => view.held.is_none() && view.choices.saves == Saves::Apply,
        Need::Sound => !is_broken(view),
        // Before the first program there is nothing to say.
        Need::Alive => view.program.is_none() || view.machines.values().any(|machine| machine.running),
        Need::Going => view.mode == Mode::Running,
    }
}

fn is_broken(view: &View) -> bool {
    matches!(view.edit, Some(Edit::Rejected { .. }))
}
