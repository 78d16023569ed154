//! What a person sees: the panes of the screen and the drawings in them. Nothing below this layer knows of it.

pub mod graph;
pub mod machine_graph;
