//! What a program means: its machines, states and transitions with every name resolved, and how two programs differ.
//! Knows nothing of running one.

pub mod alias;
pub mod blocks;
pub mod breakpoints;
mod bridges;
pub mod change;
pub mod checks;
pub mod diff;
pub mod edit;
pub mod element;
pub mod files;
mod globals;
pub mod ids;
pub mod initial;
mod link;
pub mod literal;
pub mod matching;
pub mod modules;
pub mod names;
pub mod program;
mod quoted;
pub mod reads;
pub mod renamed;
pub mod resolve;
pub mod settings;
mod suggestion;
pub mod transition_names;
pub mod ways;
mod words;

pub use edit::Edit;
pub use element::{Alias, ElementId, Kind};
pub use files::File;
pub use ids::*;
pub use lrp_bridge::Description;
pub use matching::Matching;
pub use program::*;
pub use resolve::{Robot, resolve, resolve_files};
