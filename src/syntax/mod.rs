//! From text to tree: spans, the reader, the grammar's forms, and diagnostics. Knows nothing of what the forms mean.

pub mod ast;
pub mod diagnostic;
pub mod nearest;
pub mod source;

pub use diagnostic::{Code, Diagnostic, Severity};
pub use source::{FileId, Source, Span};
