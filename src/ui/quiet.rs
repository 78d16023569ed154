//! Where ratatui draws to: one write for each frame that changed something, none for others. Knows nothing of what is
//! drawn, and never asks the terminal a question.

use std::io::{self, Write};

use crossterm::terminal::window_size;
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::encoder::Encoder;

/// Assumed where the terminal doesn't tell its size.
const USUAL: Size = Size { width: 80, height: 24 };

pub struct Quiet<W: Write> {
    out: W,
    /// What was never flushed is never sent: half a frame must not follow a panic onto the restored terminal.
    encoder: Encoder,
    /// None where not known.
    cursor: Option<Cursor>,
    /// Where a cursor that is shown stands.
    position: Option<Position>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Cursor {
    Shown,
    Hidden,
}

/// Of the terminal.
pub fn size() -> io::Result<Size> {
    let seen = window_size()?;
    let size = Size { width: seen.columns, height: seen.rows };
    Ok(if size.area() == 0 { USUAL } else { size })
}

impl<W: Write> Quiet<W> {
    /// `size`: of the terminal at the beginning.
    pub fn new(out: W, size: Size) -> Self {
        Quiet { out, encoder: Encoder::new(size), cursor: None, position: None }
    }

    /// To be called when someone else has written to the terminal.
    pub fn forget(&mut self) {
        self.cursor = None;
        self.position = None;
        self.encoder.forget();
    }

    fn set_cursor(&mut self, cursor: Cursor) {
        if self.cursor.replace(cursor) != Some(cursor) {
            self.encoder.say(match cursor {
                Cursor::Shown => "\x1b[?25h",
                Cursor::Hidden => "\x1b[?25l",
            });
        }
    }
}

impl<W: Write> Backend for Quiet<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        content.for_each(|(x, y, cell)| self.encoder.cell(x, y, cell));
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.set_cursor(Cursor::Hidden);
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.set_cursor(Cursor::Shown);
        Ok(())
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.position.unwrap_or_default())
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        let position = position.into();
        self.position = Some(position);
        self.encoder.go_to(position);
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    /// Always all of it: nothing else is on this screen.
    fn clear_region(&mut self, _: ClearType) -> io::Result<()> {
        let size = self.size()?;
        self.encoder.clear(size);
        Ok(())
    }

    fn size(&self) -> io::Result<Size> {
        size()
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        let seen = window_size()?;
        Ok(WindowSize { columns_rows: size()?, pixels: Size { width: seen.width, height: seen.height } })
    }

    fn flush(&mut self) -> io::Result<()> {
        let frame = self.encoder.take();
        if frame.is_empty() {
            return Ok(());
        }
        self.out.write_all(frame.as_bytes())?;
        self.out.flush()
    }
}
