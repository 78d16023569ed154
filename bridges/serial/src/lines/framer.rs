//! Bytes to lines. A line ends with LF, CR or both; what is no text, or never ends, is told and left out.

/// Longer than any line that makes sense.
const LONGEST: usize = 4096;
/// What a person needs to see of bytes.
const SHOWN: usize = 24;

#[derive(Default)]
pub struct Framer {
    line: Vec<u8>,
    /// A line has ended: the next began where it should.
    has_ended: bool,
    /// The rest of a line that is left out.
    skips: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    Line(String),
    Garbage(String),
}

impl Framer {
    pub fn take(&mut self, bytes: &[u8]) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for &byte in bytes {
            match byte {
                b'\n' | b'\r' => pieces.extend(self.end()),
                _ if self.skips => {}
                _ if self.line.len() >= LONGEST => {
                    pieces.push(Piece::Garbage(format!("a line of more than {LONGEST} bytes can't be read")));
                    self.line.clear();
                    self.skips = true;
                }
                _ => self.line.push(byte),
            }
        }
        pieces
    }

    /// Leaves out a line whose beginning wasn't seen.
    pub fn forget_first(&mut self) {
        if !self.has_ended && !self.line.is_empty() {
            self.skips = true;
            self.line.clear();
        }
    }

    fn end(&mut self) -> Option<Piece> {
        let line = std::mem::take(&mut self.line);
        self.has_ended = true;
        if std::mem::take(&mut self.skips) || line.is_empty() {
            return None;
        }
        match std::str::from_utf8(&line) {
            Ok(text) if !text.chars().any(|c| c.is_control() && c != '\t') => {
                Some(text.trim()).filter(|text| !text.is_empty()).map(|text| Piece::Line(text.to_string()))
            }
            _ => Some(Piece::Garbage(format!("`{}` is no text: is `baud` wrong?", shown(&line)))),
        }
    }
}

fn shown(bytes: &[u8]) -> String {
    let start = bytes[..bytes.len().min(SHOWN)].escape_ascii().to_string();
    if bytes.len() > SHOWN { format!("{start}..") } else { start }
}
