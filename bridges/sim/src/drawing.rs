//! The lines of a world as its statements draw them, and what can go wrong with that. Knows nothing of walls or of the robot.

use crate::build::SLACK;
use crate::fault::{Fault, Place};
use crate::form::Word;
use crate::geometry::Point;
use crate::path::{Pen, Side};
use crate::reader::Statement;
use crate::world::{Line, Size};

const MOST_POINTS: usize = 20_000;

/// The lines drawn so far and the one being drawn.
pub(crate) struct Lines {
    size: Option<Size>,
    drawing: Option<Drawing>,
    drawn: Vec<Line>,
    points: usize,
}

/// A line being drawn: it has a pen once its `from` was read.
struct Drawing {
    place: Place,
    width: f64,
    brightness: f64,
    pen: Option<Pen>,
    /// The line has a fault already; what follows from it is not worth another one.
    spoilt: bool,
}

impl Lines {
    /// No lines yet, on a floor of this size where it is known.
    pub fn on(size: Option<Size>) -> Lines {
        Lines { size, drawing: None, drawn: Vec::new(), points: 0 }
    }

    pub fn begin(&mut self, statement: &Statement, faults: &mut Vec<Fault>) {
        self.end(faults);
        let [width, brightness] = [statement.numbers[0].value, statement.numbers[1].value];
        self.drawing = Some(Drawing { place: statement.place, width, brightness, pen: None, spoilt: false });
    }

    pub fn put_pen(&mut self, statement: &Statement, at: Point, faults: &mut Vec<Fault>) {
        let heading = statement.numbers[2].value.to_radians();
        match &mut self.drawing {
            None if faulty_within(faults, 0, statement.place.line) => {}
            None => {
                let fault = statement.place.fault("`from` must stand after a `line`");
                faults.push(fault.with_help("put a line `line width 0.06` before it"));
            }
            Some(drawing) if drawing.pen.is_some() => {
                let fault = statement.place.fault("this line has a `from` already");
                faults.push(fault.with_help("begin another line with `line`"));
            }
            Some(drawing) => drawing.pen = Some(Pen::new(at, heading)),
        }
    }

    pub fn draw(&mut self, statement: &Statement, faults: &mut Vec<Fault>) {
        let Some(Drawing { pen: Some(pen), spoilt, .. }) = &mut self.drawing else {
            return self.draw_without_pen(statement, faults);
        };
        if *spoilt {
            return;
        }
        let before = pen.points().len();
        add_piece(pen, statement);
        let added = &pen.points()[before..];
        self.points += added.len();
        let message = match off_floor(added, self.size) {
            Some(out) => format!("the line leaves the floor here, at {:.2} {:.2}", out.x, out.y),
            None if self.points > MOST_POINTS => "the lines have too many pieces".to_owned(),
            None => return,
        };
        *spoilt = true;
        faults.push(statement.place.fault(message).with_help("make the floor larger, or the line shorter"));
    }

    fn draw_without_pen(&mut self, statement: &Statement, faults: &mut Vec<Fault>) {
        let since = self.drawing.as_ref().map_or(0, |drawing| drawing.place.line);
        let help = match &mut self.drawing {
            Some(drawing) if drawing.spoilt => return,
            Some(drawing) => {
                drawing.spoilt = true;
                "say where the line begins: `from X Y heading DEGREES`"
            }
            None => "begin with `line width 0.06`, then `from X Y heading DEGREES`",
        };
        if !faulty_within(faults, since, statement.place.line) {
            let message = format!("nothing to draw `{}` with", statement.name);
            faults.push(statement.place.fault(message).with_help(help));
        }
    }

    pub fn end(&mut self, faults: &mut Vec<Fault>) {
        let Some(drawing) = self.drawing.take() else {
            return;
        };
        let points = drawing.pen.map(Pen::into_points).unwrap_or_default();
        if points.len() >= 2 {
            self.drawn.push(Line { width: drawing.width, brightness: drawing.brightness, points });
        } else if !drawing.spoilt && !faulty_within(faults, drawing.place.line, usize::MAX) {
            let help = "after `line` comes `from X Y heading DEGREES`, then `straight`, `left`, `right` or `to`";
            faults.push(drawing.place.fault("the line has no pieces").with_help(help));
        }
    }

    pub fn into_drawn(self) -> Vec<Line> {
        self.drawn
    }
}

fn add_piece(pen: &mut Pen, statement: &Statement) {
    let n = &statement.numbers;
    match statement.word {
        Word::To => pen.to(Point::new(n[0].value, n[1].value)),
        Word::Left => pen.bend(Side::Left, n[0].value.to_radians(), n[1].value),
        Word::Right => pen.bend(Side::Right, n[0].value.to_radians(), n[1].value),
        _ => pen.straight(n[0].value),
    }
}

/// Whether a line of text after `since` and before `until` has a fault: what is missing may have been meant there.
fn faulty_within(faults: &[Fault], since: usize, until: usize) -> bool {
    faults.iter().any(|fault| fault.line > since && fault.line < until)
}

fn off_floor(points: &[Point], size: Option<Size>) -> Option<Point> {
    let size = size?;
    let inside = |value: f64, most: f64| (-SLACK..=most + SLACK).contains(&value);
    points.iter().copied().find(|point| !inside(point.x, size.width) || !inside(point.y, size.height))
}
