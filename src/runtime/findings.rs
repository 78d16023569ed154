//! A program's diagnostics and texts as records carry them.

use super::record::{File, Finding};
use crate::model::Program;
use crate::syntax::{Diagnostic, Severity, Source};

pub fn findings(program: &Program, which: impl Fn(&Diagnostic) -> bool) -> Vec<Finding> {
    program
        .findings
        .iter()
        .filter(|finding| which(finding))
        .map(|finding| spelled_out(finding, &program.sources))
        .collect()
}

pub fn spelled_out(diagnostic: &Diagnostic, sources: &[Source]) -> Finding {
    let source = &sources[diagnostic.span.file.0 as usize];
    let place = source.position(diagnostic.span.start as usize);
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Hint => "hint",
    };
    Finding {
        severity: severity.to_string(),
        code: diagnostic.code.name().to_string(),
        message: diagnostic.message.clone(),
        help: diagnostic.help.clone(),
        file: source.name.clone(),
        line: place.line,
        column: place.column,
    }
}

pub fn files(program: &Program) -> Vec<File> {
    program.sources.iter().map(|source| File { name: source.name.clone(), text: source.text.clone() }).collect()
}
