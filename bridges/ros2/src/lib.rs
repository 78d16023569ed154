//! A bridge to ROS 2 that needs no ROS installed: it speaks DDS itself, and knows message types at run time only.
//! docs/ros2.md is its page.

mod actions;
mod bridge;
pub mod cdr;
mod client;
mod config;
mod core;
mod dds;
mod graph;
mod mapping;
mod names;
mod node;
mod offer;
mod parameters;
mod services;
mod system;
mod topics;
pub mod types;
mod wanted;

pub use bridge::Ros2;

lrp_bridge::bridge!(Ros2);
