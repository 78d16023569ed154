//! The pen that draws a line over the floor, like a turtle: straight on, bends to the left and right. Knows nothing of text.

use crate::geometry::{Point, wrapped};

/// How far the straight pieces of a bend may be from the true arc, m.
const SAGITTA: f64 = 0.000_1;

/// A pen on the floor with a heading, and what it has drawn.
#[derive(Debug)]
pub(crate) struct Pen {
    heading: f64,
    points: Vec<Point>,
}

/// Which way a bend goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Side {
    Left,
    Right,
}

impl Pen {
    pub fn new(at: Point, heading: f64) -> Pen {
        Pen { heading, points: vec![at] }
    }

    pub fn straight(&mut self, length: f64) {
        self.points.push(self.at() + Point::toward(self.heading) * length);
    }

    /// Straight to a point, heading on in that direction.
    pub fn to(&mut self, point: Point) {
        let way = point - self.at();
        if way.length() > 0.0 {
            self.heading = way.y.atan2(way.x);
            self.points.push(point);
        }
    }

    pub fn bend(&mut self, side: Side, angle: f64, radius: f64) {
        let turn = match side {
            Side::Left => angle,
            Side::Right => -angle,
        };
        // From the centre, the pen is a quarter turn to the other side of its heading.
        let start = self.heading - turn.signum() * std::f64::consts::FRAC_PI_2;
        let centre = self.at() - Point::toward(start) * radius;
        let largest = 2.0 * (1.0 - SAGITTA / radius).acos();
        let pieces = (angle / largest).ceil().max(1.0);
        for piece in 1..=pieces as usize {
            self.points.push(centre + Point::toward(start + turn * piece as f64 / pieces) * radius);
        }
        self.heading = wrapped(self.heading + turn);
    }

    /// Where the pen is now.
    pub fn at(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    pub fn points(&self) -> &[Point] {
        &self.points
    }

    pub fn into_points(self) -> Vec<Point> {
        self.points
    }
}
