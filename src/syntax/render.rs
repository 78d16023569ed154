//! Diagnostics as text, in the form of a compiler's. Prints nothing itself.

use annotate_snippets::{AnnotationKind, Element, Group, Level, Renderer, Snippet};

use super::diagnostic::{Diagnostic, Severity};
use super::source::{FileId, Source, Span};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Plain,
    Colour,
}

/// Columns that a rendered line may take; what is longer is cut around the place that matters.
const WIDTH: usize = 100;

/// Each diagnostic with its lines of the program, in the order of the program. `sources` is indexed by `FileId`.
pub fn render(diagnostics: &[Diagnostic], sources: &[Source], style: Style) -> String {
    let renderer = match style {
        Style::Plain => Renderer::plain(),
        Style::Colour => Renderer::styled(),
    }
    .term_width(WIDTH);
    let mut sorted: Vec<&Diagnostic> = diagnostics.iter().collect();
    sorted.sort_by_key(|diagnostic| diagnostic.span);
    let mut out = String::new();
    for diagnostic in sorted {
        out.push_str(&renderer.render(&[report(diagnostic, sources)]));
        out.push_str("\n\n");
    }
    out
}

/// `file:3:7: error: message`
pub fn one_line(diagnostic: &Diagnostic, sources: &[Source]) -> String {
    let severity = name(diagnostic.severity);
    match sources.get(diagnostic.span.file.0 as usize) {
        Some(source) => {
            let at = source.position(diagnostic.span.start as usize);
            format!(
                "{}:{}:{}: {severity}: {}",
                source.name, at.line, at.column, diagnostic.message
            )
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
    let title = level
        .primary_title(diagnostic.message.as_str())
        .id(diagnostic.code.name());
    let mut elements: Vec<Element> = Vec::new();
    for file in files(diagnostic) {
        if let Some(source) = sources.get(file.0 as usize) {
            elements.push(excerpt(diagnostic, file, source).into());
        }
    }
    if let Some(help) = &diagnostic.help {
        elements.push(Level::HELP.message(help.as_str()).into());
    }
    title.elements(elements)
}

/// The files a diagnostic points into, its own first.
fn files(diagnostic: &Diagnostic) -> Vec<FileId> {
    let mut files = vec![diagnostic.span.file];
    for (span, _) in &diagnostic.also {
        if !files.contains(&span.file) {
            files.push(span.file);
        }
    }
    files
}

/// The lines of one file that a diagnostic points into, with its marks.
fn excerpt<'a>(
    diagnostic: &'a Diagnostic,
    file: FileId,
    source: &'a Source,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let also = diagnostic.also.iter().filter(|(span, _)| span.file == file);
    let marks = (diagnostic.span.file == file)
        .then_some(diagnostic.span)
        .into_iter()
        .chain(also.clone().map(|(span, _)| *span));
    let lines: Vec<usize> = marks.map(|span| source.line(span.start as usize)).collect();
    let first = lines.iter().copied().min().unwrap_or(1);
    let last = lines.iter().copied().max().unwrap_or(1);
    let window = Window::new(source, first, last);
    let mut snippet = Snippet::source(window.text.clone())
        .path(&*source.name)
        .line_start(first)
        .fold(true);
    if diagnostic.span.file == file {
        snippet =
            snippet.annotation(AnnotationKind::Primary.span(window.place(source, diagnostic.span)));
    }
    for (span, what) in also {
        snippet = snippet.annotation(
            AnnotationKind::Context
                .span(window.place(source, *span))
                .label(what.as_str()),
        );
    }
    snippet
}

/// Whole lines of a text, with a line feed after each whatever ended it in the text.
struct Window {
    text: String,
    start: usize,
}

impl Window {
    fn new(source: &Source, first: usize, last: usize) -> Self {
        let bom = if first == 1 && source.text.starts_with('\u{feff}') {
            '\u{feff}'.len_utf8()
        } else {
            0
        };
        let start = source.line_range(first).start + bom;
        let end = source.line_range(last).end;
        // A carriage return becomes one character as well, so that places stay the same.
        let text = source.text[start..end.max(start)]
            .replace("\r\n", " \n")
            .replace('\r', "\n");
        Window { text, start }
    }

    /// A span's place in the window, cut off where its first line ends.
    fn place(&self, source: &Source, span: Span) -> std::ops::Range<usize> {
        let line = source.line_range(source.line(span.start as usize));
        let start = (span.start as usize)
            .min(line.end)
            .saturating_sub(self.start);
        let end = (span.end as usize).min(line.end).saturating_sub(self.start);
        start.min(self.text.len())..end.clamp(start, self.text.len().max(start))
    }
}
