//! Every character on the screen that isn't ASCII, and what stands for it where a terminal has no others.
//! A machine's drawing has characters of its own, see `graph::Glyphs`.

use ratatui::buffer::{Buffer, Cell};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Charset {
    #[default]
    Unicode,
    Ascii,
}

macro_rules! table {
    ($($name:ident $glyph:literal $twin:literal;)*) => {
        $(pub const $name: &str = $glyph;)*
        const TWINS: &[(&str, &str)] = &[$(($glyph, $twin)),*];
    };
}

table! {
    RULE "─" "-";
    UPRIGHT "│" "|";
    MEETS_BELOW "┬" "+";
    MEETS_ABOVE "┴" "+";
    MEETS_ALL "┼" "+";
    MEETS_LEFT "┤" "+";
    MEETS_RIGHT "├" "+";
    TOP_LEFT "┌" "+";
    TOP_RIGHT "┐" "+";
    BOTTOM_LEFT "└" "+";
    BOTTOM_RIGHT "┘" "+";
    HERE "▸" ">";
    ACTIVE "●" "*";
    BREAK "◆" "@";
    BREAK_IN_TEXT "◇" "%";
    CROSS "✗" "x";
    DOT "·" "-";
    TIMES "×" "x";
    DASH "–" "-";
    ELLIPSIS "…" "~";
    DEGREES "°" "d";
    FULL "▮" "#";
    EMPTY "▯" ".";
    RIGHT "→" ">";
    LEFT "←" "<";
    UP "↑" "^";
    DOWN "↓" "v";
    UP_RIGHT "↗" "/";
    UP_LEFT "↖" "\\";
    DOWN_LEFT "↙" "/";
    DOWN_RIGHT "↘" "\\";
    BAR_1 "▁" "_";
    BAR_2 "▂" ".";
    BAR_3 "▃" "-";
    BAR_4 "▄" "=";
    BAR_5 "▅" "+";
    BAR_6 "▆" "*";
    BAR_7 "▇" "%";
    BAR_8 "█" "#";
}

/// From the lowest to a whole cell.
pub const BARS: [&str; 8] = [BAR_1, BAR_2, BAR_3, BAR_4, BAR_5, BAR_6, BAR_7, BAR_8];

/// Anticlockwise from the right.
pub const ARROWS: [&str; 8] = [RIGHT, UP_RIGHT, UP, UP_LEFT, LEFT, DOWN_LEFT, DOWN, DOWN_RIGHT];

/// The first of the characters that have a dot for each bit.
const BRAILLE: u32 = 0x2800;

/// A cell of two by four dots.
pub fn dots(bits: u8) -> char {
    char::from_u32(BRAILLE + u32::from(bits)).unwrap_or(' ')
}

impl Charset {
    /// Leaves in a frame what the terminal can show. What has no twin, in a program's own names, becomes `?`.
    pub fn lay_over(self, buffer: &mut Buffer) {
        if self == Charset::Ascii {
            buffer.content.iter_mut().filter(|cell| !cell.symbol().is_ascii()).for_each(spell);
        }
    }
}

fn spell(cell: &mut Cell) {
    let symbol = cell.symbol();
    let twin = TWINS.iter().find(|(glyph, _)| *glyph == symbol).map(|(_, twin)| *twin);
    let bits = symbol.chars().next().and_then(|c| u8::try_from(u32::from(c).checked_sub(BRAILLE)?).ok());
    let twin = twin.or_else(|| bits.map(spelt_dots)).unwrap_or("?");
    cell.set_symbol(twin);
}

/// What looks most like them.
fn spelt_dots(bits: u8) -> &'static str {
    const LEFT: u8 = 0b0100_0111;
    const TOP: u8 = 0b0001_1011;
    const MIDDLE: u8 = 0b0011_0110;
    let within = |mask: u8| bits & !mask == 0;
    match bits.count_ones() {
        0 => " ",
        6.. => "#",
        3.. if within(LEFT) || within(!LEFT) => "|",
        _ if within(TOP) => "'",
        _ if within(MIDDLE) => "-",
        _ if within(!TOP) => ".",
        _ => ":",
    }
}
