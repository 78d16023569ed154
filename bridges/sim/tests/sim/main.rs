//! Tests of the simulator from the outside: world texts and commands in, poses and readings out.

mod courses;
mod follower;
mod motion;
mod readings;
mod texts;
