//! What the sensors would read at a pose in a world, without noise. Knows nothing of motion or time.

use std::f64::consts::PI;

use crate::geometry::{Point, Pose, wrapped};
use crate::robot;
use crate::world::{Line, World};

/// The mean brightness of the floor under the light sensor, 0 to 255.
pub(crate) fn light(world: &World, pose: Pose) -> f64 {
    let spot = pose.offset(world.light.ahead, world.light.left);
    world.lines.iter().fold(world.ground, |under, line| {
        let share = coverage(line, spot);
        under + (line.brightness - under) * share
    })
}

/// The share of the sensor's spot that lies on the line. Near enough, the line is straight under so small a spot.
fn coverage(line: &Line, spot: Point) -> f64 {
    let distance = line.segments().map(|piece| piece.nearest(spot).distance(spot)).fold(f64::INFINITY, f64::min);
    let half = line.width / 2.0;
    share_below((half - distance) / robot::LIGHT_SPOT) - share_below((-half - distance) / robot::LIGHT_SPOT)
}

/// The share of the unit disc to the left of x = `edge`.
fn share_below(edge: f64) -> f64 {
    let edge = edge.clamp(-1.0, 1.0);
    0.5 + (edge * (1.0 - edge * edge).sqrt() + edge.asin()) / PI
}

/// Whether a wall touches the bumper.
pub(crate) fn bumper(world: &World, pose: Pose) -> bool {
    world.walls.iter().any(|wall| {
        let way = wall.nearest(pose.place()) - pose.place();
        let ahead = wrapped(way.y.atan2(way.x) - pose.theta).abs() <= robot::BUMPER_ANGLE;
        ahead && way.length() <= robot::RADIUS + robot::BUMPER_REACH
    })
}

/// How far ahead of the range sensor the nearest wall is, m.
pub(crate) fn range(world: &World, pose: Pose) -> f64 {
    // The ray starts beside the axle, inside the body, where no wall can be: the sensor itself may sit right on one.
    let origin = pose.offset(0.0, world.range.left);
    let hit = world.walls.iter().filter_map(|wall| wall.met_by_ray(origin, pose.theta)).fold(f64::INFINITY, f64::min);
    (hit - world.range.ahead).clamp(0.0, robot::MAX_RANGE)
}
