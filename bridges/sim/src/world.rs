//! The world a robot drives in: floor, lines and walls. Immutable once read; knows nothing of the robot's motion.

use crate::build;
use crate::fault::Fault;
use crate::geometry::{Point, Pose, Segment};
use crate::robot;

/// A body this deep in a wall only touches it, m.
const TOUCH: f64 = 0.000_1;

/// A floor with lines painted on it, walls, and the place where the robot starts.
#[derive(Debug, Clone, PartialEq)]
pub struct World {
    pub(crate) size: Size,
    pub(crate) start: Pose,
    pub(crate) ground: f64,
    pub(crate) lines: Vec<Line>,
    pub(crate) walls: Vec<Segment>,
    pub(crate) boxes: Vec<Block>,
    pub(crate) light: Mount,
    pub(crate) range: Mount,
}

/// The floor's extent, m: x from 0 to `width`, y from 0 to `height`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    pub width: f64,
    pub height: f64,
}

/// A line painted on the floor, with round ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// m
    pub width: f64,
    /// 0 black to 255 white.
    pub brightness: f64,
    /// The middle of the line; bends are flattened to 0.1 mm. At least two points.
    pub points: Vec<Point>,
}

impl Line {
    /// The straight pieces of the line's middle.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.points.windows(2).map(|ends| Segment { from: ends[0], to: ends[1] })
    }

    /// m
    pub fn length(&self) -> f64 {
        self.segments().map(Segment::length).sum()
    }
}

/// Where a sensor sits on the robot, m from the middle of the axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    pub ahead: f64,
    pub left: f64,
}

/// A solid rectangle; its sides are among the walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Block {
    pub low: Point,
    pub high: Point,
}

impl Block {
    fn holds(&self, point: Point) -> bool {
        (self.low.x..=self.high.x).contains(&point.x) && (self.low.y..=self.high.y).contains(&point.y)
    }
}

impl World {
    /// Reads a world's text; `docs/sim.md` describes it.
    ///
    /// # Errors
    /// All faults found, in the order of their lines; at most 50.
    pub fn parse(text: &str) -> Result<World, Vec<Fault>> {
        build::world(text)
    }

    /// Where the robot starts. It is free of walls there.
    pub fn start(&self) -> Pose {
        self.start
    }

    /// The floor's extent.
    pub fn size(&self) -> Size {
        self.size
    }

    /// The brightness of the bare floor, 0 to 255.
    pub fn ground(&self) -> f64 {
        self.ground
    }

    /// The lines in the order they are painted: a later one covers an earlier one.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// The length of all lines together, m.
    pub fn line_length(&self) -> f64 {
        self.lines.iter().map(Line::length).sum()
    }

    /// Every wall: the four edges of the floor first, then the walls and the sides of boxes in the order written.
    pub fn walls(&self) -> &[Segment] {
        &self.walls
    }

    /// Where the light sensor sits.
    pub fn light_mount(&self) -> Mount {
        self.light
    }

    /// Where the range sensor sits.
    pub fn range_mount(&self) -> Mount {
        self.range
    }

    /// How far the wall nearest to `place` is, m.
    pub fn clearance(&self, place: Point) -> f64 {
        self.walls.iter().map(|wall| wall.nearest(place).distance(place)).fold(f64::INFINITY, f64::min)
    }

    /// Whether the robot's body fits at `place`; it may touch a wall.
    pub(crate) fn has_room_at(&self, place: Point) -> bool {
        let on_floor = (0.0..=self.size.width).contains(&place.x) && (0.0..=self.size.height).contains(&place.y);
        on_floor && !self.boxes.iter().any(|block| block.holds(place)) && self.clearance(place) >= robot::RADIUS - TOUCH
    }
}
