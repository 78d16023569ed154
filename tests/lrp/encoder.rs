//! Whatever is drawn over whatever was there, a terminal shows it afterwards: frames at random, told to a terminal
//! emulator by the backend.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

use lrp::ui::quiet::Quiet;
use proptest::prelude::*;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Modifier, Style};
use ratatui::{Terminal, TerminalOptions, Viewport};
use unicode_width::UnicodeWidthStr;

const SIZE: Size = Size { width: 12, height: 4 };

#[derive(Clone)]
struct Emulator(Rc<RefCell<vt100::Parser>>);

impl Write for Emulator {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().process(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A word in a style at a place.
type Word = (u16, u16, &'static str, Style);

fn words() -> impl Strategy<Value = Vec<Word>> {
    let text =
        prop::sample::select(vec!["a", "b", " ", "  ", "abc", "a b", "─", "▌x▐", "日本", "é", "👍", "aaaaaaaaaaaa"]);
    let colour = prop::sample::select(vec![Color::Reset, Color::Red, Color::LightBlue, Color::Indexed(100)]);
    // To the emulator bold and dim are one scale.
    let weight = prop::sample::select(vec![Modifier::empty(), Modifier::BOLD, Modifier::DIM]);
    let others = vec![Modifier::REVERSED, Modifier::UNDERLINED, Modifier::ITALIC];
    let others = prop::sample::subsequence(others, 0..=3);
    let weight = (weight, others).prop_map(|(weight, others)| others.into_iter().fold(weight, Modifier::union));
    let style =
        (colour.clone(), colour, weight).prop_map(|(fg, bg, weight)| Style::reset().fg(fg).bg(bg).add_modifier(weight));
    // What becomes of half a wide glyph that another wide one covers is each terminal's own affair.
    let word = (0..SIZE.width, 0..SIZE.height, text, style);
    let word = word.prop_map(|(x, y, text, style)| (if "日本👍".contains(text) { x & !1 } else { x }, y, text, style));
    prop::collection::vec(word, 0..6)
}

#[derive(Debug, PartialEq)]
struct Seen {
    glyph: String,
    /// Colours and what else shows.
    style: String,
}

fn wanted(cell: &Cell) -> Seen {
    let on = |modifier| cell.modifier.contains(modifier);
    seen(
        cell.symbol(),
        (colour(cell.fg), colour(cell.bg)),
        [Modifier::BOLD, Modifier::DIM, Modifier::ITALIC, Modifier::UNDERLINED, Modifier::REVERSED].map(on),
    )
}

/// Of a blank only what can be seen; where it is reversed the colour of its glyphs can.
fn seen(glyph: &str, (fg, bg): (vt100::Color, vt100::Color), weight: [bool; 5]) -> Seen {
    let [bold, dim, italic, underlined, reversed] = weight;
    let glyph = if glyph.is_empty() { " " } else { glyph };
    let style = match (glyph, reversed) {
        (" ", false) => format!("{bg:?} {underlined}"),
        (" ", true) => format!("{fg:?} {bg:?} {underlined} {reversed}"),
        _ => format!("{fg:?} {bg:?} {bold} {dim} {italic} {underlined} {reversed}"),
    };
    Seen { glyph: glyph.to_owned(), style }
}

fn colour(colour: Color) -> vt100::Color {
    match colour {
        Color::Red => vt100::Color::Idx(1),
        Color::LightBlue => vt100::Color::Idx(12),
        Color::Indexed(index) => vt100::Color::Idx(index),
        _ => vt100::Color::Default,
    }
}

proptest! {
    #[test]
    fn a_terminal_shows_what_was_drawn(frames in prop::collection::vec(words(), 1..6)) {
        let emulator = Emulator(Rc::new(RefCell::new(vt100::Parser::new(SIZE.height, SIZE.width, 0))));
        let viewport = Viewport::Fixed(Rect::new(0, 0, SIZE.width, SIZE.height));
        let quiet = Quiet::new(emulator.clone(), SIZE);
        let mut terminal = Terminal::with_options(quiet, TerminalOptions { viewport }).unwrap();
        for words in &frames {
            let drawn = terminal.draw(|frame| {
                for &(x, y, text, style) in words {
                    frame.buffer_mut().set_stringn(x, y, text, usize::from(SIZE.width - x), style);
                }
            });
            compare(drawn.unwrap().buffer, emulator.0.borrow().screen())?;
        }
    }
}

fn compare(buffer: &Buffer, screen: &vt100::Screen) -> Result<(), TestCaseError> {
    for y in 0..SIZE.height {
        let mut x = 0;
        while x < SIZE.width {
            let cell = screen.cell(y, x).unwrap();
            let weight = [cell.bold(), cell.dim(), cell.italic(), cell.underline(), cell.inverse()];
            let shown = seen(cell.contents(), (cell.fgcolor(), cell.bgcolor()), weight);
            prop_assert_eq!(shown, wanted(&buffer[(x, y)]), "at {}, {}", x, y);
            x += buffer[(x, y)].symbol().width().max(1) as u16;
        }
    }
    Ok(())
}
