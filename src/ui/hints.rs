//! One thing that a key offers just now, seen from what the program is doing. A hint comes when no key was pressed for a
//! while, stays for a while, and is given up once it was followed or read often enough. Nothing of it outlives the run.

use super::action::Action;
use super::app::App;
use super::layout::Pane;
use super::view::{Edit, Mode, name};
use super::words::{Word, words};
use crate::model::Trigger;
use crate::runtime::command::OnEdit;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hint {
    /// Something went wrong at a place in a file.
    Error,
    /// An edit had the program begin again.
    Restarted,
    Paused,
    /// A value set by hand is in no file.
    Unwritten,
    /// A state waits for a timeout that is far off.
    Waits,
    /// A state isn't left, though there are ways out.
    Stays,
}

/// Half seconds without a key before a hint comes.
const PATIENCE: u8 = 4;
/// Half seconds it stays at least, whatever happens.
const STANDS: u8 = 6;
/// Half seconds after which it has been read.
const READ: u8 = 60;
/// Times it is followed before it is known.
const KNOWN: u8 = 2;

/// From so far off on a timeout is waited for, ms.
const FAR: f64 = 4_000.0;
/// After so long in a state one may wonder, ms.
const LONG: f64 = 15_000.0;

/// Which one is shown, and what became of each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hints {
    shown: Option<Hint>,
    /// Half seconds since it came.
    stood: u8,
    /// Half seconds since the last key.
    idle: u8,
    /// Half seconds each was seen.
    seen: [u8; Hint::ALL.len()],
    /// Times each was followed.
    followed: [u8; Hint::ALL.len()],
}

impl Hint {
    /// What matters most first.
    pub const ALL: [Hint; 6] = [Hint::Error, Hint::Restarted, Hint::Paused, Hint::Unwritten, Hint::Waits, Hint::Stays];

    /// With this it is followed.
    fn is_followed_by(self, action: Action) -> bool {
        match self {
            Hint::Error => action == Action::OpenEditor,
            Hint::Restarted => action == Action::SwitchOnEdit,
            Hint::Paused => action == Action::Step,
            Hint::Unwritten => matches!(action, Action::WriteBack | Action::WriteAll),
            Hint::Waits => matches!(action, Action::JumpTo | Action::TransitionTo),
            Hint::Stays => action == Action::WhyNot,
        }
    }

    /// Whether there is reason for it.
    pub fn fits(self, app: &App) -> bool {
        let view = app.view();
        match self {
            Hint::Error => view.problems.iter().any(|problem| problem.key.line > 0) && view.errors() > 0,
            Hint::Restarted => {
                let restarted = matches!(&view.edit, Some(Edit::Taken(outcome)) if outcome.restarted.is_some());
                restarted && view.choices.on_edit == OnEdit::Restart
            }
            Hint::Paused => matches!(view.mode, Mode::Paused { .. }) && !app.halted(),
            Hint::Unwritten => app.unwritten().next().is_some(),
            Hint::Waits => waiting(app).is_some(),
            Hint::Stays => staying(app).is_some(),
        }
    }

    pub fn words(self, app: &App) -> Vec<Word> {
        let text = match self {
            Hint::Error => "{log} {open-editor-at-log} opens your editor at the error",
            Hint::Restarted => "{on-edit}: such edits keep what runs from then on",
            Hint::Paused => "{step} makes one step, {pause} runs on",
            Hint::Unwritten if app.focus() == Pane::Variables && app.offers(Action::WriteBack) => {
                "{write-back} writes your value into the file"
            }
            Hint::Unwritten => "{write-all} writes the values you set into the file",
            Hint::Waits => "{state} lasts: {jump-to} jumps to a selected state",
            Hint::Stays => "{state} isn't left? {why-not} tells why not",
        };
        let state = match self {
            Hint::Waits => waiting(app),
            _ => staying(app),
        };
        words(text, app.keys(), &[("state", &state.unwrap_or_default())])
    }
}

/// The active state whose timeout is far off.
fn waiting(app: &App) -> Option<String> {
    let (program, view) = (app.program()?, app.view());
    let mut active = view.machines.values().filter_map(|machine| machine.active.as_ref().filter(|_| machine.running));
    let far = |path: &&super::view::Path| {
        let timeout = program.state(path).and_then(|state| view.timeout(program, state, view.t));
        timeout.is_some_and(|timeout| timeout.left() > FAR)
    };
    (view.mode == Mode::Running).then(|| active.find(far)).flatten().map(|path| name(path).to_string())
}

/// The active state of the machine that is looked at, when nothing but a guard that stays false keeps it.
fn staying(app: &App) -> Option<String> {
    let (program, view) = (app.program()?, app.view());
    let machine = &program[app.machine()?].path;
    let (path, elapsed) = (view.active(machine)?, view.elapsed(machine, view.t)?);
    let ways = &program[program.state(path)?].outgoing;
    let timed =
        |trigger: &Trigger| matches!(trigger, Trigger::After(_) | Trigger::AfterVar(_) | Trigger::AfterBlock(_));
    let by_guard = !ways.is_empty() && ways.iter().all(|&way| !timed(&program[way].trigger));
    (view.mode == Mode::Running && by_guard && elapsed.ms() > LONG).then(|| name(path).to_string())
}

impl Hints {
    pub fn shown(&self) -> Option<Hint> {
        self.shown
    }

    /// Half a second has passed. `fits`: those there is reason for.
    pub fn beat(&mut self, fits: &[Hint]) {
        self.idle = self.idle.saturating_add(1);
        self.stood = self.stood.saturating_add(1);
        if let Some(hint) = self.shown {
            let seen = &mut self.seen[hint as usize];
            *seen = seen.saturating_add(1);
            if self.is_over(hint) || (!fits.contains(&hint) && self.stood >= STANDS) {
                self.shown = None;
            }
        }
        if self.shown.is_none() && self.idle >= PATIENCE {
            self.shown = fits.iter().copied().find(|&hint| !self.is_over(hint));
            self.stood = 0;
        }
    }

    /// A key was pressed: what there is no more reason for goes at once.
    pub fn key(&mut self, fits: &[Hint]) {
        self.idle = 0;
        self.shown = self.shown.filter(|hint| fits.contains(hint) && !self.is_over(*hint));
    }

    pub fn did(&mut self, action: Action) {
        for hint in Hint::ALL.into_iter().filter(|hint| hint.is_followed_by(action)) {
            let followed = &mut self.followed[hint as usize];
            *followed = followed.saturating_add(1);
        }
    }

    fn is_over(&self, hint: Hint) -> bool {
        self.seen[hint as usize] >= READ || self.followed[hint as usize] >= KNOWN
    }
}
