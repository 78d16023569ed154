//! Points, segments and poses on the floor, in metres and radians, x to the right and y up. Knows nothing of worlds or robots.

use std::f64::consts::{PI, TAU};
use std::ops::{Add, Mul, Sub};

/// A place on the floor, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
}

impl Point {
    pub(crate) fn new(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    /// The point at distance 1 from the origin in the direction `angle`.
    pub(crate) fn toward(angle: f64) -> Point {
        Point::new(angle.cos(), angle.sin())
    }

    pub(crate) fn dot(self, other: Point) -> f64 {
        self.x * other.x + self.y * other.y
    }

    fn cross(self, other: Point) -> f64 {
        self.x * other.y - self.y * other.x
    }

    pub(crate) fn length(self) -> f64 {
        self.x.hypot(self.y)
    }

    pub(crate) fn distance(self, other: Point) -> f64 {
        (self - other).length()
    }
}

impl Add for Point {
    type Output = Point;
    fn add(self, other: Point) -> Point {
        Point::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Point {
    type Output = Point;
    fn sub(self, other: Point) -> Point {
        Point::new(self.x - other.x, self.y - other.y)
    }
}

impl Mul<f64> for Point {
    type Output = Point;
    fn mul(self, factor: f64) -> Point {
        Point::new(self.x * factor, self.y * factor)
    }
}

/// A straight piece between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    pub from: Point,
    pub to: Point,
}

impl Segment {
    pub(crate) fn length(self) -> f64 {
        self.from.distance(self.to)
    }

    /// The point of the segment that is closest to `point`.
    pub(crate) fn nearest(self, point: Point) -> Point {
        let along = self.to - self.from;
        let square = along.dot(along);
        if square == 0.0 {
            return self.from;
        }
        let share = (point - self.from).dot(along) / square;
        self.from + along * share.clamp(0.0, 1.0)
    }

    /// How far from `origin` a ray in the direction `angle` meets the segment, if it does.
    pub(crate) fn met_by_ray(self, origin: Point, angle: f64) -> Option<f64> {
        let ray = Point::toward(angle);
        let along = self.to - self.from;
        let across = ray.cross(along);
        if across == 0.0 {
            return None;
        }
        let offset = self.from - origin;
        let distance = offset.cross(along) / across;
        let share = offset.cross(ray) / across;
        (distance >= 0.0 && (0.0..=1.0).contains(&share)).then_some(distance)
    }
}

/// A place and a heading: m, and rad counter-clockwise from the x axis, more than -π and at most π.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    pub x: f64,
    pub y: f64,
    pub theta: f64,
}

impl Pose {
    pub(crate) fn place(self) -> Point {
        Point::new(self.x, self.y)
    }

    /// The point `ahead` of the pose and to its `left`, m.
    pub(crate) fn offset(self, ahead: f64, left: f64) -> Point {
        let forward = Point::toward(self.theta);
        let leftward = Point::new(-forward.y, forward.x);
        self.place() + forward * ahead + leftward * left
    }
}

/// The same direction as `angle`, more than -π and at most π.
pub(crate) fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}
