//! Diagnostics as text, in the form of a compiler's. Prints nothing itself.

use annotate_snippets::{Annotation, AnnotationKind, Element, Group, Level, Renderer, Snippet};

use super::diagnostic::{Diagnostic, Severity};
use super::source::{Source, Span};
use super::window::Window;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Plain,
    Colour,
}

/// Bytes; of a longer line only a part is shown.
pub(super) const LONG_LINE: usize = 2 * WIDTH;

/// Columns that a rendered line may take; what is longer is cut around the place that matters.
const WIDTH: usize = 100;

/// Each diagnostic with its lines of the program, one after another with an empty line between, in the order of the program. `sources` is indexed by `FileId`.
pub fn render(diagnostics: &[Diagnostic], sources: &[Source], style: Style) -> String {
    let renderer = match style {
        Style::Plain => Renderer::plain(),
        Style::Colour => Renderer::styled(),
    }
    .term_width(WIDTH);
    let mut sorted: Vec<&Diagnostic> = diagnostics.iter().collect();
    sorted.sort_by_key(|diagnostic| diagnostic.span);
    let reports = sorted.iter().map(|diagnostic| renderer.render(&[report(diagnostic, sources)]) + "\n");
    reports.collect::<Vec<_>>().join("\n")
}

/// `file:3:7: error: message`
pub fn one_line(diagnostic: &Diagnostic, sources: &[Source]) -> String {
    let severity = name(diagnostic.severity);
    match sources.get(diagnostic.span.file.0 as usize) {
        Some(source) => {
            let at = source.position(diagnostic.span.start as usize);
            format!("{}:{}:{}: {severity}: {}", source.name, at.line, at.column, diagnostic.message)
        }
        None => format!("{severity}: {}", diagnostic.message),
    }
}

fn name(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Hint => "hint",
    }
}

fn report<'a>(diagnostic: &'a Diagnostic, sources: &'a [Source]) -> Group<'a> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Hint => Level::INFO.with_name("hint"),
    };
    let title = level.primary_title(diagnostic.message.as_str()).id(diagnostic.code.name());
    let mut elements: Vec<Element> = Vec::new();
    for marks in excerpts(diagnostic, sources) {
        if let Some(source) = sources.get(marks[0].span.file.0 as usize) {
            elements.push(excerpt(&marks, source).into());
        }
    }
    if let Some(help) = &diagnostic.help {
        elements.push(Level::HELP.message(help.as_str()).into());
    }
    title.elements(elements)
}

/// A place to point at, with what is said there; nothing at the diagnostic's own.
#[derive(Clone, Copy)]
pub(super) struct Mark<'a> {
    pub span: Span,
    pub label: Option<&'a str>,
}

/// The places a diagnostic points at, its own first, by what is shown together: all of one file, unless a line is too long for that.
fn excerpts<'a>(diagnostic: &'a Diagnostic, sources: &[Source]) -> Vec<Vec<Mark<'a>>> {
    let own = Mark { span: diagnostic.span, label: None };
    let also = diagnostic.also.iter().map(|(span, what)| Mark { span: *span, label: Some(what) });
    let mut excerpts: Vec<Vec<Mark>> = Vec::new();
    for mark in std::iter::once(own).chain(also) {
        let together = |marks: &&mut Vec<Mark>| {
            marks[0].span.file == mark.span.file && !is_long(marks[0].span, sources) && !is_long(mark.span, sources)
        };
        match excerpts.iter_mut().find(together) {
            Some(marks) => marks.push(mark),
            None => excerpts.push(vec![mark]),
        }
    }
    excerpts
}

/// Whether a place lies in a line that can only be shown in part.
fn is_long(span: Span, sources: &[Source]) -> bool {
    let source = sources.get(span.file.0 as usize);
    source.is_some_and(|source| source.line_range(source.line(span.start as usize)).len() > LONG_LINE)
}

/// The lines of one file that hold these marks.
fn excerpt<'a>(marks: &[Mark<'a>], source: &'a Source) -> Snippet<'a, Annotation<'a>> {
    let window = Window::new(source, marks);
    let annotations = marks.iter().map(|mark| {
        let place = window.place(source, mark.span);
        match mark.label {
            Some(label) => AnnotationKind::Context.span(place).label(label),
            None => AnnotationKind::Primary.span(place),
        }
    });
    let annotations: Vec<Annotation> = annotations.collect();
    Snippet::source(window.text).path(&*source.name).line_start(window.first).fold(true).annotations(annotations)
}
