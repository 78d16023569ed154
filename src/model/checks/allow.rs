//! Comments that allow a finding, and what is wrong with those comments themselves.

use crate::syntax::allow::{Allow, allows};
use crate::syntax::nearest::nearest;
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

pub struct Allowed {
    known: Vec<Known>,
    unknown: Vec<Diagnostic>,
}

/// A code that a comment names.
struct Known {
    code: Code,
    span: Span,
    /// The form that the comment is about.
    form: Option<Span>,
    used: Use,
}

#[derive(Clone, Copy, PartialEq)]
enum Use {
    NotYet,
    Silenced,
}

impl Allowed {
    pub fn of(sources: &[Source]) -> Allowed {
        let mut allowed = Allowed { known: Vec::new(), unknown: Vec::new() };
        for (index, source) in sources.iter().enumerate() {
            allows(&source.text, FileId(index as u16)).iter().for_each(|allow| allowed.add(allow));
        }
        allowed
    }

    /// From a word on that isn't even nearly a code, the rest is most likely meant as a reason.
    fn add(&mut self, Allow { words, form }: &Allow) {
        for (index, (word, span)) in words.iter().enumerate() {
            if let Some(code) = Code::named(word) {
                self.known.push(Known { code, span: *span, form: *form, used: Use::NotYet });
                continue;
            }
            let message = format!("no finding has the code `{word}`");
            let finding = Diagnostic::warning(Code::UnknownCode, *span, message);
            match nearest(word, Code::ALL.iter().map(|code| code.name())) {
                Some(near) => self.unknown.push(finding.help(format!("did you mean `{near}`?"))),
                None => return self.unknown.push(finding.help(help(&words[..index], &words[index..]))),
            }
        }
    }

    /// Whether a comment allows a finding.
    pub fn covers(&mut self, finding: &Diagnostic) -> bool {
        let mut covered = false;
        for Known { code, form, used, .. } in &mut self.known {
            let within = form.is_some_and(|form| {
                form.file == finding.span.file && form.start <= finding.span.start && finding.span.end <= form.end
            });
            if within && *code == finding.code {
                *used = Use::Silenced;
                covered = true;
            }
        }
        covered
    }

    pub fn unknown(&self) -> impl Iterator<Item = Diagnostic> + '_ {
        self.unknown.iter().cloned()
    }

    pub fn unused(&self) -> impl Iterator<Item = Diagnostic> + '_ {
        let unused = self.known.iter().filter(|known| known.used == Use::NotYet);
        unused.map(|Known { code, span, form, .. }| {
            let message = format!("this allows `{}`, but there is nothing of that kind to allow", code.name());
            let help = match form {
                Some(_) => "it stands for the form after it: put it before the one that is meant, or remove it",
                None => "it stands for the form after it, and none follows: put it before the one that is meant",
            };
            Diagnostic::hint(Code::UnusedAllow, *span, message).help(help)
        })
    }
}

type Words = [(String, Span)];

/// `rest`: from the word on that is no code.
fn help(before: &Words, rest: &Words) -> String {
    let joined = |words: &Words| words.iter().map(|(word, _)| &**word).collect::<Vec<_>>().join(" ");
    let are_codes = before.iter().all(|(word, _)| Code::named(word).is_some());
    match (if are_codes { before } else { &[] }, rest) {
        ([], [_]) => "`lrp check --explain` lists the codes".to_string(),
        ([], _) => "`lrp check --explain` lists the codes; a reason is written after them, behind a colon".to_string(),
        _ => format!("a reason is written behind a colon: `; lrp: allow {}: {}`", joined(before), joined(rest)),
    }
}
