//! What a person sees and presses. Nothing below this layer knows of it.

pub mod editor;
pub mod foreground;
pub mod input;
pub mod quiet;
pub mod terminal;
