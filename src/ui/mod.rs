//! What a person sees and presses: records are folded into a picture, the picture is drawn, keys become effects.
//! Nothing below this layer knows of it.

pub mod action;
pub mod app;
pub mod cadence;
pub mod clipboard;
pub mod curve;
pub mod editor;
pub mod encoder;
pub mod foreground;
pub mod format;
pub mod glyphs;
pub mod graph;
pub mod hints;
pub mod ink;
pub mod input;
pub mod key;
pub mod keymap;
pub mod layout;
pub mod live;
pub mod machine_graph;
pub mod menu;
pub mod panes;
pub mod pen;
pub mod pointer;
pub mod quiet;
pub mod robots;
pub mod scope;
pub mod settings;
pub mod terminal;
pub mod theme;
pub mod tour;
pub mod tree;
pub mod view;
pub mod welcome;
pub mod words;
