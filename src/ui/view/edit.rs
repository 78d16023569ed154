//! The outcome of a save: in the few words that fit the status line, and line by line.

use super::{Path, name};
use crate::runtime::record::{Because, Change, Element, Finding, Held, Load, Op};
use crate::ui::format;

#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The first program.
    Loaded,
    Taken(Outcome),
    /// It waits; `changes`: `+2 states, ~1 action`.
    Held {
        changes: String,
    },
    /// What waited was forgotten.
    Dropped,
    /// A person had the program begin again since.
    Restarted,
    /// What couldn't be taken over is mended: what runs is what the files say.
    Mended,
    /// The program that runs goes on; the first finding says why.
    Rejected {
        first: Finding,
        others: usize,
    },
}

/// What an edit changed and what that did to what runs, or would do.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    pub changes: Vec<Change>,
    /// Why the program begins again.
    pub restarted: Option<String>,
    /// Machines that start again on their own.
    pub again: Vec<Path>,
    /// Machines that run no longer.
    pub discarded: Vec<Path>,
    /// What of it does that.
    pub because: Vec<Because>,
}

impl Edit {
    /// `before`: the outcome that this one takes the place of.
    pub fn of_load(load: &Load, before: Option<&Edit>) -> Edit {
        if load.changes.is_empty() && matches!(before, Some(Edit::Rejected { .. })) {
            return Edit::Mended;
        }
        Edit::Taken(Outcome::of(load))
    }

    pub fn of_reject(findings: &[Finding]) -> Edit {
        match findings.first() {
            Some(first) => Edit::Rejected { first: first.clone(), others: findings.len() - 1 },
            None => Edit::Mended,
        }
    }
}

impl Outcome {
    fn of(load: &Load) -> Outcome {
        let reason = || load.reason.clone().unwrap_or_else(|| "the program began again".into());
        Outcome {
            changes: load.changes.clone(),
            restarted: load.restarted.then(reason),
            again: load.again.clone(),
            discarded: load.discarded.clone(),
            because: load.because.clone(),
        }
    }

    /// What a held edit would do.
    pub fn of_held(held: &Held) -> Outcome {
        Outcome {
            changes: held.changes.clone(),
            restarted: held.restarts.clone(),
            again: held.again.clone(),
            discarded: held.discarded.clone(),
            because: held.because.clone(),
        }
    }

    /// `renamed looking to searching, ~1 action`
    pub fn summary(&self) -> String {
        summary(&self.changes)
    }

    /// Whether anything that ran was disturbed.
    pub fn disturbs(&self) -> bool {
        self.restarted.is_some() || !self.again.is_empty() || !self.discarded.is_empty()
    }

    /// Whether there is more to say of it than its summary.
    pub fn is_eventful(&self) -> bool {
        self.disturbs() || self.changes.len() > 1
    }

    /// Whether it gives a variable another initial value: that was wanted.
    pub fn gives(&self, var: &str) -> bool {
        let gives = |change: &Change| change.kind == Element::Variable && change.op == Op::Changed;
        self.changes.iter().any(|change| gives(change) && *change.path == *var)
    }

    /// `; restarted: active state follower/looking changed`, after the summary.
    pub fn effects(&self) -> Vec<String> {
        let restarted = self.restarted.iter().map(|reason| format!("restarted: {reason}"));
        let again = self.again.iter().map(|machine| format!("again: {machine}"));
        let ended = self.discarded.iter().map(|machine| format!("ended: {machine}"));
        restarted.chain(again).chain(ended).collect()
    }

    /// What one of its changes does to what runs, `restarts: active state looking changed`; none where nothing is disturbed.
    pub fn effect_of(&self, change: &Change) -> Option<String> {
        let because = self.because.iter().find(|because| because.is_of(change))?;
        if self.restarted.is_some() {
            return Some(format!("restarts: {}", because.sentence(name(&because.path))));
        }
        let verb = if self.discarded.contains(&because.machine) { "ends" } else { "again" };
        Some(format!("{verb}: {}", name(&because.machine)))
    }
}

