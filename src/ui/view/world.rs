//! A simulator's world and where its robot is and has been.

use std::collections::VecDeque;
use std::sync::Arc;

use serde_json::Value;

use super::Path;
use crate::runtime::record::WorldText;

/// How many places of the trail are kept.
pub const TRAIL: usize = 600;
/// Places nearer to each other than this are one, m.
const STRIDE: f64 = 0.02;
/// A robot that moves further than this at once was put there, m.
const LEAP: f64 = 0.5;

#[derive(Clone, Debug, PartialEq)]
pub struct World {
    pub bridge: Path,
    pub name: Path,
    pub text: Path,
    /// None where the text isn't a world.
    pub map: Option<Arc<lrp_sim::World>>,
    /// The input that carries the pose.
    pub pose_input: Path,
    /// None until the robot tells where it is.
    pub pose: Option<Pose>,
    /// Where the robot has been, oldest first, m.
    pub trail: VecDeque<(f64, f64)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// m
    pub x: f64,
    /// m
    pub y: f64,
    /// Heading in radians, counter-clockwise from the x axis.
    pub theta: f64,
}

impl World {
    pub fn new(bridge: &Path, world: &WorldText) -> World {
        World {
            bridge: bridge.clone(),
            name: world.name.clone(),
            text: world.text.clone(),
            map: lrp_sim::World::parse(&world.text).ok().map(Arc::new),
            pose_input: world.pose.clone(),
            pose: None,
            trail: VecDeque::new(),
        }
    }

    pub fn moved(&mut self, message: &Value) {
        let Some(pose) = Pose::read(message) else { return };
        self.pose = Some(pose);
        let far = self.trail.back().map(|&(x, y)| (pose.x - x).hypot(pose.y - y));
        match far {
            Some(far) if far < STRIDE => return,
            Some(far) if far > LEAP => self.trail.clear(),
            _ => (),
        }
        if self.trail.len() == TRAIL {
            self.trail.pop_front();
        }
        self.trail.push_back((pose.x, pose.y));
    }
}

impl Pose {
    fn read(message: &Value) -> Option<Pose> {
        let field = |name: &str| message.get(name).and_then(Value::as_f64).filter(|n| n.is_finite());
        Some(Pose { x: field("x")?, y: field("y")?, theta: field("theta")? })
    }
}
