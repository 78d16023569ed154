//! Programs with mistakes, one file each in tests/corpus/check, and what is said of them.

use lrp::session::compile::{Compiler, Rejected};
use lrp::syntax::Source;
use lrp::syntax::render::{Style, render};

use crate::runs::compare;
use crate::shelf::{Shelf, split};

#[test]
fn mistakes_are_explained() {
    compare("check", |text| {
        let (text, files) = split(text);
        let mut compiler = Compiler::new(Vec::new()).with_files(Shelf::of(files));
        let (verdict, sources, diagnostics) = match compiler.compile(Source::new("case.lrp", text)) {
            Ok(program) => ("it can run", program.sources, program.findings),
            Err(Rejected { sources, diagnostics }) => ("it can't run", sources, diagnostics),
        };
        format!("{verdict}\n\n{}", render(&diagnostics, &sources, Style::Plain))
    });
}
