//! Where ratatui draws to: one write for each frame that changed something, none for others. Knows nothing of what is
//! drawn, and never asks the terminal a question.

use std::io::{self, Write};

use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::queue;
use crossterm::terminal::window_size;
use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

/// Assumed where the terminal doesn't tell its size.
const USUAL: Size = Size { width: 80, height: 24 };

pub struct Quiet<W: Write> {
    inner: CrosstermBackend<Pending<W>>,
    /// None where not known.
    cursor: Option<Cursor>,
    position: Option<Position>,
    unsent: Unsent,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Cursor {
    Shown,
    Hidden,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Unsent {
    Nothing,
    Something,
}

impl<W: Write> Quiet<W> {
    pub fn new(out: W) -> Self {
        let inner = CrosstermBackend::new(Pending { bytes: Vec::new(), out });
        Quiet { inner, cursor: None, position: None, unsent: Unsent::Nothing }
    }

    /// To be called when someone else has written to the terminal.
    pub fn forget(&mut self) {
        self.cursor = None;
        self.position = None;
    }

    fn set_cursor(&mut self, cursor: Cursor) -> io::Result<()> {
        if self.cursor == Some(cursor) {
            return Ok(());
        }
        self.cursor = Some(cursor);
        self.unsent = Unsent::Something;
        match cursor {
            Cursor::Shown => queue!(self.inner, Show),
            Cursor::Hidden => queue!(self.inner, Hide),
        }
    }
}

impl<W: Write> Backend for Quiet<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let mut content = content.peekable();
        if content.peek().is_none() {
            return Ok(());
        }
        self.position = None;
        self.unsent = Unsent::Something;
        self.inner.draw(content)
    }

    fn append_lines(&mut self, lines: u16) -> io::Result<()> {
        self.position = None;
        self.inner.append_lines(lines)
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.set_cursor(Cursor::Hidden)
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.set_cursor(Cursor::Shown)
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.position.unwrap_or_default())
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        let position = position.into();
        if self.position == Some(position) {
            return Ok(());
        }
        self.position = Some(position);
        self.unsent = Unsent::Something;
        queue!(self.inner, MoveTo(position.x, position.y))
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, region: ClearType) -> io::Result<()> {
        self.inner.clear_region(region)
    }

    fn size(&self) -> io::Result<Size> {
        let seen = window_size()?;
        let size = Size { width: seen.columns, height: seen.rows };
        Ok(if size.area() == 0 { USUAL } else { size })
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        self.inner.window_size()
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.unsent == Unsent::Nothing {
            return Ok(());
        }
        self.unsent = Unsent::Nothing;
        Backend::flush(&mut self.inner)
    }
}

/// Bytes that wait for a flush. Unlike a `BufWriter` it drops what was never flushed: half a frame must not follow a
/// panic onto the restored terminal.
struct Pending<W> {
    bytes: Vec<u8>,
    out: W,
}

impl<W: Write> Write for Pending<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let sent = self.out.write_all(&self.bytes);
        self.bytes.clear();
        sent?;
        self.out.flush()
    }
}
