//! What a frame costs on the line.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

use lrp::ui::quiet::Quiet;
use ratatui::backend::Backend;
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

/// Each write that reached the terminal.
#[derive(Clone, Default)]
struct Line(Rc<RefCell<Vec<String>>>);

impl Write for Line {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().push(String::from_utf8_lossy(bytes).into());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Line {
    fn take(&self) -> Vec<String> {
        std::mem::take(&mut self.0.borrow_mut())
    }
}

/// One frame as ratatui makes it: cells that changed, the cursor, the end.
fn frame(quiet: &mut Quiet<Line>, cells: &[(u16, u16, &Cell)], cursor: Option<Position>) {
    quiet.draw(cells.iter().copied()).unwrap();
    match cursor {
        None => quiet.hide_cursor().unwrap(),
        Some(position) => {
            quiet.show_cursor().unwrap();
            quiet.set_cursor_position(position).unwrap();
        }
    }
    Backend::flush(quiet).unwrap();
}

#[test]
fn a_frame_is_one_write_and_an_unchanged_one_none() {
    let line = Line::default();
    let mut quiet = Quiet::new(line.clone(), Size::new(80, 24));
    let cell = Cell::new("x");
    frame(&mut quiet, &[(0, 0, &cell), (5, 2, &cell)], None);
    let written = line.take();
    assert_eq!(written.len(), 1);
    assert!(written[0].contains("\x1b[3;6Hx") && written[0].contains("\x1b[?25l"), "{written:?}");
    frame(&mut quiet, &[], None);
    frame(&mut quiet, &[], None);
    assert_eq!(line.take(), [""; 0]);
}

#[test]
fn the_cursor_is_moved_only_when_it_is_elsewhere() {
    let line = Line::default();
    let mut quiet = Quiet::new(line.clone(), Size::new(80, 24));
    let at = Some(Position { x: 3, y: 1 });
    frame(&mut quiet, &[], at);
    assert_eq!(line.take(), ["\x1b[?25h\x1b[2;4H"]);
    frame(&mut quiet, &[], at);
    assert_eq!(line.take(), [""; 0]);
    assert_eq!(quiet.get_cursor_position().unwrap(), Position { x: 3, y: 1 });
    frame(&mut quiet, &[(0, 0, &Cell::new("x"))], at);
    assert!(line.take()[0].ends_with("\x1b[2;4H"), "drawing has moved it");
    quiet.forget();
    frame(&mut quiet, &[], at);
    assert_eq!(line.take(), ["\x1b[?25h\x1b[2;4H"], "someone else may have moved it");
}

#[test]
fn half_a_frame_is_never_shown() {
    let line = Line::default();
    let mut quiet = Quiet::new(line.clone(), Size::new(80, 24));
    quiet.draw([(0, 0, &Cell::new("x"))].into_iter()).unwrap();
    drop(quiet);
    assert_eq!(line.take(), [""; 0]);
}
