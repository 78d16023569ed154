//! Diagnostics as records carry them, the ones that matter most first.

use std::collections::BTreeSet;

use crate::runtime::findings::spelled_out;
use crate::runtime::record::{File, Finding};
use crate::syntax::{Diagnostic, Source};

pub fn errors_first(diagnostics: &[Diagnostic], sources: &[Source]) -> Vec<Finding> {
    let mut sorted: Vec<&Diagnostic> = diagnostics.iter().collect();
    sorted.sort_by_key(|diagnostic| (diagnostic.severity, diagnostic.span.file, diagnostic.span.start));
    sorted.into_iter().map(|diagnostic| spelled_out(diagnostic, sources)).collect()
}

/// What a rejected edit is told with: the findings, and the texts that errors were found in.
pub fn of_rejected(diagnostics: &[Diagnostic], sources: &[Source]) -> (Vec<Finding>, Vec<File>) {
    (errors_first(diagnostics, sources), files(diagnostics, sources))
}

fn files(diagnostics: &[Diagnostic], sources: &[Source]) -> Vec<File> {
    let errors = diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
    let files: BTreeSet<usize> = errors.map(|error| usize::from(error.span.file.0)).collect();
    let texts = files.into_iter().filter_map(|file| sources.get(file));
    texts.map(|source| File { name: source.name.clone(), text: source.text.clone() }).collect()
}
