//! Comments that allow a finding, and what is wrong with those comments themselves.

use crate::syntax::allow::{Allow, allows};
use crate::syntax::nearest::nearest;
use crate::syntax::{Code, Diagnostic, FileId, Source};

pub struct Allowed {
    /// Each with the code it names and whether that was of any use.
    known: Vec<(Allow, Code, Use)>,
    unknown: Vec<Allow>,
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
            for allow in allows(&source.text, FileId(index as u16)) {
                match Code::named(&allow.code) {
                    Some(code) => allowed.known.push((allow, code, Use::NotYet)),
                    None => allowed.unknown.push(allow),
                }
            }
        }
        allowed
    }

    /// Whether a comment allows a finding.
    pub fn covers(&mut self, finding: &Diagnostic) -> bool {
        let mut covered = false;
        for (allow, code, used) in &mut self.known {
            let within = allow.form.is_some_and(|form| {
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
        self.unknown.iter().map(|allow| {
            let help = match nearest(&allow.code, Code::ALL.iter().map(|code| code.name())) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`lrp check --explain` lists the codes".to_string(),
            };
            Diagnostic::warning(Code::UnknownCode, allow.span, format!("no finding has the code `{}`", allow.code))
                .help(help)
        })
    }

    pub fn unused(&self) -> impl Iterator<Item = Diagnostic> + '_ {
        let unused = self.known.iter().filter(|(_, _, used)| *used == Use::NotYet);
        unused.map(|(allow, code, _)| {
            let message = format!("this allows `{}`, but there is nothing of that kind to allow", code.name());
            let help = match allow.form {
                Some(_) => "it stands for the form after it: put it before the one that is meant, or remove it",
                None => "it stands for the form after it, and none follows: put it before the one that is meant",
            };
            Diagnostic::hint(Code::UnusedAllow, allow.span, message).help(help)
        })
    }
}
