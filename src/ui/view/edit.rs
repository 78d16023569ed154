//! The outcome of a save, in the few words that fit the status line.

use crate::runtime::record::{Change, Element, Finding, Load, Op};

#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The first program.
    Loaded,
    /// `changes`: `+2 states, ~1 action`.
    Taken { changes: String, restarted: Option<String> },
    /// A person had the program begin again since.
    Restarted,
    /// What couldn't be taken over is mended: what runs is what the files say.
    Mended,
    /// The program that runs goes on; the first finding says why.
    Rejected { first: Finding, others: usize },
}

impl Edit {
    /// `before`: the outcome that this one takes the place of.
    pub fn of_load(load: &Load, before: Option<&Edit>) -> Edit {
        if load.changes.is_empty() && matches!(before, Some(Edit::Rejected { .. })) {
            return Edit::Mended;
        }
        let reason = || load.reason.clone().unwrap_or_else(|| "the program began again".into());
        Edit::Taken { changes: summary(&load.changes), restarted: load.restarted.then(reason) }
    }

    pub fn of_reject(findings: &[Finding]) -> Edit {
        match findings.first() {
            Some(first) => Edit::Rejected { first: first.clone(), others: findings.len() - 1 },
            None => Edit::Mended,
        }
    }
}

/// `+2 states, -1 event, ~1 action`: what counts most first.
pub fn summary(changes: &[Change]) -> String {
    let mut kinds: Vec<(Element, Op, usize)> = Vec::new();
    for change in changes {
        match kinds.iter_mut().find(|(kind, op, _)| (*kind, *op) == (change.kind, change.op)) {
            Some((_, _, count)) => *count += 1,
            None => kinds.push((change.kind, change.op, 1)),
        }
    }
    if kinds.is_empty() {
        return "no change".into();
    }
    kinds.sort_by_key(|&(kind, op, _)| (rank(kind), op));
    let words: Vec<String> = kinds.iter().map(|&(kind, op, count)| phrase(kind, op, count)).collect();
    words.join(", ")
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
    let sign = match op {
        Op::Added => '+',
        Op::Removed => '-',
        Op::Changed => '~',
        Op::Renamed => '=',
    };
    let noun = match kind {
        Element::Bridge => "bridge",
        Element::Variable => "variable",
        Element::Machine => "machine",
        Element::State => "state",
        Element::Event => "event",
        Element::Transition => "transition",
        Element::Spawn => "spawn",
        Element::Action => "action",
        Element::Breakpoint => "breakpoint",
    };
    let plural = if count == 1 { "" } else { "s" };
    format!("{sign}{count} {noun}{plural}")
}
