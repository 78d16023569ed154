//! The characters a drawing is made of. Knows nothing of places.

use super::EdgeKind;

/// The set of characters for boxes, lines and heads. Names and labels stay as the program has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Glyphs {
    #[default]
    Unicode,
    Ascii,
}

/// Which way a line goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Left,
    Right,
    Up,
    Down,
}

impl Way {
    pub fn is_across(self) -> bool {
        matches!(self, Way::Left | Way::Right)
    }
}

impl Glyphs {
    /// Columns kept free on both sides of a label that stands in its line.
    pub fn label_padding(self) -> usize {
        match self {
            Glyphs::Unicode => 0,
            // Names may hold dashes, which only a space tells from the line.
            Glyphs::Ascii => 1,
        }
    }

    /// Whether in a name or label `c` would pass for a part of the drawing.
    pub fn draws(self, c: char) -> bool {
        self == Glyphs::Unicode
            && matches!(
                c,
                '\u{2500}'
                    ..='\u{259f}' | '▸' | '○' | '►' | '◄' | '▲' | '▼' | '▷' | '◁' | '△' | '▽' | '⇡' | '⇣'
            )
    }

    pub fn ellipsis(self) -> char {
        match self {
            Glyphs::Unicode => '…',
            Glyphs::Ascii => '~',
        }
    }

    /// The left and the right border of a box.
    pub fn borders(self) -> (char, char) {
        match self {
            Glyphs::Unicode => ('▌', '▐'),
            Glyphs::Ascii => ('[', ']'),
        }
    }

    /// Stands beside the name of a state that has a nested machine.
    pub fn nested(self) -> char {
        match self {
            Glyphs::Unicode => '▸',
            Glyphs::Ascii => '>',
        }
    }

    /// A straight piece of an edge. Dots for eps and dashes for ontime tell the kinds apart without colour.
    pub fn line(self, kind: EdgeKind, way: Way) -> char {
        let (across, down) = match (self, kind) {
            (Glyphs::Unicode, EdgeKind::Eps) => ('┄', '┆'),
            (Glyphs::Unicode, EdgeKind::Ontime) => ('╌', '╎'),
            (Glyphs::Unicode, _) => ('─', '│'),
            (Glyphs::Ascii, EdgeKind::Eps) => ('~', ':'),
            (Glyphs::Ascii, EdgeKind::Ontime) => ('=', '|'),
            (Glyphs::Ascii, _) => ('-', '|'),
        };
        if way.is_across() { across } else { down }
    }

    /// Where an edge leaves its box: an exit has a circle there, as an exit point has in UML.
    pub fn tail(self, kind: EdgeKind, way: Way) -> char {
        match (self, kind) {
            (Glyphs::Unicode, EdgeKind::Exit) => '○',
            (Glyphs::Ascii, EdgeKind::Exit) => 'o',
            _ => self.line(kind, way),
        }
    }

    /// An arrow head; hollow for eps. In a gap it stands for the whole line, so there it is dashed for ontime.
    pub fn head(self, kind: EdgeKind, way: Way) -> char {
        let [left, right, up, down] = match (self, kind) {
            (Glyphs::Unicode, EdgeKind::Eps) => ['◁', '▷', '△', '▽'],
            (Glyphs::Unicode, EdgeKind::Ontime) => ['◄', '►', '⇡', '⇣'],
            (Glyphs::Unicode, _) => ['◄', '►', '▲', '▼'],
            (Glyphs::Ascii, _) => ['<', '>', '^', 'v'],
        };
        match way {
            Way::Left => left,
            Way::Right => right,
            Way::Up => up,
            Way::Down => down,
        }
    }

    /// Where a line that went `before` goes `after`, across then up or down or the other way round.
    pub fn corner(self, before: Way, after: Way) -> char {
        let (across, upright) = if before.is_across() { (before, after) } else { (after, before) };
        // A corner joins two sides of its cell; the first way is walked towards the cell, the second away from it.
        let joins_left = (across == Way::Right) == before.is_across();
        let joins_top = (upright == Way::Down) != before.is_across();
        match (self, joins_left, joins_top) {
            (Glyphs::Unicode, true, true) => '┘',
            (Glyphs::Unicode, true, false) => '┐',
            (Glyphs::Unicode, false, true) => '└',
            (Glyphs::Unicode, false, false) => '┌',
            (Glyphs::Ascii, _, true) => '\'',
            (Glyphs::Ascii, _, false) => '.',
        }
    }

    /// Two lines that both go straight on.
    pub fn crossing(self) -> char {
        match self {
            Glyphs::Unicode => '┼',
            Glyphs::Ascii => '+',
        }
    }
}

/// A glyph of a line in its heavy form; itself if it has none.
pub fn heavy(glyph: char) -> char {
    const PAIRS: [(char, char); 11] = [
        ('─', '━'),
        ('│', '┃'),
        ('┄', '┅'),
        ('┆', '┇'),
        ('╌', '╍'),
        ('╎', '╏'),
        ('┌', '┏'),
        ('┐', '┓'),
        ('└', '┗'),
        ('┘', '┛'),
        ('○', '●'),
    ];
    let pair = PAIRS.iter().find(|(light, _)| *light == glyph);
    pair.map_or(glyph, |(_, heavy)| *heavy)
}

/// A crossing whose line across is heavy.
pub fn heavy_across(glyph: char) -> char {
    if glyph == '┼' { '┿' } else { glyph }
}

/// A crossing whose line up and down is heavy.
pub fn heavy_down(glyph: char) -> char {
    if glyph == '┼' { '╂' } else { glyph }
}
