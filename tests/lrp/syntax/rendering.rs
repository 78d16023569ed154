//! Diagnostics as text: places, severities, several files, odd lines.

use lrp::syntax::render::{Style, one_line, render};
use lrp::syntax::{Code, Diagnostic, FileId, Source, Span, parse};

fn source(text: &str) -> Source {
    Source::new("dir/a.lrp", text)
}

fn span(file: u16, start: usize, end: usize) -> Span {
    Span::new(FileId(file), start, end)
}

#[test]
fn one_line_says_where_and_what() {
    let text = "\u{feff}(machine été\r\n\t(state é 状)\r  (sate x))";
    let source = source(text);
    let lines: Vec<String> = parse(&source, FileId(0))
        .diagnostics
        .iter()
        .map(|diagnostic| one_line(diagnostic, std::slice::from_ref(&source)))
        .collect();
    assert_eq!(
        lines,
        [
            "dir/a.lrp:2:11: error: `状` can't stand by itself in a state",
            "dir/a.lrp:3:4: error: there is no form `sate`",
        ]
    );
}

#[test]
fn a_byte_order_mark_takes_no_column() {
    let source = source("\u{feff}(sate x)");
    let diagnostics = parse(&source, FileId(0)).diagnostics;
    let text = render(&diagnostics, std::slice::from_ref(&source), Style::Plain);
    assert!(text.contains("--> dir/a.lrp:1:2\n"), "{text}");
    assert!(one_line(&diagnostics[0], &[source]).starts_with("dir/a.lrp:1:2: error: "));
}

#[test]
fn several_diagnostics_come_in_the_order_of_the_program() {
    let sources = [source("(machine m)\n(spawn n s)\n"), Source::new("b.lrp", "(machine n)\n")];
    let diagnostics = [
        Diagnostic::hint(Code::UnusedEvent, span(1, 0, 1), "third"),
        Diagnostic::warning(Code::NoSpawn, span(0, 19, 20), "second").help("do this"),
        Diagnostic::error(Code::UnknownMachine, span(0, 12, 18), "first").also(span(1, 9, 10), "nearly this"),
    ];
    let expected = "\
error[unknown-machine]: first
 --> dir/a.lrp:2:1
  |
2 | (spawn n s)
  | ^^^^^^
  |
 ::: b.lrp:1:10
  |
1 | (machine n)
  |          - nearly this

warning[no-spawn]: second
 --> dir/a.lrp:2:8
  |
2 | (spawn n s)
  |        ^
  |
  = help: do this

hint[unused-event]: third
 --> b.lrp:1:1
  |
1 | (machine n)
  | ^
";
    assert_eq!(render(&diagnostics, &sources, Style::Plain), expected);
}

#[test]
fn colour_only_adds_escapes() {
    let source = source("(sate x)");
    let diagnostics = parse(&source, FileId(0)).diagnostics;
    let plain = render(&diagnostics, std::slice::from_ref(&source), Style::Plain);
    let colour = render(&diagnostics, &[source], Style::Colour);
    let mut stripped = String::new();
    for (i, part) in colour.split('\x1b').enumerate() {
        let text = if i == 0 { part } else { part.split_once('m').map_or("", |(_, text)| text) };
        stripped.push_str(text);
    }
    assert_ne!(plain, colour);
    assert_eq!(plain, stripped);
}

#[test]
fn every_kind_of_line_end_is_one() {
    for end in ["\n", "\r\n", "\r"] {
        let source = source(&format!("(machine m{end}  (state a){end}{end}  (sate b)){end}"));
        let diagnostics = parse(&source, FileId(0)).diagnostics;
        let text = render(&diagnostics, &[source], Style::Plain);
        assert!(text.contains("--> dir/a.lrp:4:4\n"), "{text}");
        assert!(text.contains("4 |   (sate b))"), "{text}");
        assert!(!text.contains('\r'), "{text}");
    }
}

#[test]
fn lines_stay_readable_however_long_they_are() {
    let filler = "(state a) ".repeat(1000);
    let texts = [
        format!("(machine m {filler}(sate b) {filler})"),
        format!("(machine m {filler}\n(spawn m a)\n"),
        format!("(machine m {filler}\n(spawn m a)\n{filler}"),
        format!("(machine m (on {} -> b))", "x".repeat(10_000)),
        format!("(machine m (ontime {} a -> b))", "9".repeat(10_000)),
        format!("(var {} := 5)", "é状.".repeat(3000)),
    ];
    for text in texts {
        let source = source(&text);
        let diagnostics = parse(&source, FileId(0)).diagnostics;
        assert!(!diagnostics.is_empty());
        let rendered = render(&diagnostics, &[source], Style::Plain);
        let longest = rendered.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        assert!(longest <= 200, "{longest}: {rendered}");
    }
}

#[test]
fn places_outside_of_every_text_are_shown_without_one() {
    let sources = [source("(machine m)")];
    let diagnostics = [
        Diagnostic::error(Code::Runtime, span(7, 3, 9), "elsewhere").help("look there"),
        Diagnostic::error(Code::Runtime, span(0, 11, 11), "at the end"),
        Diagnostic::error(Code::Runtime, span(0, 500, 600), "beyond the end"),
    ];
    let text = render(&diagnostics, &sources, Style::Plain);
    assert!(text.contains("error[runtime-error]: elsewhere\n"), "{text}");
    assert!(text.contains("--> dir/a.lrp:1:12\n"), "{text}");
    assert_eq!(one_line(&diagnostics[0], &sources), "error: elsewhere");
    assert_eq!(one_line(&diagnostics[1], &sources), "dir/a.lrp:1:12: error: at the end");
}
