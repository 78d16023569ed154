//! What a person sees and presses: records are folded into a picture, the picture is drawn, keys become effects.
//! Nothing below this layer knows of it.

pub mod action;
pub mod app;
pub mod format;
pub mod graph;
pub mod machine_graph;
pub mod editor;
pub mod foreground;
pub mod input;
pub mod quiet;
pub mod terminal;
pub mod key;
pub mod layout;
pub mod panes;
pub mod pen;
pub mod scope;
pub mod theme;
pub mod tree;
pub mod view;
