//! The mouse in a terminal, which is told of it or keeps it to itself.

use super::User;
use crate::terminal::tells_of_mouse;

impl User {
    /// As a terminal tells of the mouse: the button, and whether it goes down or up, at the first cell of a text.
    fn mouse(&mut self, button: u16, text: &str) {
        let found = std::cell::Cell::new(None);
        self.pty.wait_for(text, |screen| {
            found.set(find(screen, text));
            found.get().is_some()
        });
        let (column, row) = found.get().expect("a cell");
        self.pty.type_in(&format!("\x1b[<{button};{column};{row}M\x1b[<{button};{column};{row}m"));
    }
}

/// A cell that was never written to is blank as well.
fn glyph(cell: &vt100::Cell) -> &str {
    if cell.has_contents() { cell.contents() } else { " " }
}

/// The column and row, from 1, where a text begins.
fn find(screen: &vt100::Screen, text: &str) -> Option<(u16, u16)> {
    let (rows, columns) = screen.size();
    let length = text.chars().count() as u16;
    let cells = |row, column| (column..column + length).filter_map(move |column| screen.cell(row, column)).map(glyph);
    let places = (0..rows).flat_map(|row| (0..columns.saturating_sub(length)).map(move |column| (row, column)));
    let found = places.into_iter().find(|&(row, column)| cells(row, column).collect::<String>() == text);
    found.map(|(row, column)| (column + 1, row + 1))
}

const LEFT: u16 = 0;
const RIGHT: u16 = 2;
const WHEEL_DOWN: u16 = 65;

#[test]
fn the_mouse_works_in_a_terminal() {
    let mut user = User::new();
    user.pty.wait_for("the mouse", |screen| {
        tells_of_mouse(screen) && screen.mouse_protocol_encoding() == vt100::MouseProtocolEncoding::Sgr
    });
    user.pty.resize(120, 40);
    user.sees(&["source  line_follower.lrp"]);
    user.mouse(LEFT, "bumpturn");
    user.sees(&["▸  bumpturn"]);
    user.mouse(RIGHT, "  bumpturn");
    user.sees(&["┌─ bumpturn", "go to the selected state"]);
    user.mouse(LEFT, "go to the selected state");
    user.traced("a state", |record| record["kind"] == "force" && record["state"] == "follower/bumpturn");
    user.mouse(WHEEL_DOWN, "source  line_follower.lrp");
    user.mouse(LEFT, "lightlim   ");
    user.sees(&["▸ lightlim"]);
    user.mouse(LEFT, "space pause");
    user.sees(&["PAUSED"]);
    user.mouse(LEFT, "STOP");
    user.traced("the stop", |record| record["kind"] == "stop" && record["reason"] == "runstop");
    user.pty.type_in("T");
    user.pty.wait_for("the terminal's own mouse", |screen| !tells_of_mouse(screen));
    user.pty.type_in("T");
    user.pty.wait_for("the mouse again", tells_of_mouse);
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn the_mouse_can_be_left_to_the_terminal() {
    let mut user = User::start(&[], &["--no-mouse"]);
    user.pty.wait_for("no mouse", |screen| !tells_of_mouse(screen));
    user.pty.type_in("\x0c");
    user.sees(&["machines"]);
    user.pty.wait_for("no mouse", |screen| !tells_of_mouse(screen));
    user.pty.type_in("q");
    user.ends(0);
}
