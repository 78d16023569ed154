//! What the robot is made of: its measures and limits, the same in every world. Metres, seconds, radians.

use std::f64::consts::FRAC_PI_3;

/// Radius of the round body, m. The axle is in its middle.
pub const RADIUS: f64 = 0.09;

/// Highest speed forwards and backwards, m/s.
pub const MAX_LINEAR: f64 = 0.6;
/// Highest turning speed, rad/s.
pub const MAX_ANGULAR: f64 = 4.0;
/// Highest change of speed, m/s².
pub const LINEAR_ACCELERATION: f64 = 3.0;
/// Highest change of turning speed, rad/s².
pub const ANGULAR_ACCELERATION: f64 = 20.0;

/// A command is obeyed this long; then the robot stops unless another one came. Microseconds.
pub const DEAD_MAN_US: u64 = 500_000;
/// The fixed step in which motion is computed. Microseconds.
pub const STEP_US: u64 = 1_000;

/// Radius of the disc of floor the light sensor sees, m.
pub const LIGHT_SPOT: f64 = 0.006;
/// Where the light sensor is unless the world says otherwise, m ahead of the axle.
pub const LIGHT_AHEAD: f64 = 0.08;

/// The farthest the range sensor sees, m.
pub const MAX_RANGE: f64 = 4.0;
/// Where the range sensor is unless the world says otherwise, m ahead of the axle.
pub const RANGE_AHEAD: f64 = RADIUS;

/// How far the bumper stands out from the body, m.
pub const BUMPER_REACH: f64 = 0.002;
/// The bumper covers the front this far to either side, rad.
pub const BUMPER_ANGLE: f64 = FRAC_PI_3;
