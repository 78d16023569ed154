//! Indentation: in which column a line begins. Knows nothing of what the line says.

/// Columns from one tab stop to the next. Columns are only compared, never shown.
const TAB: usize = 4;

/// The zero-based column of `at` where only blanks stand before it in its line. Looks no further back than `from`.
pub fn column(text: &str, from: usize, at: usize) -> Option<usize> {
    let line_start = from + text[from..at].trim_end_matches([' ', '\t']).len();
    let begins_line = line_start == 0 || text[..line_start].ends_with(['\n', '\r', '\u{feff}']);
    begins_line.then(|| width(&text[line_start..at]))
}

fn width(blanks: &str) -> usize {
    blanks.bytes().fold(0, |column, byte| if byte == b'\t' { (column / TAB + 1) * TAB } else { column + 1 })
}
