//! Brackets that don't match: where indentation says they belong, and how that is reported. Knows where forms may stand, not how they are written.

use std::ops::Range;

use super::diagnostic::{Code, Diagnostic};
use super::findings::Findings;
use super::keyword::{Keyword, Place};
use super::pieces::{Piece, too_deep};
use super::reader::{Builder, Close, Group, Node};
use super::source::{FileId, Span};

/// What was done to make the brackets match.
#[derive(Clone, Debug)]
pub enum Repair {
    /// Brackets added where groups, innermost first, are left open; each with the range of its first words.
    Close { opened: Vec<Range<u32>>, add_at: u32 },
    /// A closing bracket passed over.
    Remove { at: u32 },
    /// Everything from this bracket to its end passed over.
    TooDeep { at: u32 },
}

impl Builder<'_> {
    /// Before a form that begins here: closes the groups it can't be in, or opens again the one that it belongs to.
    pub(super) fn make_room(&mut self, piece: Piece, keyword: Option<Keyword>) {
        let unclosed = (0..self.stack.len()).rev().take_while(|&depth| self.is_over(depth, piece, keyword)).count();
        self.close_unclosed(unclosed);
        if let Some(keyword) = keyword
            && piece.begins_line
        {
            self.reopen(piece.indent, keyword);
        }
    }

    /// Whether the open group at this depth must have ended before a form that begins here.
    fn is_over(&self, depth: usize, piece: Piece, keyword: Option<Keyword>) -> bool {
        let group = &self.stack[depth];
        let container = matches!(group.place(), Some(Place::Machine | Place::State));
        let misplaced = keyword.is_some_and(|keyword| self.belongs_outside(depth, keyword));
        if !piece.begins_line {
            return misplaced && group.place() != Some(Place::Transition);
        }
        match piece.indent.cmp(&group.indent) {
            std::cmp::Ordering::Less => true,
            std::cmp::Ordering::Equal => {
                misplaced || (group.begins_line && group.child_column.is_some_and(|column| column > piece.indent))
            }
            std::cmp::Ordering::Greater => misplaced && !container,
        }
    }

    /// Whether a form can't be in the open group at this depth, but can be further out.
    fn belongs_outside(&self, depth: usize, keyword: Keyword) -> bool {
        let fits = |group: &Group| group.place().is_some_and(|place| keyword.may_stand(place));
        let here = &self.stack[depth];
        here.place().is_some() && !fits(here) && (keyword.may_stand(Place::Top) || self.stack[..depth].iter().any(fits))
    }

    /// A form indented like those in the group just closed, and at home there: that group was closed too early.
    fn reopen(&mut self, column: u32, keyword: Keyword) {
        let accepted_here = self.accepts(keyword);
        let top = self.top();
        let Some(Node::Group(last)) = top.nodes.last() else {
            return;
        };
        let holds = last.place().is_some_and(|place| keyword.may_stand(place));
        let lined_up = last.child_column == Some(column) || !accepted_here;
        if last.close == Close::Bracket && last.begins_line && last.indent < column && holds && lined_up {
            let at = last.end - 1;
            let Some(Node::Group(group)) = top.nodes.pop() else {
                return;
            };
            let end = group.nodes.last().map_or(group.start + 1, |node| node.range().end as u32);
            self.stack.push(Group { end, close: Close::Missing, ..group });
            self.complaints += 1;
            self.repairs.push(Repair::Remove { at });
        }
    }

    /// A bracket that begins its line closes the group that begins in the same column.
    pub(super) fn line_up(&mut self, piece: Piece) {
        let deeper = self.stack.iter().rev().take_while(|group| group.indent > piece.indent).count();
        let lines_up = self.stack.iter().any(|group| group.begins_line && group.indent == piece.indent);
        if piece.begins_line && lines_up {
            self.close_unclosed(deeper);
        }
    }
}

/// Adds what was repaired to the findings.
pub(super) fn report(repairs: Vec<Repair>, text: &str, file: FileId, findings: &mut Findings) {
    let mut removed = Vec::new();
    for repair in repairs {
        match repair {
            Repair::Close { opened, add_at } => findings.add(unclosed(&opened, add_at, text, file)),
            Repair::TooDeep { at } => findings.add(too_deep(span(file, &(at..at + 1)))),
            Repair::Remove { at } => removed.push(at),
        }
    }
    for run in runs(removed, text) {
        let brackets = &text[run.start as usize..run.end as usize];
        findings.add(stray(span(file, &run), brackets));
    }
}

/// Brackets with nothing but white space between them, taken together.
fn runs(mut brackets: Vec<u32>, text: &str) -> Vec<Range<u32>> {
    brackets.sort_unstable();
    let mut runs: Vec<Range<u32>> = Vec::new();
    for at in brackets {
        match runs.last_mut() {
            Some(run) if text[run.end as usize..at as usize].trim().is_empty() => run.end = at + 1,
            _ => runs.push(at..at + 1),
        }
    }
    runs
}

fn span(file: FileId, range: &Range<u32>) -> Span {
    Span { file, start: range.start, end: range.end }
}

fn unclosed(opened: &[Range<u32>], add_at: u32, text: &str, file: FileId) -> Diagnostic {
    let name = |range: &Range<u32>| format!("`{}`", &text[range.start as usize..range.end as usize]);
    let (innermost, outer) = opened.split_first().expect("a repair closes something");
    let message = match outer {
        [] => format!("{} is not closed", name(innermost)),
        [one] => format!("{} is not closed, nor is {} around it", name(innermost), name(one)),
        _ => format!("{} is not closed, nor are {} brackets around it", name(innermost), outer.len()),
    };
    let brackets = ")".repeat(opened.len().min(5));
    let add =
        if opened.len() > 5 { format!("add {} brackets here", opened.len()) } else { format!("add `{brackets}` here") };
    let error = Diagnostic::error(Code::UnclosedBracket, span(file, innermost), message)
        .also(Span::new(file, add_at as usize, add_at as usize), add)
        .help("the place is a guess from the indentation: close it where it should end");
    outer.iter().take(3).fold(error, |error, range| error.also(span(file, range), "still open as well"))
}

fn stray(span: Span, brackets: &str) -> Diagnostic {
    let count = brackets.matches(')').count();
    let message =
        if count == 1 { "this `)` closes nothing".to_string() } else { format!("these {count} `)` close nothing") };
    Diagnostic::error(Code::StrayBracket, span, message).help(if count == 1 {
        "remove it, or add the `(` that it should close"
    } else {
        "remove them, or add each `(` that they should close"
    })
}
