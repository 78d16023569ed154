//! Cells as few bytes: knows what the terminal shows, where its cursor is and which style is on, and says only what is
//! different. Knows nothing of who reads the bytes.

use std::fmt::Write;

use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};
use ratatui::style::{Color, Modifier};
use unicode_width::UnicodeWidthChar;

pub struct Encoder {
    out: String,
    size: Size,
    /// What the terminal shows, row by row, as far as it was drawn or cleared.
    shown: Vec<Option<Cell>>,
    /// None where it isn't known for sure.
    at: Option<Position>,
    style: Option<Style>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Style {
    fg: Color,
    bg: Color,
    modifier: Modifier,
}

const PLAIN: Style = Style { fg: Color::Reset, bg: Color::Reset, modifier: Modifier::empty() };
/// What shows where there is no glyph.
const ON_BLANKS: Modifier = Modifier::REVERSED.union(Modifier::UNDERLINED).union(Modifier::CROSSED_OUT);

impl Style {
    fn of(cell: &Cell) -> Style {
        Style { fg: cell.fg, bg: cell.bg, modifier: cell.modifier }
    }

    /// Whether a blank looks the same in both.
    fn is_like_on_blanks(self, other: Style) -> bool {
        let reversed = self.modifier.contains(Modifier::REVERSED);
        let seen = |style: Style| (style.bg, style.modifier & ON_BLANKS);
        seen(self) == seen(other) && (!reversed || self == other)
    }
}

impl Encoder {
    /// For a terminal of which only the size is known.
    pub fn new(size: Size) -> Encoder {
        Encoder { out: String::new(), size, shown: vec![None; size.area() as usize], at: None, style: None }
    }

    /// What is to be sent since it was asked last.
    pub fn take(&mut self) -> String {
        std::mem::take(&mut self.out)
    }

    /// Someone else has written to the terminal.
    pub fn forget(&mut self) {
        (self.at, self.style) = (None, None);
        self.shown.fill(None);
    }

    /// The terminal may have another size now.
    pub fn clear(&mut self, size: Size) {
        self.out.push_str("\x1b[0m\x1b[2J");
        self.style = Some(PLAIN);
        self.size = size;
        self.shown = vec![Some(Cell::EMPTY); size.area() as usize];
    }

    pub fn say(&mut self, sequence: &str) {
        self.out.push_str(sequence);
    }

    pub fn cell(&mut self, x: u16, y: u16, cell: &Cell) {
        let position = Position { x, y };
        if self.shown(position).is_some_and(|shown| looks_like(shown, cell)) {
            return;
        }
        let was_wide = self.shown(position).is_some_and(is_wide);
        self.go_to(position);
        if was_wide && !is_wide(cell) {
            // Its other half stays as it is in the frame, which is blank: nothing else would take it away.
            self.set(PLAIN);
            self.out.push_str("  ");
            self.at = None;
            self.go_to(position);
        }
        self.put(cell);
        if let Some(index) = self.index(position) {
            self.shown[index] = Some(cell.clone());
        }
        // What becomes of the other half of a wide glyph is each terminal's own affair.
        if was_wide || is_wide(cell) {
            let half = self.index(Position { x: x + 1, y });
            half.into_iter().for_each(|half| self.shown[half] = None);
        }
    }

    fn shown(&self, at: Position) -> Option<&Cell> {
        self.shown[self.index(at)?].as_ref()
    }

    fn index(&self, Position { x, y }: Position) -> Option<usize> {
        let Size { width, height } = self.size;
        (x < width && y < height).then(|| usize::from(y) * usize::from(width) + usize::from(x))
    }

    pub fn go_to(&mut self, to: Position) {
        let Some(from) = self.at.filter(|&from| from != to) else {
            if self.at.is_none() {
                self.out.push_str(&absolute(to));
                self.at = Some(to);
            }
            return;
        };
        let way = shortest(from, to);
        match self.between(from, to) {
            Some(cells) if cells.len() <= way.len() => self.out.push_str(&cells),
            _ => self.out.push_str(&way),
        }
        self.at = Some(to);
    }

    /// The glyphs from here to there as they are shown, where writing them again changes nothing.
    fn between(&self, from: Position, to: Position) -> Option<String> {
        if from.y != to.y || from.x > to.x || to.x - from.x > 8 {
            return None;
        }
        let style = self.style?;
        let mut glyphs = String::new();
        for x in from.x..to.x {
            let cell = self.shown(Position { x, ..from })?;
            let same = Style::of(cell) == style || (is_blank(cell) && style.is_like_on_blanks(Style::of(cell)));
            if !same || columns(cell) != Some(1) {
                return None;
            }
            glyphs.push_str(cell.symbol());
        }
        Some(glyphs)
    }

    fn put(&mut self, cell: &Cell) {
        let style = Style::of(cell);
        if !(is_blank(cell) && self.style.is_some_and(|now| now.is_like_on_blanks(style))) {
            self.set(style);
        }
        self.out.push_str(cell.symbol());
        // At the right edge terminals differ in where the cursor is; and they differ in how wide some glyphs are.
        self.at = self.at.zip(columns(cell)).and_then(|(at, columns)| {
            let next = at.x + columns;
            (columns == 1 && next < self.size.width).then_some(Position { x: next, ..at })
        });
    }

