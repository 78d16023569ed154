//! From text to tree: spans, the reader, the grammar's forms, and diagnostics. Knows nothing of what the forms mean.

pub mod allow;
pub mod ast;
pub mod diagnostic;
pub mod findings;
pub mod keyword;
pub mod lua_names;
pub mod lua_tokens;
pub mod nearest;
pub mod parser;
pub mod pieces;
pub mod reader;
pub mod render;
pub mod source;

mod block;
mod form;
mod layout;
mod leaves;
mod misplaced;
mod names;
mod repair;
mod transition;
mod window;

pub use diagnostic::{Code, Diagnostic, Severity};
pub use parser::{Parsed, parse};
pub use source::{FileId, Source, Span};