/// `added state follower/a`, `renamed state follower/looking to searching`
pub fn describe(change: &Change) -> String {
    sentence(change, &change.path)
}

/// `added state a`
pub fn describe_shortly(change: &Change) -> String {
    sentence(change, short_name(change))
}

fn sentence(change: &Change, called: &str) -> String {
    let verb = match change.op {
        Op::Added => "added",
        Op::Removed => "removed",
        Op::Changed => "changed",
        Op::Renamed => "renamed",
    };
    let to = change.to.as_ref().map_or(String::new(), |to| format!(" to {}", name(to)));
    format!("{verb} {} {called}{to}", noun(change.kind))
}

/// Columns up to which one change is named.
const SHORT: u16 = 36;

/// `renamed looking to searching`, `~state looking`, `+2 states, -1 event, ~1 action`: what counts most first.
pub fn summary(changes: &[Change]) -> String {
    if changes.is_empty() {
        return "no change".into();
    }
    let (renamed, others): (Vec<&Change>, Vec<&Change>) = changes.iter().partition(|change| change.op == Op::Renamed);
    let named: Vec<String> = renamed.iter().map(|change| renaming(change)).collect();
    let named = format!("renamed {}", named.join(", "));
    let mut words = Vec::new();
    match renamed.len() {
        0 => (),
        _ if format::width(&named) <= SHORT => words.push(named),
        n => words.push(format!("{n} renamed")),
    }
    match others[..] {
        [] => (),
        [only] if format::width(short_name(only)) <= SHORT => {
            words.push(format!("{}{} {}", sign(only.op), noun(only.kind), short_name(only)));
        }
        _ => words.extend(counts(&others)),
    }
    words.join(", ")
}

fn renaming(change: &Change) -> String {
    let to = change.to.as_deref().map_or("", name);
    format!("{} to {to}", name(&change.path))
}

/// Of a transition its text without the machine.
fn short_name(change: &Change) -> &str {
    match change.kind {
        Element::Transition => change.path.split_once(": ").map_or(&*change.path, |(_, text)| text),
        Element::Breakpoint => &change.path,
        _ => name(&change.path),
    }
}

fn counts(changes: &[&Change]) -> Vec<String> {
    let mut kinds: Vec<(Element, Op, usize)> = Vec::new();
    for change in changes {
        match kinds.iter_mut().find(|(kind, op, _)| (*kind, *op) == (change.kind, change.op)) {
            Some((_, _, count)) => *count += 1,
            None => kinds.push((change.kind, change.op, 1)),
        }
    }
    kinds.sort_by_key(|&(kind, op, _)| (rank(kind), op));
    kinds.iter().map(|&(kind, op, count)| phrase(kind, op, count)).collect()
}

fn rank(kind: Element) -> usize {
    const ORDER: [Element; 9] = [
        Element::Machine,
        Element::State,
        Element::Transition,
        Element::Event,
        Element::Action,
        Element::Variable,
        Element::Spawn,
        Element::Bridge,
        Element::Breakpoint,
    ];
    ORDER.iter().position(|&other| other == kind).unwrap_or(ORDER.len())
}

fn phrase(kind: Element, op: Op, count: usize) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{}{count} {}{plural}", sign(op), noun(kind))
}

fn sign(op: Op) -> char {
    match op {
        Op::Added => '+',
        Op::Removed => '-',
        Op::Changed => '~',
        Op::Renamed => '=',
    }
}

fn noun(kind: Element) -> &'static str {
    match kind {
        Element::Bridge => "bridge",
        Element::Variable => "variable",
        Element::Machine => "machine",
        Element::State => "state",
        Element::Event => "event",
        Element::Transition => "transition",
        Element::Spawn => "spawn",
        Element::Action => "action",
        Element::Breakpoint => "breakpoint",
    }
}
