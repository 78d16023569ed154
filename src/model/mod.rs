//! What a program means: its machines, states and transitions with every name resolved, and how two programs differ.
//! Knows nothing of running one.

pub mod description;
pub mod ids;
pub mod program;

pub use description::Description;
pub use ids::*;
pub use program::*;
