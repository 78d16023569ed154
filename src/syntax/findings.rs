//! The diagnostics gathered while one text is read, and the point at which there are enough. Knows nothing of what they say.

use super::diagnostic::Diagnostic;

/// Nobody reads more; the text is read no further.
pub const MAX_DIAGNOSTICS: usize = 50;

#[derive(Debug, Default)]
pub struct Findings {
    list: Vec<Diagnostic>,
}

impl Findings {
    pub fn add(&mut self, diagnostic: Diagnostic) {
        if !self.is_full() {
            self.list.push(diagnostic);
        }
    }

    pub fn is_full(&self) -> bool {
        self.list.len() >= MAX_DIAGNOSTICS
    }

    /// The first of them that answers the description, to be changed in place.
    pub fn find(&mut self, wanted: impl Fn(&Diagnostic) -> bool) -> Option<&mut Diagnostic> {
        self.list.iter_mut().find(|diagnostic| wanted(diagnostic))
    }

    /// All of them in the order of the text.
    pub fn sorted(mut self) -> Vec<Diagnostic> {
        self.list.sort_by_key(|diagnostic| (diagnostic.span.start, diagnostic.span.end));
        self.list
    }
}
