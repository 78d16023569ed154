//! A differential-drive robot in a small world read from a text file. Pure: it knows nothing of lrp, threads, files or real time.
//!
//! ```
//! use lrp_sim::{Noise, Sim, Twist, World};
//!
//! let world = World::parse("size 2 1\nstart 0.5 0.5 heading 0").unwrap();
//! let mut sim = Sim::new(world, Noise::NONE, 1);
//! sim.drive(Twist { linear: 0.2, angular: 0.0 }).unwrap();
//! sim.advance_to(400_000);
//! assert!(sim.pose().x > 0.55);
//! ```

mod body;
mod build;
mod drawing;
mod fault;
mod form;
mod geometry;
mod noise;
mod path;
mod reader;
pub mod robot;
mod sensors;
mod sim;
mod world;

pub use fault::Fault;
pub use geometry::{Point, Pose, Segment};
pub use noise::Noise;
pub use sim::{Refused, Sim, Twist};
pub use world::{Line, Mount, Size, World};
