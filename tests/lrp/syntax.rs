//! The syntax layer: text in, tree and diagnostics out.

mod corpus;
mod dump;
mod free_names;
mod lua;
mod properties;
mod rendering;
mod spans;