    fn set(&mut self, style: Style) {
        if self.style != Some(style) {
            self.out.push_str(&switch(self.style, style));
            self.style = Some(style);
        }
    }
}

fn is_blank(cell: &Cell) -> bool {
    cell.symbol() == " "
}

fn is_wide(cell: &Cell) -> bool {
    columns(cell) != Some(1)
}

fn looks_like(shown: &Cell, cell: &Cell) -> bool {
    let same_blank = is_blank(shown) && is_blank(cell) && Style::of(shown).is_like_on_blanks(Style::of(cell));
    shown == cell || same_blank
}

/// None where terminals might not agree.
fn columns(cell: &Cell) -> Option<u16> {
    let mut glyphs = cell.symbol().chars();
    let first = glyphs.next()?.width()?;
    glyphs.next().is_none().then_some(first as u16)
}

fn absolute(to: Position) -> String {
    match (to.x, to.y) {
        (0, y) => format!("\x1b[{}H", y + 1),
        (x, y) => format!("\x1b[{};{}H", y + 1, x + 1),
    }
}

fn shortest(from: Position, to: Position) -> String {
    let mut ways = vec![absolute(to)];
    if let Some(down) = to.y.checked_sub(from.y) {
        let down = if down == 0 { String::new() } else { steps(down, 'B') };
        let along = match to.x.checked_sub(from.x) {
            Some(0) => String::new(),
            Some(right) => steps(right, 'C'),
            None if from.x - to.x <= 4 => "\x08".repeat(usize::from(from.x - to.x)),
            None => steps(from.x - to.x, 'D'),
        };
        ways.push(along + &down);
    }
    ways.into_iter().min_by_key(String::len).unwrap_or_default()
}

fn steps(count: u16, direction: char) -> String {
    if count == 1 { format!("\x1b[{direction}") } else { format!("\x1b[{count}{direction}") }
}

/// From one style to another: what is different, or all of it where that is shorter.
fn switch(from: Option<Style>, to: Style) -> String {
    let whole = sequence(["".to_owned()].into_iter().chain(codes(PLAIN, to)));
    let Some(from) = from else { return whole };
    let less = from.modifier - to.modifier;
    let ends = OFF.iter().filter(|(ended, _)| less.intersects(*ended));
    // A code that ends two may end one that is to stay.
    let kept = ends.clone().fold(from.modifier, |kept, (ended, _)| kept - *ended);
    let off = ends.map(|(_, code)| (*code).to_owned());
    let different = sequence(off.chain(codes(Style { modifier: kept, ..from }, to)));
    if different.len() <= whole.len() { different } else { whole }
}

const ON: [(Modifier, &str); 9] = [
    (Modifier::BOLD, "1"),
    (Modifier::DIM, "2"),
    (Modifier::ITALIC, "3"),
    (Modifier::UNDERLINED, "4"),
    (Modifier::SLOW_BLINK, "5"),
    (Modifier::RAPID_BLINK, "6"),
    (Modifier::REVERSED, "7"),
    (Modifier::HIDDEN, "8"),
    (Modifier::CROSSED_OUT, "9"),
];
const OFF: [(Modifier, &str); 7] = [
    (Modifier::BOLD.union(Modifier::DIM), "22"),
    (Modifier::ITALIC, "23"),
    (Modifier::UNDERLINED, "24"),
    (Modifier::SLOW_BLINK.union(Modifier::RAPID_BLINK), "25"),
    (Modifier::REVERSED, "27"),
    (Modifier::HIDDEN, "28"),
    (Modifier::CROSSED_OUT, "29"),
];

/// What is on in the one and not in the other, and the colours that differ.
fn codes(from: Style, to: Style) -> impl Iterator<Item = String> {
    let more = to.modifier - from.modifier;
    let on = ON.iter().filter(move |(modifier, _)| more.intersects(*modifier)).map(|(_, code)| (*code).to_owned());
    let fg = (from.fg != to.fg).then(|| colour(to.fg, 0));
    let bg = (from.bg != to.bg).then(|| colour(to.bg, 10));
    on.chain(fg).chain(bg)
}

fn sequence(codes: impl Iterator<Item = String>) -> String {
    format!("\x1b[{}m", codes.collect::<Vec<_>>().join(";"))
}

/// The number that a terminal knows one of its own 16 colours by, as that of a glyph.
pub fn number(colour: Color) -> Option<u8> {
    Some(match colour {
        Color::Black => 30,
        Color::Red => 31,
        Color::Green => 32,
        Color::Yellow => 33,
        Color::Blue => 34,
        Color::Magenta => 35,
        Color::Cyan => 36,
        Color::Gray => 37,
        Color::DarkGray => 90,
        Color::LightRed => 91,
        Color::LightGreen => 92,
        Color::LightYellow => 93,
        Color::LightBlue => 94,
        Color::LightMagenta => 95,
        Color::LightCyan => 96,
        Color::White => 97,
        Color::Reset | Color::Rgb(..) | Color::Indexed(_) => return None,
    })
}

/// `ground`: 0 of a glyph, 10 of what is behind it.
fn colour(colour: Color, ground: u8) -> String {
    let mut code = String::new();
    let number = number(colour).unwrap_or(if colour == Color::Reset { 39 } else { 38 });
    let _ = write!(code, "{}", number + ground);
    match colour {
        Color::Indexed(index) => _ = write!(code, ";5;{index}"),
        Color::Rgb(r, g, b) => _ = write!(code, ";2;{r};{g};{b}"),
        _ => (),
    }
    code
}
