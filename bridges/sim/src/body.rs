//! The robot's body in motion: one fixed step at a time, within its limits, never through a wall. Knows nothing of commands' age or of sensors.

use crate::geometry::{Point, Pose, wrapped};
use crate::robot;
use crate::world::World;

/// Length of a step, s.
const STEP: f64 = robot::STEP_US as f64 / 1e6;
/// How often the body is pushed out of the walls it touches before it is left where it was.
const PUSHES: usize = 8;
/// How deep the body may be in a wall after a step, m.
const DEPTH: f64 = 1e-6;

/// Where the robot is and how fast its wheels take it: m/s and rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Body {
    pub pose: Pose,
    pub linear: f64,
    pub angular: f64,
}

impl Body {
    pub fn at_rest(pose: Pose) -> Body {
        Body { pose, linear: 0.0, angular: 0.0 }
    }

    /// One step toward the wanted speeds. Against a wall the wheels slip: the body keeps only the motion along the wall.
    pub fn step(&mut self, linear: f64, angular: f64, world: &World) {
        self.linear = approach(self.linear, linear, robot::LINEAR_ACCELERATION * STEP);
        self.angular = approach(self.angular, angular, robot::ANGULAR_ACCELERATION * STEP);
        let turn = self.angular * STEP;
        let way = Point::toward(self.pose.theta + turn / 2.0) * (self.linear * STEP);
        let place = pushed_out(self.pose.place() + way, world).unwrap_or(self.pose.place());
        self.pose = Pose { x: place.x, y: place.y, theta: wrapped(self.pose.theta + turn) };
    }
}

fn approach(value: f64, wanted: f64, most: f64) -> f64 {
    value + (wanted - value).clamp(-most, most)
}

/// The place closest by where the body is free of walls, or none where it is wedged in.
fn pushed_out(mut place: Point, world: &World) -> Option<Point> {
    for _ in 0..PUSHES {
        let mut free = true;
        for wall in &world.walls {
            let away = place - wall.nearest(place);
            let distance = away.length();
            if distance == 0.0 {
                return None;
            }
            if distance < robot::RADIUS - DEPTH {
                place = place + away * (robot::RADIUS / distance - 1.0);
                free = false;
            }
        }
        if free {
            return Some(place);
        }
    }
    None
}
