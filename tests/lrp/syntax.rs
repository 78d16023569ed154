//! The syntax layer: text in, tree and diagnostics out.

pub mod any_block;
mod any_lua;
pub mod any_text;
mod corpus;
mod dump;
mod free_names;
mod lua;
mod properties;
mod rendering;
mod spans;
