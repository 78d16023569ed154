//! Diagnostics as records carry them, the ones that matter most first.

use crate::runtime::findings::spelled_out;
use crate::runtime::record::Finding;
use crate::syntax::{Diagnostic, Source};

pub fn errors_first(diagnostics: &[Diagnostic], sources: &[Source]) -> Vec<Finding> {
    let mut sorted: Vec<&Diagnostic> = diagnostics.iter().collect();
    sorted.sort_by_key(|diagnostic| (diagnostic.severity, diagnostic.span.file, diagnostic.span.start));
    sorted.into_iter().map(|diagnostic| spelled_out(diagnostic, sources)).collect()
}
