//! What a program means: its machines, states and transitions with every name resolved, and how two programs differ.
//! Knows nothing of running one.

pub mod blocks;
pub mod change;
pub mod checks;
pub mod description;
pub mod diff;
pub mod ids;
mod link;
pub mod names;
pub mod program;
pub mod resolve;
mod suggestion;

pub use description::Description;
pub use ids::*;
pub use program::*;
pub use resolve::{Robot, resolve};
